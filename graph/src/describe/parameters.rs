//! `parameters`: what whoever uses a fragment gives it.

use super::leaf::{Leaf, Shape};
use super::pipeline::{Name, Setting, SettingKind};
use super::reader::Reader;
use super::settings::{default_on_step, listed, step};
use crate::expression::Value;
use crate::fields;
use crate::format::Format;

/// A setting, or a parameter of a fragment.
#[derive(Debug, Clone)]
pub(super) struct Parameter {
    /// Its name.
    pub(super) name: Name,
    /// What it may be.
    pub(super) kind: ParameterKind,
    /// Whether whoever uses the fragment has to give it. What settings are is chosen elsewhere.
    pub(super) required: bool,
}

/// What a parameter may be.
#[derive(Debug, Clone)]
pub(super) enum ParameterKind {
    /// What a setting may be.
    Value(SettingKind),
    /// An image.
    Image,
    /// A buffer.
    Buffer,
    /// A texel format.
    Format {
        /// If none is given.
        default: Option<Format>,
    },
}

fields! {
    pub(super) struct ParameterFields<'src> as "Parameter" {
        name: Leaf<'src>,
        value: Leaf<'src>,
        about: Option<Leaf<'src>>,
    }
}

fields! {
    #[derive(Default)]
    struct DefaultFields<'src> {
        default: Option<Leaf<'src>>,
    }
}

fields! {
    struct ChoiceFields<'src> {
        default: Option<Leaf<'src>>,
        of: Leaf<'src>,
    }
}

fields! {
    #[derive(Default)]
    struct RangeFields<'src> {
        default: Option<Leaf<'src>>,
        min: Option<Leaf<'src>>,
        max: Option<Leaf<'src>>,
        step: Option<Leaf<'src>>,
    }
}

const FORMS: &str = "a parameter is `Image`, `Buffer`, `Bool`, `Integer`, `Number`, `OneOf(of: […])` or `Format`, most \
                     with `(default: …)`, numbers also with `min`, `max` and `step`";

impl From<&Setting> for Parameter {
    fn from(setting: &Setting) -> Parameter {
        Parameter { name: setting.name.clone(), kind: ParameterKind::Value(setting.kind.clone()), required: false }
    }
}

impl Parameter {
    /// The least number that it allows, if it is a number.
    pub(super) fn least(&self) -> Option<f64> {
        if let ParameterKind::Value(kind) = &self.kind { kind.least() } else { None }
    }

    /// The whole numbers that it allows, if there are only some.
    pub(super) fn one_of(&self) -> &[i64] {
        match &self.kind {
            ParameterKind::Value(SettingKind::OneOf { of, .. }) => of,
            _ => &[],
        }
    }

    /// Its value if none is given.
    pub(super) fn default(&self) -> Option<Value> {
        match &self.kind {
            ParameterKind::Value(kind) if !self.required => Some(kind.default()),
            ParameterKind::Format { default } => default.map(Value::Format),
            _ => None,
        }
    }
}

/// A parameter, once its fields are told apart.
pub(super) fn lower<'src>(reader: &mut Reader, fields: &ParameterFields<'src>) -> Option<Parameter> {
    let name = reader.name(fields.name, "a parameter");
    if let Some(about) = fields.about {
        reader.words(about, "a description")?;
    }
    let (kind, required) = kind(reader, fields.value)?;
    Some(Parameter { name: name?, kind, required })
}

