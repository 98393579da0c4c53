//! Values of settings: the user's choice where it is allowed, else the choice of a file or a preset, else the default.

use crate::base::{Code, Diagnostic, shown_number, suggestion};
use crate::expression::Value;
use crate::language::{ChosenBy, ChosenValue, Document, Setting, SettingKind};
use std::collections::HashMap;
use std::sync::Arc;

/// A value for every setting, in their order.
pub(super) fn choose(document: &Document, set: &[(String, String)], errors: &mut Vec<Diagnostic>) -> Vec<ChosenValue> {
    let settings = &document.settings;
    let mut values = document.in_force().to_vec();
    let index: HashMap<&str, usize> = (0..).zip(settings).map(|(at, s)| (&*s.name.text, at)).collect();
    for (name, text) in set {
        let Some(at) = index.get(name.as_str()) else {
            let help = suggestion(name, settings.iter().map(|setting| &*setting.name.text))
                .or_else(|| Some("this pipeline has no settings".to_owned()));
            errors.push(Diagnostic { help, ..Diagnostic::unknown_name(Code::UNKNOWN_SETTING, "setting", name) });
            continue;
        };
        let setting = &settings[*at];
        match parse(&setting.kind, text) {
            Some(value) if setting.kind.allows(&value) => values[*at] = ChosenValue { value, by: ChosenBy::Set },
            other => errors.push(not_allowed(setting, text, other.as_ref())),
        }
    }
    values
}

/// The values alone.
pub(super) fn values(chosen: &[ChosenValue]) -> Vec<Value> {
    chosen.iter().map(|chosen| chosen.value.clone()).collect()
}

/// A value of a setting in the form that Plans have it in; `None`: the text is none of this kind. `2` and `2.0` are one number.
#[must_use]
pub fn canonical_value(kind: &SettingKind, text: &str) -> Option<String> {
    parse(kind, text).map(|value| show(&value))
}

/// Settings in force, as they are shown.
pub(super) fn shown(settings: &[Setting], values: &[ChosenValue]) -> Vec<(Arc<str>, String)> {
    settings.iter().zip(values).map(|(setting, chosen)| (setting.name.text.clone(), show(&chosen.value))).collect()
}

/// A value, as the command line has it.
fn show(value: &Value) -> String {
    match value {
        Value::Number(value) => shown_number(*value),
        Value::Text(value) => value.to_string(),
        other => other.to_string(),
    }
}

fn not_allowed(setting: &Setting, text: &str, value: Option<&Value>) -> Diagnostic {
    let name = &setting.name.text;
    let help = match value {
        Some(value) => setting.kind.instead_of(value),
        None => format!("it is {}", setting.kind.allowed()),
    };
    Diagnostic::new(Code::VALUE_NOT_ALLOWED, setting.name.span, format!("setting `{name}` doesn't allow `{text}`"))
        .remark("declared here")
        .help(help)
}

fn parse(kind: &SettingKind, text: &str) -> Option<Value> {
    match kind {
        SettingKind::Bool { .. } => text.parse().ok().map(Value::Bool),
        SettingKind::OneOf { .. } | SettingKind::Integer { .. } => text.parse().ok().map(Value::Integer),
        SettingKind::Choice { .. } => Some(Value::Text(text.into())),
        SettingKind::Number { .. } => text.parse().ok().map(Value::Number),
    }
}
