//! `settings`: what a user may choose.

use super::leaf::Leaf;
use super::pipeline::{Setting, SettingKind};
use super::reader::Reader;
use crate::fields;
use std::collections::BTreeSet;

fields! {
    pub(super) struct SettingFields<'src> as "Setting" {
        name: Leaf<'src>,
        value: Leaf<'src>,
        about: Option<Leaf<'src>>,
    }
}

fields! {
    struct BoolFields<'src> {
        default: Leaf<'src>,
    }
}

fields! {
    struct OneOfFields<'src> {
        default: Leaf<'src>,
        of: Leaf<'src>,
    }
}

fields! {
    struct RangeFields<'src> {
        default: Leaf<'src>,
        min: Leaf<'src>,
        max: Leaf<'src>,
    }
}

const FORMS: &str = "a setting's value is `Bool(default: …)`, `OneOf(default: …, of: […])`, \
                     `Number(default: …, min: …, max: …)` or `Integer(default: …, min: …, max: …)`";

impl SettingKind {
    /// What it is called in messages.
    #[must_use]
    pub fn words(&self) -> &'static str {
        match self {
            SettingKind::Bool { .. } => "`true` or `false`",
            SettingKind::OneOf { .. } => "one of several whole numbers",
            SettingKind::Number { .. } => "a number",
            SettingKind::Integer { .. } => "a whole number",
        }
    }

    /// What it allows, for people.
    #[must_use]
    pub fn allowed(&self) -> String {
        match self {
            SettingKind::Bool { .. } => "`true` or `false`".to_owned(),
            SettingKind::OneOf { of, .. } => {
                let all: Vec<String> = of.iter().map(i64::to_string).collect();
                format!("one of {}", all.join(", "))
            }
            SettingKind::Number { min, max, .. } => format!("a number from {} to {}", shown(*min), shown(*max)),
            SettingKind::Integer { min, max, .. } => format!("a whole number from {min} to {max}"),
        }
    }
}

/// A number, as it is shown: whole ones without a fraction, very large and small ones with an exponent.
pub(crate) fn shown(number: f64) -> String {
    let text = format!("{number:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

/// A setting, once its fields are told apart.
pub(super) fn lower<'src>(reader: &mut Reader, fields: &SettingFields<'src>) -> Option<Setting> {
    let name = reader.name(fields.name, "a setting");
    let about = match fields.about {
        Some(about) => Some(reader.words(about, "a description")?),
        None => None,
    };
    let kind = kind(reader, fields.value)?;
    Some(Setting { name: name?, kind, about })
}

fn kind<'src>(reader: &mut Reader, leaf: Leaf<'src>) -> Option<SettingKind> {
    let (word, rest) = reader.word(leaf, "a setting's value", &["Bool", "OneOf", "Number", "Integer"], FORMS)?;
    match word {
        "Bool" => {
            let fields: BoolFields<'_> = reader.inside(leaf, rest, "Bool(default: …)")?;
            Some(SettingKind::Bool { default: reader.truth(fields.default)? })
        }
        "OneOf" => {
            let fields: OneOfFields<'_> = reader.inside(leaf, rest, "OneOf(default: …, of: […])")?;
            one_of(reader, &fields)
        }
        "Number" => {
            let fields: RangeFields<'_> = reader.inside(leaf, rest, "Number(default: …, min: …, max: …)")?;
            let (default, min, max) =
                (reader.number(fields.default), reader.number(fields.min), reader.number(fields.max));
            let (default, min, max) = (default?, min?, max?);
            in_range(reader, &fields, default, min, max)?;
            Some(SettingKind::Number { default, min, max })
        }
        _ => {
            let fields: RangeFields<'_> = reader.inside(leaf, rest, "Integer(default: …, min: …, max: …)")?;
            let (default, min, max) =
                (reader.integer(fields.default), reader.integer(fields.min), reader.integer(fields.max));
            let (default, min, max) = (default?, min?, max?);
            in_range(reader, &fields, default, min, max)?;
            Some(SettingKind::Integer { default, min, max })
        }
    }
}

fn one_of<'src>(reader: &mut Reader, fields: &OneOfFields<'src>) -> Option<SettingKind> {
    let default = reader.integer(fields.default);
    let entries = reader.list(fields.of, "`of`")?;
    if entries.is_empty() {
        reader.wrong(fields.of, "the list `of` is empty, so no value is allowed", "");
        return None;
    }
    let mut of = Vec::with_capacity(entries.len());
    let mut seen = BTreeSet::new();
    let mut complete = true;
    for entry in entries {
        match reader.integer(entry) {
            Some(value) if !seen.insert(value) => reader.wrong(entry, format!("`{value}` is listed twice"), ""),
            Some(value) => of.push(value),
            None => complete = false,
        }
    }
    let default = default?;
    if complete && !seen.contains(&default) {
        reader.wrong(fields.default, format!("the default `{default}` is not in the list `of`"), "");
        return None;
    }
    complete.then_some(SettingKind::OneOf { default, of })
}

fn in_range<'src, T: PartialOrd + std::fmt::Display>(
    reader: &mut Reader,
    fields: &RangeFields<'src>,
    default: T,
    min: T,
    max: T,
) -> Option<()> {
    if min > max {
        reader.wrong(fields.min, format!("`min` ({min}) is greater than `max` ({max})"), "");
        return None;
    }
    if default < min || default > max {
        reader.wrong(fields.default, format!("the default `{default}` lies outside {min} to {max}"), "");
        return None;
    }
    Some(())
}
