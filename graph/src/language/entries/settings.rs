//! `settings`: values that a user may choose.

use super::list::entries;
use crate::base::Code;
use crate::fields;
use crate::language::model::{Setting, SettingKind};
use crate::ron::{FieldTable, Form, Leaf, Names, PlainForm, Reader, Shape, Word, WordContents, Words};
use std::collections::BTreeSet;
use std::sync::Arc;

fields! {
    /// A setting: a value that a user may choose.
    /// ```ron
    /// (name: "msaa", value: OneOf(default: 4, of: [1, 2, 4, 8]), about: "samples of colour and depth")
    /// ```
    pub(crate) struct SettingFields<'src> as "Setting" {
        /// Its name, as in `--set NAME=VALUE` and in expressions.
        name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// The allowed values, and the value without a choice.
        value: Leaf<'src> => Form::Words(&KINDS),
        /// A description for people.
        about: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
    }
}

/// A value that a user chooses.
pub(crate) const VALUE: Form =
    Form::Either(&[Form::Plain(PlainForm::Truth), Form::Plain(PlainForm::Number), Form::Plain(PlainForm::Text)]);

/// The kinds of setting.
static KINDS: Words = Words {
    name: "SettingValue",
    what: "a setting's value",
    or: &[],
    all: &[
        Word::new(
            "Bool",
            &[WordContents::Fields(BoolFields::<'static>::table)],
            &["Bool(default: true)"],
            "`true` or `false`.",
        ),
        Word::new(
            "OneOf",
            &[WordContents::Fields(OneOfFields::<'static>::table)],
            &["OneOf(default: 4, of: [1, 2, 4])", "OneOf(default: \"low\", of: [\"low\", \"high\"])"],
            "One of several whole numbers, or of several texts.",
        ),
        Word::new(
            "Number",
            &[WordContents::Fields(NumberFields::<'static>::table)],
            &["Number(default: 1.0, min: 0.0, max: 2.0)"],
            "A number.",
        ),
        Word::new(
            "Integer",
            &[WordContents::Fields(IntegerFields::<'static>::table)],
            &["Integer(default: 1, min: 0, max: 9)"],
            "A whole number.",
        ),
    ],
};

fields! {
    /// A choice between true and false.
    struct BoolFields<'src> {
        /// The value without a choice.
        default: Leaf<'src> => Form::Plain(PlainForm::Truth),
    }
}

fields! {
    /// A choice from a list.
    struct OneOfFields<'src> {
        /// The value without a choice.
        default: Leaf<'src> => LISTED,
        /// All allowed values, each once.
        of: Leaf<'src> => Form::List(&LISTED),
    }
}

/// An element of a list of values: a whole number or a text.
pub(crate) const LISTED: Form = Form::Either(&[Form::Plain(PlainForm::Whole), Form::Plain(PlainForm::Text)]);

fields! {
    /// A choice from a range of numbers.
    struct NumberFields<'src> {
        /// The value without a choice.
        default: Leaf<'src> => Form::Plain(PlainForm::Number),
        /// The least value.
        min: Leaf<'src> => Form::Plain(PlainForm::Number),
        /// The greatest value.
        max: Leaf<'src> => Form::Plain(PlainForm::Number),
        /// The distance between allowed values, from `min` on; any distance if left out.
        step: Option<Leaf<'src>> => Form::Plain(PlainForm::Number),
    }
}

fields! {
    /// A choice from a range of whole numbers.
    struct IntegerFields<'src> {
        /// The value without a choice.
        default: Leaf<'src> => Form::Plain(PlainForm::Whole),
        /// The least value.
        min: Leaf<'src> => Form::Plain(PlainForm::Whole),
        /// The greatest value.
        max: Leaf<'src> => Form::Plain(PlainForm::Whole),
        /// The distance between allowed values, from `min` on; 1 if left out.
        step: Option<Leaf<'src>> => Form::Plain(PlainForm::Whole),
    }
}

/// The settings of a pipeline.
pub(crate) const SETTINGS: Form = Form::List(&Form::Fields(SettingFields::<'static>::table));

/// A list of settings and their names; `None` where one couldn't be read.
pub(crate) fn list(reader: &mut Reader, list: Option<Leaf<'_>>) -> (Names, Vec<Option<Setting>>) {
    let mut names = Names::new("setting", Code::UNKNOWN_SETTING);
    let listed: Vec<Option<SettingFields<'_>>> = entries(reader, list, "`settings`", "setting", &mut names);
    let read = |fields: &Option<SettingFields<'_>>| fields.as_ref().and_then(|fields| setting(reader, fields));
    (names, listed.iter().map(read).collect())
}

/// A setting.
fn setting<'src>(reader: &mut Reader, fields: &SettingFields<'src>) -> Option<Setting> {
    let name = reader.name(fields.name, "a setting");
    let about = match fields.about {
        Some(about) => Some(reader.words(about, "a description")?),
        None => None,
    };
    let kind = kind(reader, fields.value)?;
    Some(Setting { name: name?, kind, about })
}

fn kind<'src>(reader: &mut Reader, leaf: Leaf<'src>) -> Option<SettingKind> {
    let (word, rest) = reader.one_of(leaf, &KINDS)?;
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
            let fields: NumberFields<'_> = reader.inside(leaf, rest, "Number(default: …, min: …, max: …)")?;
            let (default, min, max) =
                (reader.number(fields.default), reader.number(fields.min), reader.number(fields.max));
            let step = step(reader, fields.step, |reader, leaf| reader.number(leaf), 0.0);
            let (default, min, max) = (default?, min?, max?);
            in_range(reader, [fields.default, fields.min], (default, min, max))?;
            let step = step?;
            in_steps(reader, fields.step, step.is_none_or(|step| step <= max - min), (min, max))?;
            let kind = SettingKind::Number { default, min, max, step };
            default_on_step(reader, fields.default, &kind)?;
            Some(kind)
        }
        _ => {
            let fields: IntegerFields<'_> = reader.inside(leaf, rest, "Integer(default: …, min: …, max: …)")?;
            let (default, min, max) =
                (reader.integer(fields.default), reader.integer(fields.min), reader.integer(fields.max));
            let step = step(reader, fields.step, |reader, leaf| reader.integer(leaf), 0);
            let (default, min, max) = (default?, min?, max?);
            in_range(reader, [fields.default, fields.min], (default, min, max))?;
            let step = step?;
            let range = i128::from(max) - i128::from(min);
            in_steps(reader, fields.step, step.is_none_or(|step| i128::from(step) <= range), (min, max))?;
            let kind = SettingKind::Integer { default, min, max, step: step.unwrap_or(1) };
            default_on_step(reader, fields.default, &kind)?;
            Some(kind)
        }
    }
}

/// A step, greater than `zero`.
pub(crate) fn step<'src, T: PartialOrd + std::fmt::Display>(
    reader: &mut Reader,
    leaf: Option<Leaf<'src>>,
    read: impl FnOnce(&mut Reader, Leaf<'src>) -> Option<T>,
    zero: T,
) -> Option<Option<T>> {
    let Some(leaf) = leaf else { return Some(None) };
    let step = read(reader, leaf)?;
    if step <= zero {
        reader.wrong(Code::RANGE_EMPTY, leaf, format!("a step is greater than 0, found {step}"), "");
        return None;
    }
    Some(Some(step))
}

/// Reports a step that is larger than the range.
fn in_steps<T: std::fmt::Display>(
    reader: &mut Reader,
    leaf: Option<Leaf<'_>>,
    fits: bool,
    (min, max): (T, T),
) -> Option<()> {
    if let Some(leaf) = leaf.filter(|_| !fits) {
        reader.wrong(Code::RANGE_EMPTY, leaf, format!("this step is larger than the range from {min} to {max}"), "");
        return None;
    }
    Some(())
}

/// Reports a default that lies between two steps.
pub(crate) fn default_on_step(reader: &mut Reader, leaf: Leaf<'_>, kind: &SettingKind) -> Option<()> {
    let default = kind.default();
    if kind.allows(&default) {
        return Some(());
    }
    reader.wrong(
        Code::DEFAULT_NOT_ALLOWED,
        leaf,
        format!("the default `{default}` lies between two steps"),
        &kind.instead_of(&default),
    );
    None
}

fn one_of<'src>(reader: &mut Reader, fields: &OneOfFields<'src>) -> Option<SettingKind> {
    let entries = reader.list(fields.of, "`of`")?;
    let Some(first) = entries.first() else {
        reader.wrong(Code::RANGE_EMPTY, fields.of, "the list `of` is empty, so no value is allowed", "");
        return None;
    };
    if let Shape::Text = first.shape() {
        let text = |reader: &mut Reader, leaf: Leaf<'src>| reader.words(leaf, "a text").map(Arc::<str>::from);
        let (default, of) = listed(reader, fields.default, &entries, text)?;
        return Some(SettingKind::Choice { default, of });
    }
    let (default, of) = listed(reader, fields.default, &entries, |reader, leaf| reader.integer(leaf))?;
    Some(SettingKind::OneOf { default, of })
}

/// The default and all values of a list, each once, the default among them.
pub(crate) fn listed<'src, T: Ord + Clone + std::fmt::Display>(
    reader: &mut Reader,
    default: Leaf<'src>,
    entries: &[Leaf<'src>],
    read: impl Fn(&mut Reader, Leaf<'src>) -> Option<T>,
) -> Option<(T, Vec<T>)> {
    let chosen = read(reader, default);
    let mut of = Vec::with_capacity(entries.len());
    let mut seen = BTreeSet::new();
    let mut complete = true;
    for entry in entries {
        match read(reader, *entry) {
            Some(value) if !seen.insert(value.clone()) => {
                reader.wrong(Code::LISTED_TWICE, *entry, format!("`{value}` is listed twice"), "");
            }
            Some(value) => of.push(value),
            None => complete = false,
        }
    }
    let chosen = chosen?;
    if complete && !seen.contains(&chosen) {
        reader.wrong(Code::DEFAULT_NOT_ALLOWED, default, format!("the default `{chosen}` is not in the list `of`"), "");
        return None;
    }
    complete.then_some((chosen, of))
}

fn in_range<T: PartialOrd + std::fmt::Display>(
    reader: &mut Reader,
    [leaf, least]: [Leaf<'_>; 2],
    (default, min, max): (T, T, T),
) -> Option<()> {
    if min > max {
        reader.wrong(Code::RANGE_EMPTY, least, format!("`min` ({min}) is greater than `max` ({max})"), "");
        return None;
    }
    if default < min || default > max {
        reader.wrong(
            Code::DEFAULT_NOT_ALLOWED,
            leaf,
            format!("the default `{default}` lies outside {min} to {max}"),
            "",
        );
        return None;
    }
    Some(())
}