/// What it may be, and whether it has to be given.
fn kind<'src>(reader: &mut Reader, leaf: Leaf<'src>) -> Option<(ParameterKind, bool)> {
    let words = ["Image", "Buffer", "Bool", "Integer", "Number", "OneOf", "Format"];
    let (word, rest) = reader.word(leaf, "a kind of parameter", &words, FORMS)?;
    let (kind, required) = match word {
        "Image" => return reader.bare(word, rest).map(|()| (ParameterKind::Image, true)),
        "Buffer" => return reader.bare(word, rest).map(|()| (ParameterKind::Buffer, true)),
        "Format" => {
            let fields = within::<DefaultFields<'_>>(reader, leaf, rest, "Format(default: …)")?;
            let default = match fields.default {
                Some(default) => Some(format(reader, default)?),
                None => None,
            };
            return Some((ParameterKind::Format { default }, default.is_none()));
        }
        "Bool" => {
            let fields = within::<DefaultFields<'_>>(reader, leaf, rest, "Bool(default: …)")?;
            let default = match fields.default {
                Some(default) => reader.truth(default)?,
                None => false,
            };
            (SettingKind::Bool { default }, fields.default.is_none())
        }
        "OneOf" => one_of(reader, leaf, rest)?,
        "Number" => {
            let fields = within::<RangeFields<'_>>(reader, leaf, rest, "Number(default: …, min: …, max: …)")?;
            let read = |reader: &mut Reader, leaf| reader.number(leaf);
            let (default, min, max) = range(reader, &fields, read, (f64::MIN, f64::MAX))?;
            let step = step(reader, fields.step, read, 0.0)?;
            (SettingKind::Number { default: default.unwrap_or(min), min, max, step }, default.is_none())
        }
        _ => {
            let fields = within::<RangeFields<'_>>(reader, leaf, rest, "Integer(default: …, min: …, max: …)")?;
            let read = |reader: &mut Reader, leaf| reader.integer(leaf);
            let (default, min, max) = range(reader, &fields, read, (i64::MIN, i64::MAX))?;
            let step = step(reader, fields.step, read, 0)?.unwrap_or(1);
            (SettingKind::Integer { default: default.unwrap_or(min), min, max, step }, default.is_none())
        }
    };
    if !required {
        default_on_step(reader, leaf, &kind)?;
    }
    Some((ParameterKind::Value(kind), required))
}

/// What stands in parentheses, if there are any.
fn within<'src, T: super::fields::FromLeaf<'src> + Default>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    rest: Option<Leaf<'src>>,
    form: &str,
) -> Option<T> {
    match rest {
        Some(_) => reader.inside(leaf, rest, form),
        None => Some(T::default()),
    }
}

fn one_of<'src>(reader: &mut Reader, leaf: Leaf<'src>, rest: Option<Leaf<'src>>) -> Option<(SettingKind, bool)> {
    let fields: ChoiceFields<'_> = reader.inside(leaf, rest, "OneOf(default: …, of: […])")?;
    let entries = reader.list(fields.of, "`of`")?;
    let Some(first) = entries.first().copied() else {
        reader.wrong(fields.of, "the list `of` is empty, so no value is allowed", "");
        return None;
    };
    let default = fields.default.unwrap_or(first);
    let kind = if let Shape::Text = first.shape() {
        let text = |reader: &mut Reader, leaf: Leaf<'src>| reader.words(leaf, "a text").map(std::sync::Arc::from);
        let (default, of) = listed(reader, default, &entries, text)?;
        SettingKind::Choice { default, of }
    } else {
        let (default, of) = listed(reader, default, &entries, |reader, leaf| reader.integer(leaf))?;
        SettingKind::OneOf { default, of }
    };
    Some((kind, fields.default.is_none()))
}

/// Default, least and greatest value; `whole` is the range if the file says none.
fn range<'src, T: PartialOrd + Copy + std::fmt::Display>(
    reader: &mut Reader,
    fields: &RangeFields<'src>,
    read: impl Fn(&mut Reader, Leaf<'src>) -> Option<T>,
    whole: (T, T),
) -> Option<(Option<T>, T, T)> {
    let mut value = |leaf: Option<Leaf<'src>>| match leaf {
        Some(leaf) => read(reader, leaf).map(Some),
        None => Some(None),
    };
    let (default, min, max) = (value(fields.default), value(fields.min), value(fields.max));
    let (default, min, max) = (default?, min?.unwrap_or(whole.0), max?.unwrap_or(whole.1));
    if let Some(leaf) = fields.min.or(fields.max).filter(|_| min > max) {
        reader.wrong(leaf, format!("`min` ({min}) is greater than `max` ({max})"), "");
        return None;
    }
    if let (Some(leaf), Some(default)) = (fields.default, default)
        && (default < min || default > max)
    {
        reader.wrong(leaf, format!("the default `{default}` lies outside {min} to {max}"), "");
        return None;
    }
    Some((default, min, max))
}

/// A format by Vulkan's name.
pub(super) fn format(reader: &mut Reader, leaf: Leaf<'_>) -> Option<Format> {
    let known: Vec<&'static str> = Format::ALL.iter().map(|format| format.name()).collect();
    let (word, rest) = reader.word(leaf, "a format", &known, "formats are Vulkan's, such as `R16G16B16A16_SFLOAT`")?;
    reader.bare(word, rest)?;
    Format::from_name(word)
}
