//! Values that several fields take: whole numbers, words, and what images and buffers are filled with.

use super::leaf::{Leaf, Shape};
use super::names::Scope;
use super::pipeline::{SettingKind, Value};
use super::reader::Reader;
use super::resources::Fill;
use std::ops::RangeInclusive;

/// A whole number of `range`, or a setting all of whose values lie there. `what` names it: "number of mip levels".
pub(super) fn whole<'src, T: TryFrom<i64>>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    leaf: Leaf<'src>,
    what: &str,
    range: RangeInclusive<i64>,
) -> Option<Value<T>> {
    let Shape::Text = leaf.shape() else {
        if !matches!(leaf.shape(), Shape::Number) {
            reader.expected(leaf, "a whole number or the name of a setting in quotes");
            return None;
        }
        return constant(reader, leaf, what, range).map(Value::Constant);
    };
    let fits = |kind: &SettingKind| matches!(kind, SettingKind::OneOf { .. } | SettingKind::Integer { .. });
    let setting = scope.setting(reader, leaf, fits, "a whole number")?;
    let odd = match &scope.kinds.get(setting.index)?.as_ref()?.kind {
        SettingKind::OneOf { of, .. } => of.iter().find(|value| !range.contains(value)).copied(),
        SettingKind::Integer { min, max, .. } => [*min, *max].into_iter().find(|value| !range.contains(value)),
        SettingKind::Bool { .. } | SettingKind::Number { .. } => None,
    };
    if let Some(odd) = odd {
        let message = format!("this setting allows {odd}, which is no {what}");
        reader.wrong(leaf, message, &format!("{} to {} are allowed", range.start(), range.end()));
        return None;
    }
    Some(Value::Setting(setting))
}

/// A whole number of `range`.
pub(super) fn constant<'src, T: TryFrom<i64>>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    what: &str,
    range: RangeInclusive<i64>,
) -> Option<T> {
    let number = reader.integer(leaf)?;
    let fitting = T::try_from(number).ok().filter(|_| range.contains(&number));
    if fitting.is_none() {
        let (least, most) = (range.start(), range.end());
        reader.wrong(leaf, format!("{number} is no {what}: {least} to {most} are allowed"), "");
    }
    fitting
}

/// One of a few words.
pub(super) fn choice<'src, T: Copy>(
    reader: &mut Reader,
    leaf: Leaf<'src>,
    what: &str,
    choices: &[(&'static str, T)],
) -> Option<T> {
    let words: Vec<&'static str> = choices.iter().map(|(word, _)| *word).collect();
    let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    let forms = match &quoted[..] {
        [one, other] => format!("write {one} or {other}"),
        several => format!("write one of {}", several.join(", ")),
    };
    let (word, rest) = reader.word(leaf, what, &words, &forms)?;
    reader.bare(word, rest)?;
    choices.iter().find(|(choice, _)| *choice == word).map(|(_, value)| *value)
}

const FILLS: &str = "a value is a number, `(depth, stencil)` or `(red, green, blue, alpha)`";

/// What an image or buffer is filled with.
pub(super) fn fill<'src>(reader: &mut Reader, leaf: Leaf<'src>) -> Option<Fill> {
    if !matches!(leaf.shape(), Shape::Parentheses) {
        return reader.number(leaf).map(Fill::Number);
    }
    if let Some([depth, stencil]) = leaf.tuple() {
        let (depth, stencil) = (reader.number(depth), reader.number(stencil));
        return Some(Fill::DepthStencil(depth?, stencil?));
    }
    let Some(parts) = leaf.tuple::<4>() else {
        reader.wrong(leaf, "this is no value for all texels", FILLS);
        return None;
    };
    let parts = parts.map(|part| reader.number(part));
    Some(Fill::Color([parts[0]?, parts[1]?, parts[2]?, parts[3]?]))
}
