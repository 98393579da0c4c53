//! A settings file with chosen values.

use crate::system::text;
use framewright_graph::language::{Document, SettingKind};
use std::collections::BTreeMap;

/// The text of a settings file. `document` is the pipeline, if it is known: it tells a text from a number that looks the same.
pub(super) fn text(settings: &BTreeMap<String, String>, document: Option<&Document>, about: &str) -> String {
    let kind = |name: &str| {
        let settings = document.map_or(&[][..], |document| &document.settings);
        settings.iter().find(|setting| &*setting.name.text == name).map(|setting| &setting.kind)
    };
    let values = settings.iter().map(|(name, value)| {
        let is_plain = value.parse::<f64>().is_ok_and(f64::is_finite) || value.parse::<bool>().is_ok();
        let is_text = !is_plain || matches!(kind(name), Some(SettingKind::Choice { .. }));
        let value = if is_text { quoted(value) } else { value.clone() };
        format!("        {}: {value},\n", quoted(name))
    });
    format!(
        "// {}\nSettings(\n    version: 1,\n    set: {{\n{}    }},\n)\n",
        text::escape(about),
        values.collect::<String>()
    )
}

/// A text between quotes. Characters that a terminal acts on, or that hide others, are written as RON's escapes.
fn quoted(text: &str) -> String {
    let plain = text.replace('\\', "\\\\").replace('"', "\\\"");
    format!("\"{}\"", text::escape(&plain))
}
