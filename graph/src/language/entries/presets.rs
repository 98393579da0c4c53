//! `presets`: values of several settings under one name.

use super::list::entries;
use super::settings;
use super::values::optional;
use crate::base::{Code, Diagnostic, Label, Span, suggestion};
use crate::expression::Value;
use crate::fields;
use crate::language::model::{Choice, Preset, Setting, SettingKind};
use crate::ron::{FieldTable, Form, Leaf, Name, Names, PlainForm, Reader};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

fields! {
    /// A preset: values of several settings under one name.
    /// ```ron
    /// (name: "low", about: "for phones", set: {"msaa": 1, "bloom": false})
    /// ```
    pub(crate) struct PresetFields<'src> as "Preset" {
        /// Its name, as in `--preset NAME`.
        name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// A description for people.
        about: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
        /// The chosen values; other settings keep their values.
        set: Leaf<'src> => SET,
    }
}

/// Values of settings, by their names.
pub(crate) const SET: Form = Form::Map("setting", &settings::VALUE);

/// The presets of a pipeline.
pub(crate) const PRESETS: Form = Form::List(&Form::Fields(PresetFields::<'static>::table));

/// A list of presets; `None` where one couldn't be read.
pub(crate) fn presets(
    reader: &mut Reader,
    list: Option<Leaf<'_>>,
    settings: &[Option<Setting>],
) -> Vec<Option<Preset>> {
    let list: Vec<Option<PresetFields<'_>>> =
        entries(reader, list, "`presets`", "preset", &mut Names::new("preset", Code::UNKNOWN_PRESET));
    let read = |fields: Option<PresetFields<'_>>| {
        let fields = fields?;
        let name = reader.name(fields.name, "a preset");
        let about = optional(fields.about, |about| reader.words(about, "a description"));
        let set = set(reader, fields.set, settings);
        Some(Preset { name: name?, about: about?, set: set? })
    };
    list.into_iter().map(read).collect()
}

/// `{"setting": value, …}`
pub(crate) fn set(reader: &mut Reader, leaf: Leaf<'_>, settings: &[Option<Setting>]) -> Option<Vec<Choice>> {
    let before = reader.errors.len();
    let mut chosen = Vec::new();
    let mut seen: HashMap<Arc<str>, Span> = HashMap::new();
    let entries: Vec<_> = reader.map(leaf, "values of settings")?.collect();
    let given: HashSet<&str> = entries.iter().filter_map(|(key, _)| key.plain()).collect();
    for (key, value) in entries {
        let Some(name) = reader.reference(key, "a setting") else { continue };
        if let Some(first) = seen.insert(name.text.clone(), name.span) {
            let twice = Diagnostic::new(Code::LISTED_TWICE, name.span, format!("`{}` is set twice", name.text));
            reader.report(twice.remark("again here").label(first, "first here"));
            continue;
        }
        let named = settings.iter().position(|known| known.as_ref().is_some_and(|known| known.name.text == name.text));
        let Some((at, setting)) = named.and_then(|at| Some((at, settings[at].as_ref()?))) else {
            // The setting may be one that couldn't be read.
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
    Diagnostic { help, ..Diagnostic::unknown_name(Code::UNKNOWN_SETTING, "setting", &name.text).at(name.span) }
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
        reader.wrong(
            Code::VALUE_NOT_ALLOWED,
            leaf,
            format!("setting `{name}` doesn't allow `{}`", leaf.text().trim_matches('"')),
            "",
        );
    }
    for error in &mut reader.errors[before..] {
        error.labels.push(Label::new(declared, format!("`{name}` is declared here")));
        let help = || match &value {
            Some(value) => setting.kind.instead_of(value),
            None => format!("it is {}", setting.kind.allowed()),
        };
        error.help.get_or_insert_with(help);
    }
    value.filter(|_| reader.errors.len() == before)
}
