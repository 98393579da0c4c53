//! Values of settings that are chosen together: presets of a pipeline, and settings files.

use super::body::entries;
use super::document::VERSION;
use super::pipeline::{Setting, SettingKind};
use super::{LARGEST_FILE, settings};
use crate::base::{Diagnostic, Sources, Span, suggestion};
use crate::expression::Value;
use crate::fields;
use crate::ron::{Form, Leaf, Name, Names, Plain, Reader, Tree};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// The version of settings files that this library reads.
pub const SETTINGS_VERSION: i64 = 1;

/// Values of several settings, under one name.
#[derive(Debug, Clone)]
pub struct Preset {
    /// Unique name.
    pub name: Name,
    /// What it is for, for people.
    pub about: Option<String>,
    /// What it chooses; no setting twice.
    pub set: Vec<Choice>,
}

/// A value that is chosen for a setting, which allows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The setting: an index into [`Document::settings`](super::Document::settings).
    pub setting: usize,
    /// The value.
    pub value: Value,
    /// Where the setting is named.
    pub span: Span,
}

/// What a settings file says to a pipeline: `Settings(version: 1, preset: "low", set: {"msaa": 2})`.
#[derive(Debug, Clone, Default)]
pub struct SettingsFile {
    /// The preset that it chooses: an index into [`Document::presets`](super::Document::presets).
    pub preset: Option<usize>,
    /// What it chooses; no setting twice.
    pub set: Vec<Choice>,
}

/// A setting's value, and who chose it.
#[derive(Debug, Clone, PartialEq)]
pub struct InForce {
    /// The value, which the setting allows.
    pub value: Value,
    /// Who chose it.
    pub by: ChosenBy,
}

/// Who chose a setting's value, from the weakest to the strongest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ChosenBy {
    /// Nobody: it is the default.
    Default,
    /// The preset of that name.
    Preset(Arc<str>),
    /// A settings file, at that place.
    File(Span),
    /// The one who puts the pipeline together, by [`Inputs::set`](crate::expand::Inputs::set): the command line.
    Set,
}

fields! {
    /// A preset: values of several settings under one name.
    /// ```ron
    /// (name: "low", about: "for phones", set: {"msaa": 1, "bloom": false})
    /// ```
    pub(super) struct PresetFields<'src> as "Preset" {
        /// Its name, as in `--preset NAME`.
        name: Leaf<'src> => Form::Plain(Plain::Name),
        /// A description for people.
        about: Option<Leaf<'src>> => Form::Plain(Plain::Text),
        /// What it chooses; other settings keep what they have.
        set: Leaf<'src> => SET,
    }
}

/// Values of settings, by their names.
pub(super) const SET: Form = Form::Map("setting", &settings::VALUE);

fields! {
    /// A settings file: what one user chooses of a pipeline.
    /// ```ron
    /// Settings(version: 1, preset: "low", set: {"msaa": 4})
    /// ```
    pub(super) struct SettingsFields<'src> as "Settings" {
        /// The version of settings files: 1.
        #[expect(dead_code, reason = "read before the others, so that a later version is said first")]
        version: Leaf<'src> => VERSION,
        /// The preset that it begins with.
        preset: Option<Leaf<'src>> => Form::Plain(Plain::Name),
        /// What it chooses besides.
        set: Option<Leaf<'src>> => SET,
    }
}

/// A list of presets; `None` where one couldn't be read.
pub(super) fn presets(
    reader: &mut Reader,
    list: Option<Leaf<'_>>,
    settings: &[Option<Setting>],
) -> Vec<Option<Preset>> {
    let list: Vec<Option<PresetFields<'_>>> = entries(reader, list, "`presets`", "preset", &mut Names::new("preset"));
    let lower = |fields: Option<PresetFields<'_>>| {
        let fields = fields?;
        let name = reader.name(fields.name, "a preset");
        let about = match fields.about {
            Some(about) => reader.words(about, "a description").map(Some),
            None => Some(None),
        };
        let set = set(reader, fields.set, settings);
        Some(Preset { name: name?, about: about?, set: set? })
    };
    list.into_iter().map(lower).collect()
}

/// `{"setting": value, …}`
pub(super) fn set(reader: &mut Reader, leaf: Leaf<'_>, settings: &[Option<Setting>]) -> Option<Vec<Choice>> {
    let before = reader.errors.len();
    let mut chosen = Vec::new();
    let mut seen: HashMap<Arc<str>, Span> = HashMap::new();
    let entries: Vec<_> = reader.map(leaf, "values of settings")?.collect();
    let given: HashSet<&str> = entries.iter().filter_map(|(key, _)| key.plain()).collect();
    for (key, value) in entries {
        let Some(name) = reader.reference(key, "a setting") else { continue };
        if let Some(first) = seen.insert(name.text.clone(), name.span) {
            let twice = Diagnostic::new(name.span, format!("`{}` is set twice", name.text));
            reader.report(twice.remark("again here").label(first, "first here"));
            continue;
        }
        let named = settings.iter().position(|known| known.as_ref().is_some_and(|known| known.name.text == name.text));
        let Some((at, setting)) = named.and_then(|at| Some((at, settings[at].as_ref()?))) else {
            // It may be one that couldn't be read.
            if settings.iter().all(Option::is_some) {
                reader.report(unknown_setting(&name, settings, &given));
            }
            continue;
        };
        chosen.extend(typed(reader, setting, value).map(|value| Choice { setting: at, value, span: name.span }));
    }
    (reader.errors.len() == before).then_some(chosen)
}

