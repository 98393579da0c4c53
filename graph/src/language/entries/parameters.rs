//! `parameters`: the arguments that each use of a fragment gives.

use super::list;
use super::settings::{LISTED, default_on_step, listed, step};
use super::values::optional;
use crate::base::Code;
use crate::fields;
use crate::language::model::SettingKind;
use crate::language::scope::{Parameter, ParameterKind};
use crate::ron::{FieldTable, Form, Leaf, PlainForm, Reader, Shape, Word, WordContents, Words};
use crate::vulkan::Format;
use std::sync::Arc;

fields! {
    /// A parameter: an argument that each use of the fragment gives.
    /// ```ron
    /// (name: "levels", value: Integer(default: 5, min: 1, max: 8), about: "how far light runs over")
    /// ```
    pub(crate) struct ParameterFields<'src> as "Parameter" {
        /// Its name, as in `with` and in expressions.
        name: Leaf<'src> => Form::Plain(PlainForm::Name),
        /// The kind of its values. A parameter without `default` has to be given.
        value: Leaf<'src> => Form::Words(&KINDS),
        /// A description for people.
        about: Option<Leaf<'src>> => Form::Plain(PlainForm::Text),
    }
}

/// The kinds of parameter.
static KINDS: Words = Words {
    name: "ParameterValue",
    what: "a kind of parameter",
    or: &[],
    all: &[
        Word::alone("Image", "An image."),
        Word::alone("Buffer", "A buffer."),
        Word::new(
            "Bool",
            &[WordContents::Nothing, WordContents::Fields(ParameterBoolFields::<'static>::table)],
            &["Bool"],
            "`true` or `false`.",
        ),
        Word::new(
            "Integer",
            &[WordContents::Nothing, WordContents::Fields(ParameterIntegerFields::<'static>::table)],
            &["Integer", "Integer(default: 1, min: 0, max: 9)"],
            "A whole number.",
        ),
        Word::new(
            "Number",
            &[WordContents::Nothing, WordContents::Fields(ParameterNumberFields::<'static>::table)],
            &["Number"],
            "A number.",
        ),
        Word::new(
            "OneOf",
            &[WordContents::Fields(ParameterOneOfFields::<'static>::table)],
            &["OneOf(of: [1, 2, 4])"],
            "One of several whole numbers, or of several texts.",
        ),
        Word::new(
            "Format",
            &[WordContents::Nothing, WordContents::Fields(ParameterFormatFields::<'static>::table)],
            &["Format", "Format(default: R8_UNORM)"],
            "A format of Vulkan's.",
        ),
    ],
};

fields! {
    /// A parameter that is true or false.
    #[derive(Default)]
    struct ParameterBoolFields<'src> {
        /// The value if none is given.
        default: Option<Leaf<'src>> => Form::Plain(PlainForm::Truth),
    }
}

fields! {
    /// A parameter that is a format.
    #[derive(Default)]
    struct ParameterFormatFields<'src> {
        /// The format if none is given.
        default: Option<Leaf<'src>> => FORMAT,
    }
}

/// A format by Vulkan's name.
pub(crate) const FORMAT: Form =
    Form::Choice("a format of Vulkan's", || Format::ALL.iter().map(|format| format.name()).collect());

fields! {
    /// A parameter that is one of a list.
    struct ParameterOneOfFields<'src> {
        /// The value if none is given.
        default: Option<Leaf<'src>> => LISTED,
        /// All allowed values, each once.
        of: Leaf<'src> => Form::List(&LISTED),
    }
}

fields! {
    /// A parameter that is a number.
    #[derive(Default)]
    struct ParameterNumberFields<'src> {
        /// The value if none is given.
        default: Option<Leaf<'src>> => Form::Plain(PlainForm::Number),
        /// The least value; any if left out.
        min: Option<Leaf<'src>> => Form::Plain(PlainForm::Number),
        /// The greatest value; any if left out.
        max: Option<Leaf<'src>> => Form::Plain(PlainForm::Number),
        /// The distance between allowed values, from `min` on.
        step: Option<Leaf<'src>> => Form::Plain(PlainForm::Number),
    }
}

fields! {
    /// A parameter that is a whole number.
    #[derive(Default)]
    struct ParameterIntegerFields<'src> {
        /// The value if none is given.
        default: Option<Leaf<'src>> => Form::Plain(PlainForm::Whole),
        /// The least value; any if left out.
        min: Option<Leaf<'src>> => Form::Plain(PlainForm::Whole),
        /// The greatest value; any if left out.
        max: Option<Leaf<'src>> => Form::Plain(PlainForm::Whole),
        /// The distance between allowed values, from `min` on; 1 if left out.
        step: Option<Leaf<'src>> => Form::Plain(PlainForm::Whole),
    }
}

/// A parameter.
pub(crate) fn parameter<'src>(reader: &mut Reader, fields: &ParameterFields<'src>) -> Option<Parameter> {
    let name = reader.name(fields.name, "a parameter");
    if let Some(about) = fields.about {
        reader.words(about, "a description")?;
    }
    let (kind, required) = kind(reader, fields.value)?;
    Some(Parameter { name: name?, kind, required })
}

/// The kind of a parameter, and whether it has to be given.
fn kind<'src>(reader: &mut Reader, leaf: Leaf<'src>) -> Option<(ParameterKind, bool)> {
    let (word, rest) = reader.one_of(leaf, &KINDS)?;
    let (kind, default_at) = match word {
        "Image" => return reader.bare(word, rest).map(|()| (ParameterKind::Image, true)),
        "Buffer" => return reader.bare(word, rest).map(|()| (ParameterKind::Buffer, true)),
        "Format" => {
            let fields = list::within::<ParameterFormatFields<'_>>(reader, leaf, rest, "Format(default: …)")?;
            let default = match fields.default {
                Some(default) => Some(format(reader, default)?),
                None => None,
            };
            return Some((ParameterKind::Format { default }, default.is_none()));
        }
        "Bool" => {
            let fields = list::within::<ParameterBoolFields<'_>>(reader, leaf, rest, "Bool(default: …)")?;
            let default = match fields.default {
                Some(default) => reader.truth(default)?,
                None => false,
            };
            (SettingKind::Bool { default }, fields.default)
        }
        "OneOf" => one_of(reader, leaf, rest)?,
        "Number" => {
            let fields =
                list::within::<ParameterNumberFields<'_>>(reader, leaf, rest, "Number(default: …, min: …, max: …)")?;
            let read = |reader: &mut Reader, leaf| reader.number(leaf);
            let (default, min, max) =
                range(reader, [fields.default, fields.min, fields.max], read, (f64::MIN, f64::MAX))?;
            steps_begin(reader, fields.step, fields.min)?;
            let step = step(reader, fields.step, read, 0.0)?;
            (SettingKind::Number { default: default.unwrap_or(min), min, max, step }, fields.default)
        }
        _ => {
            let fields =
                list::within::<ParameterIntegerFields<'_>>(reader, leaf, rest, "Integer(default: …, min: …, max: …)")?;
            let read = |reader: &mut Reader, leaf| reader.integer(leaf);
            let (default, min, max) =
                range(reader, [fields.default, fields.min, fields.max], read, (i64::MIN, i64::MAX))?;
            steps_begin(reader, fields.step, fields.min)?;
            let step = step(reader, fields.step, read, 0)?.unwrap_or(1);
            (SettingKind::Integer { default: default.unwrap_or(min), min, max, step }, fields.default)
        }
    };
    if let Some(default) = default_at {
        default_on_step(reader, default, &kind)?;
    }
    Some((ParameterKind::Value(kind), default_at.is_none()))
}

fn one_of<'src>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    rest: Option<Leaf<'src>>,
) -> Option<(SettingKind, Option<Leaf<'src>>)> {
    let fields: ParameterOneOfFields<'_> = reader.inside(leaf, rest, "OneOf(default: …, of: […])")?;
    let entries = reader.list(fields.of, "`of`")?;
    let Some(first) = entries.first().copied() else {
        reader.wrong(Code::RANGE_EMPTY, fields.of, "the list `of` is empty, so no value is allowed", "");
        return None;
    };
    let default = fields.default.unwrap_or(first);
    let kind = if let Shape::Text = first.shape() {
        let text = |reader: &mut Reader, leaf: Leaf<'src>| reader.words(leaf, "a text").map(Arc::from);
        let (default, of) = listed(reader, default, &entries, text)?;
        SettingKind::Choice { default, of }
    } else {
        let (default, of) = listed(reader, default, &entries, |reader, leaf| reader.integer(leaf))?;
        SettingKind::OneOf { default, of }
    };
    Some((kind, fields.default))
}

/// Reports a step without `min`, where steps begin.
fn steps_begin(reader: &mut Reader, step: Option<Leaf<'_>>, min: Option<Leaf<'_>>) -> Option<()> {
    let Some(step) = step.filter(|_| min.is_none()) else { return Some(()) };
    reader.wrong(
        Code::RANGE_EMPTY,
        step,
        "steps begin at `min`, and there is none",
        "add `min: …`, or leave out `step`",
    );
    None
}

/// Default, least and greatest value; `whole` is the range if the file says none.
fn range<'src, T: PartialOrd + Copy + std::fmt::Display>(
    reader: &mut Reader,
    [default_leaf, min_leaf, max_leaf]: [Option<Leaf<'src>>; 3],
    read: impl Fn(&mut Reader, Leaf<'src>) -> Option<T>,
    whole: (T, T),
) -> Option<(Option<T>, T, T)> {
    let mut value = |leaf: Option<Leaf<'src>>| optional(leaf, |leaf| read(reader, leaf));
    let (default, min, max) = (value(default_leaf), value(min_leaf), value(max_leaf));
    let (default, min, max) = (default?, min?.unwrap_or(whole.0), max?.unwrap_or(whole.1));
    if let Some(leaf) = min_leaf.or(max_leaf).filter(|_| min > max) {
        reader.wrong(Code::RANGE_EMPTY, leaf, format!("`min` ({min}) is greater than `max` ({max})"), "");
        return None;
    }
    if let (Some(leaf), Some(default)) = (default_leaf, default)
        && (default < min || default > max)
    {
        let wrong = if default < min {
            format!("the default `{default}` is less than `min` ({min})")
        } else {
            format!("the default `{default}` is greater than `max` ({max})")
        };
        reader.wrong(Code::DEFAULT_NOT_ALLOWED, leaf, wrong, "");
        return None;
    }
    Some((default, min, max))
}

/// A format by Vulkan's name.
pub(crate) fn format(reader: &mut Reader, leaf: Leaf<'_>) -> Option<Format> {
    let known: Vec<&'static str> = Format::ALL.iter().map(|format| format.name()).collect();
    let (word, rest) = reader.word(leaf, "a format", &known, "formats are Vulkan's, such as `R16G16B16A16_SFLOAT`")?;
    reader.bare(word, rest)?;
    Format::from_name(word)
}
