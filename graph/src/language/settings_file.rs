//! Settings files: the choices of one user for a pipeline.

use super::mistakes::in_order;
use crate::base::{Code, Diagnostic, Sources, Span};
use crate::fields;
use crate::language::compose::files::LARGEST_FILE;
use crate::language::compose::tables::VERSION;
use crate::language::entries::presets::{SET, set};
use crate::language::model::{Preset, Setting, SettingsFile, unknown_preset};
use crate::ron::{Leaf, PlainForm, Reader, Tree};
use std::sync::Arc;

/// The version of settings files that this library reads.
pub const SETTINGS_VERSION: i64 = 1;

fields! {
    /// A settings file: the choices of one user for a pipeline.
    /// ```ron
    /// Settings(version: 1, preset: "low", set: {"msaa": 4})
    /// ```
    pub(crate) struct SettingsFields<'src> as "Settings" {
        /// The version of settings files: 1.
        #[expect(dead_code, reason = "read before the others, so that a later version is said first")]
        version: Leaf<'src> => VERSION,
        /// The preset that it begins with.
        preset: Option<Leaf<'src>> => Form::Plain(PlainForm::Name),
        /// Values of settings, which are stronger than those of the preset.
        set: Option<Leaf<'src>> => SET,
    }
}

/// Reads a settings file's text, which is added to `sources`: those that the pipeline was read into. `shown` is the path
/// as the user named it, and `relative` its name in Plans.
pub(crate) fn read(
    sources: &mut Sources,
    (shown, relative): (&str, &str),
    text: String,
    settings: &[Setting],
    presets: &[Preset],
) -> Result<SettingsFile, Vec<Diagnostic>> {
    if text.len() > LARGEST_FILE {
        let message = format!("`{shown}` has {} bytes; a settings file has at most {LARGEST_FILE}", text.len());
        return Err(vec![Diagnostic::nowhere(Code::FILE_TOO_LARGE, message)]);
    }
    let text: Arc<str> = text.into();
    let file = sources.add(shown, relative, text.clone());
    if text.trim().is_empty() {
        let empty = Diagnostic::new(Code::FILE_EMPTY, Span::new(file, 0, 0), "the file is empty");
        return Err(vec![empty.help("a settings file is `Settings(version: 1, preset: \"…\", set: {\"…\": …})`")]);
    }
    let mut errors = Vec::new();
    let Some(tree) = Tree::read(file, text, &mut errors) else { return Err(in_order(errors)) };
    let mut reader = Reader { errors };
    match said(&mut reader, tree.root(), settings, presets) {
        Some(said) if reader.errors.is_empty() => Ok(said),
        _ => Err(in_order(reader.errors)),
    }
}

fn said(reader: &mut Reader, all: Leaf<'_>, settings: &[Setting], presets: &[Preset]) -> Option<SettingsFile> {
    if let Some(version) = all.field("version") {
        let number = reader.integer(version)?;
        if number != SETTINGS_VERSION {
            let message = format!("this settings file is written in version {number}");
            reader.errors.clear();
            reader.wrong(Code::VERSION, version, message, &format!("this program reads version {SETTINGS_VERSION}"));
            return None;
        }
    }
    let fields: SettingsFields<'_> = reader.read(all, "the settings file")?;
    let preset = fields.preset.map(|leaf| {
        let name = reader.reference(leaf, "a preset")?;
        let found = presets.iter().position(|preset| preset.name.text == name.text);
        if found.is_none() {
            reader.report(unknown_preset(&name.text, presets).at(name.span));
        }
        found
    });
    let settings: Vec<Option<Setting>> = settings.iter().cloned().map(Some).collect();
    let set = fields.set.map_or_else(|| Some(Vec::new()), |leaf| set(reader, leaf, &settings));
    // A preset that is named and not there was reported.
    let preset = match preset {
        Some(found) => Some(found?),
        None => None,
    };
    Some(SettingsFile { preset, set: set? })
}
