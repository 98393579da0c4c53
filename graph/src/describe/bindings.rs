//! `sample` and `params`: what a pass gives to its shader, by the shader's own names.

use super::Diagnostic;
use super::leaf::{Entries, Leaf, Shape};
use super::names::Scope;
use super::pipeline::{Face, ImageRef, Name, Param, ParamValue, Sample};
use super::reader::Reader;
use crate::vocabulary::Filter;
use serde::Deserialize;
use std::collections::HashMap;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SampleFields<'src> {
    #[serde(borrow)]
    image: Leaf<'src>,
    filter: Option<Leaf<'src>>,
}

const IMAGES: &str = "a sampled image is `\"image\"`, `Samples(\"image\")`, `Resolved(\"image\")` or \
                      `(image: \"image\", filter: Nearest)`";

/// Images by the shader's names.
pub(super) fn samples<'src>(reader: &mut Reader<'src>, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Vec<Sample>> {
    let images = entries(reader, leaf, "`sample`", "a sampled image", |reader, value| {
        let (leaf, filter) = match value.shape() {
            Shape::Parentheses => {
                let fields: SampleFields<'_> = reader.read(value, "a sampled image")?;
                (fields.image, fields.filter)
            }
            _ => (value, None),
        };
        let image = image(reader, scope, leaf);
        let filter = match filter {
            Some(leaf) => {
                let (word, rest) =
                    reader.word(leaf, "a filter", &["Nearest", "Linear"], "write `Nearest` or `Linear`")?;
                reader.bare(word, rest)?;
                Some(reader.spanned(leaf, if word == "Linear" { Filter::Linear } else { Filter::Nearest }))
            }
            None => None,
        };
        let (image, face) = image?;
        Some((image, face, filter))
    })?;
    let sample = |(binding, (image, face, filter))| Sample { binding, image, face, filter };
    Some(images.into_iter().map(sample).collect())
}

fn image<'src>(reader: &mut Reader<'src>, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<(ImageRef, Face)> {
    if let Shape::Text = leaf.shape() {
        return Some((scope.image(reader, leaf)?, Face::Plain));
    }
    let (word, rest) = reader.word(leaf, "a face of an image", &["Samples", "Resolved"], IMAGES)?;
    let (inner,): (Leaf<'_>,) = reader.inside(leaf, rest, &format!("{word}(\"image\")"))?;
    let face = if word == "Samples" { Face::Samples } else { Face::Resolved };
    Some((scope.image(reader, inner)?, face))
}

/// Values by the names of the shader's parameters.
pub(super) fn params<'src>(reader: &mut Reader<'src>, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Vec<Param>> {
    let values = entries(reader, leaf, "`params`", "a parameter", |reader, leaf| {
        let value = match leaf.shape() {
            Shape::Text => ParamValue::Setting(scope.any_setting(reader, leaf)?),
            Shape::Word("true" | "false", None) => ParamValue::Bool(reader.truth(leaf)?),
            Shape::Number if !leaf.0.contains(['.', 'e', 'E']) && reader.probe::<i64>(leaf).is_some() => {
                ParamValue::Integer(reader.integer(leaf)?)
            }
            Shape::Number | Shape::Word("NaN" | "inf", None) => ParamValue::Number(reader.number(leaf)?),
            _ => {
                reader.expected(leaf, "a number, `true`, `false` or the name of a setting in quotes");
                return None;
            }
        };
        Some(reader.spanned(leaf, value))
    })?;
    Some(values.into_iter().map(|(name, value)| Param { name, value }).collect())
}

/// The entries of a map whose keys are names, each once.
fn entries<'src, T>(
    reader: &mut Reader<'src>,
    leaf: Leaf<'src>,
    map: &str,
    what: &str,
    mut lower: impl FnMut(&mut Reader<'src>, Leaf<'src>) -> Option<T>,
) -> Option<Vec<(Name, T)>> {
    let Entries(pairs) = reader.map(leaf, map)?;
    let mut names = HashMap::new();
    let mut list = Vec::new();
    let mut complete = true;
    for (key, value) in pairs {
        let name = reader.reference(key, what);
        if let Some(name) = &name
            && let Some(first) = names.insert(name.text.clone(), name.span)
        {
            let twice = Diagnostic::new(name.span, format!("{map} names `{}` twice", name.text));
            reader.report(twice.remark("again here").label(first, "first here"));
            complete = false;
        }
        match (name, lower(reader, value)) {
            (Some(name), Some(value)) => list.push((name, value)),
            _ => complete = false,
        }
    }
    complete.then_some(list)
}
