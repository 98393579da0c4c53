//! Values of settings: the user's choice where it is allowed, else the default.

use super::nowhere;
use crate::describe::{Diagnostic, Pipeline, Setting, SettingKind, shown_number, suggestion};
use crate::frame::ParamValue;
use std::collections::HashMap;
use std::sync::Arc;

/// The value of a setting.
pub(super) type SettingValue = ParamValue;

/// A value for every setting of the pipeline, in its order.
pub(super) fn choose(pipeline: &Pipeline, set: &[(String, String)], errors: &mut Vec<Diagnostic>) -> Vec<SettingValue> {
    let mut values: Vec<SettingValue> = pipeline.settings.iter().map(|setting| default(&setting.kind)).collect();
    let index: HashMap<&str, usize> = (0..).zip(&pipeline.settings).map(|(at, s)| (&*s.name.text, at)).collect();
    for (name, text) in set {
        let Some(at) = index.get(name.as_str()) else {
            let help = suggestion(name, pipeline.settings.iter().map(|setting| &*setting.name.text))
                .or_else(|| Some("this pipeline has no settings".to_owned()));
            errors.push(Diagnostic { help, ..nowhere(format!("there is no setting named `{name}`")) });
            continue;
        };
        let setting = &pipeline.settings[*at];
        match parse(&setting.kind, text) {
            Some(value) => values[*at] = value,
            None => errors.push(not_allowed(setting, text)),
        }
    }
    values
}

/// Settings in force, as they are shown.
pub(super) fn shown(pipeline: &Pipeline, values: &[SettingValue]) -> Vec<(Arc<str>, String)> {
    pipeline.settings.iter().zip(values).map(|(setting, value)| (setting.name.text.clone(), show(*value))).collect()
}

/// A value, as it is shown.
pub(super) fn show(value: SettingValue) -> String {
    match value {
        ParamValue::Bool(value) => value.to_string(),
        ParamValue::Integer(value) => value.to_string(),
        ParamValue::Number(value) => shown_number(value),
    }
}

fn not_allowed(setting: &Setting, text: &str) -> Diagnostic {
    let name = &setting.name.text;
    Diagnostic::new(setting.name.span, format!("setting `{name}` doesn't allow `{text}`"))
        .remark("declared here")
        .help(format!("it is {}", setting.kind.allowed()))
}

fn default(kind: &SettingKind) -> SettingValue {
    match kind {
        SettingKind::Bool { default } => ParamValue::Bool(*default),
        SettingKind::OneOf { default, .. } | SettingKind::Integer { default, .. } => ParamValue::Integer(*default),
        SettingKind::Number { default, .. } => ParamValue::Number(*default),
    }
}

fn parse(kind: &SettingKind, text: &str) -> Option<SettingValue> {
    match kind {
        SettingKind::Bool { .. } => text.parse().ok().map(ParamValue::Bool),
        SettingKind::OneOf { of, .. } => text.parse().ok().filter(|value| of.contains(value)).map(ParamValue::Integer),
        SettingKind::Integer { min, max, .. } => {
            text.parse().ok().filter(|value| (min..=max).contains(&value)).map(ParamValue::Integer)
        }
        SettingKind::Number { min, max, .. } => {
            text.parse().ok().filter(|value| (min..=max).contains(&value)).map(ParamValue::Number)
        }
    }
}