/// Settings that are `given` a value already aren't suggested.
fn unknown_setting(name: &Name, settings: &[Option<Setting>], given: &HashSet<&str>) -> Diagnostic {
    let all = settings.iter().flatten().map(|setting| &*setting.name.text);
    let help = suggestion(&name.text, all.clone().filter(|name| !given.contains(name)))
        .or_else(|| suggestion(&name.text, all))
        .or_else(|| Some("this pipeline has no settings".to_owned()));
    Diagnostic { help, ..Diagnostic::new(name.span, format!("there is no setting named `{}`", name.text)) }
}

/// A value that `setting` allows.
fn typed(reader: &mut Reader, setting: &Setting, leaf: Leaf<'_>) -> Option<Value> {
    let (name, declared) = (&setting.name.text, setting.name.span);
    let before = reader.errors.len();
    let value = match &setting.kind {
        SettingKind::Bool { .. } => reader.truth(leaf).map(Value::Bool),
        SettingKind::OneOf { .. } | SettingKind::Integer { .. } => reader.integer(leaf).map(Value::Integer),
        SettingKind::Number { .. } => reader.number(leaf).map(Value::Number),
        SettingKind::Choice { .. } => reader.words(leaf, "a text").map(|text| Value::Text(text.into())),
    };
    if value.as_ref().is_some_and(|value| !setting.kind.allows(value)) {
        reader.wrong(leaf, format!("setting `{name}` doesn't allow `{}`", leaf.text().trim_matches('"')), "");
    }
    for error in &mut reader.errors[before..] {
        error.labels.push(crate::base::Label { span: declared, text: format!("`{name}` is declared here") });
        let help = || match &value {
            Some(value) => setting.kind.instead_of(value),
            None => format!("it is {}", setting.kind.allowed()),
        };
        error.help.get_or_insert_with(help);
    }
    value.filter(|_| reader.errors.len() == before)
}

/// Reads a settings file's text, which is added to `sources`: those that the pipeline was read into. `shown` is the path
/// as the user named it, and `relative` its name in Plans.
pub(super) fn read(
    sources: &mut Sources,
    (shown, relative): (&str, &str),
    text: String,
    settings: &[Setting],
    presets: &[Preset],
) -> Result<SettingsFile, Vec<Diagnostic>> {
    if text.len() > LARGEST_FILE {
        let message = format!("`{shown}` has {} bytes; a settings file has at most {LARGEST_FILE}", text.len());
        return Err(vec![Diagnostic::nowhere(message)]);
    }
    let text: Arc<str> = text.into();
    let file = sources.add(shown, relative, text.clone());
    if text.trim().is_empty() {
        let empty = Diagnostic::new(Span::new(file, 0, 0), "the file is empty");
        return Err(vec![empty.help("a settings file is `Settings(version: 1, preset: \"…\", set: {\"…\": …})`")]);
    }
    let mut errors = Vec::new();
    let Some(tree) = Tree::read(file, text, &mut errors) else { return Err(super::in_order(errors)) };
    let mut reader = Reader { errors };
    match said(&mut reader, tree.root(), settings, presets) {
        Some(said) if reader.errors.is_empty() => Ok(said),
        _ => Err(super::in_order(reader.errors)),
    }
}

fn said(reader: &mut Reader, all: Leaf<'_>, settings: &[Setting], presets: &[Preset]) -> Option<SettingsFile> {
    if let Some(version) = all.field("version") {
        let number = reader.integer(version)?;
        if number != SETTINGS_VERSION {
            let message = format!("this settings file is written in version {number}");
            reader.errors.clear();
            reader.wrong(version, message, &format!("this program reads version {SETTINGS_VERSION}"));
            return None;
        }
    }
    let fields: SettingsFields<'_> = reader.read(all, "the settings file")?;
    let preset = fields.preset.map(|leaf| {
        let name = reader.reference(leaf, "a preset")?;
        let found = presets.iter().position(|preset| preset.name.text == name.text);
        if found.is_none() {
            let Diagnostic { message, help, .. } = unknown_preset(&name.text, presets);
            reader.report(Diagnostic { help, ..Diagnostic::new(name.span, message) });
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

/// That a pipeline has no preset of that name.
pub(super) fn unknown_preset(name: &str, presets: &[Preset]) -> Diagnostic {
    let help = suggestion(name, presets.iter().map(|preset| &*preset.name.text))
        .or_else(|| Some("this pipeline has no presets".to_owned()));
    Diagnostic { help, ..Diagnostic::nowhere(format!("there is no preset named `{name}`")) }
}

/// Every setting's value once a preset and settings files, from the weakest to the strongest, are applied to defaults.
pub(super) fn in_force(settings: &[Setting], preset: Option<&Preset>, files: &[SettingsFile]) -> Vec<InForce> {
    let default = |setting: &Setting| InForce { value: setting.kind.default(), by: ChosenBy::Default };
    let mut values: Vec<InForce> = settings.iter().map(default).collect();
    let mut put = |choice: &Choice, by: ChosenBy| {
        if let Some(slot) = values.get_mut(choice.setting) {
            *slot = InForce { value: choice.value.clone(), by };
        }
    };
    if let Some(Preset { name, set, .. }) = preset {
        set.iter().for_each(|choice| put(choice, ChosenBy::Preset(name.text.clone())));
    }
    for choice in files.iter().flat_map(|file| &file.set) {
        put(choice, ChosenBy::File(choice.span));
    }
    values
}
