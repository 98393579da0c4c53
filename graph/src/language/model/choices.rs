//! Chosen values of settings: by presets, settings files and defaults.

use super::setting::Setting;
use crate::base::{Code, Diagnostic, Span, suggestion};
use crate::expression::Value;
use crate::ron::Name;
use std::sync::Arc;

/// Values of several settings, under one name.
#[derive(Debug, Clone)]
pub struct Preset {
    /// Unique name.
    pub name: Name,
    /// A description for people.
    pub about: Option<String>,
    /// The chosen values, each setting at most once.
    pub set: Vec<Choice>,
}

/// A value that is chosen for a setting, which allows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The setting: an index into [`Document::settings`](crate::language::Document::settings).
    pub setting: usize,
    /// The value.
    pub value: Value,
    /// Where the setting is named.
    pub span: Span,
}

/// The contents of a settings file, read for a pipeline: `Settings(version: 1, preset: "low", set: {"msaa": 2})`.
#[derive(Debug, Clone, Default)]
pub struct SettingsFile {
    /// The chosen preset: an index into [`Document::presets`](crate::language::Document::presets).
    pub preset: Option<usize>,
    /// The chosen values, each setting at most once.
    pub set: Vec<Choice>,
}

/// A setting's value, and who chose it.
#[derive(Debug, Clone, PartialEq)]
pub struct ChosenValue {
    /// The value, which the setting allows.
    pub value: Value,
    /// Who chose it.
    pub by: ChosenBy,
}

/// Who chose a setting's value, from the weakest to the strongest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ChosenBy {
    /// It is the default, which was not changed.
    Default,
    /// The preset of that name.
    Preset(Arc<str>),
    /// A settings file, at that place.
    File(Span),
    /// The caller, by [`Inputs::set`](crate::expand::Inputs::set): the command line.
    Set,
}

/// The mistake that a pipeline has no preset of that name.
pub(crate) fn unknown_preset(name: &str, presets: &[Preset]) -> Diagnostic {
    let help = suggestion(name, presets.iter().map(|preset| &*preset.name.text))
        .or_else(|| Some("this pipeline has no presets".to_owned()));
    Diagnostic { help, ..Diagnostic::unknown_name(Code::UNKNOWN_PRESET, "preset", name) }
}

/// Every setting's value once a preset and settings files, from the weakest to the strongest, are applied to defaults.
pub(crate) fn in_force(settings: &[Setting], preset: Option<&Preset>, files: &[SettingsFile]) -> Vec<ChosenValue> {
    let default = |setting: &Setting| ChosenValue { value: setting.kind.default(), by: ChosenBy::Default };
    let mut values: Vec<ChosenValue> = settings.iter().map(default).collect();
    let mut put = |choice: &Choice, by: ChosenBy| {
        if let Some(slot) = values.get_mut(choice.setting) {
            *slot = ChosenValue { value: choice.value.clone(), by };
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
