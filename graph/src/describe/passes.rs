//! `passes`: what each draws, when, and what stands in for it when it is off.

use super::leaf::Leaf;
use super::names::Scope;
use super::pipeline::{Color, Depth, Forward, Name, Pass};
use super::reader::Reader;
use super::{Diagnostic, bindings, condition, targets};
use crate::frame::{Draw, DrawList};
use serde::Deserialize;
use std::collections::HashMap;

#[derive(Deserialize)]
#[serde(rename = "Pass", deny_unknown_fields)]
pub(super) struct PassFields<'src> {
    #[serde(borrow)]
    name: Leaf<'src>,
    draw: Leaf<'src>,
    shader: Option<Leaf<'src>>,
    sample: Option<Leaf<'src>>,
    color: Option<Leaf<'src>>,
    depth: Option<Leaf<'src>>,
    params: Option<Leaf<'src>>,
    when: Option<Leaf<'src>>,
    otherwise: Option<Leaf<'src>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ForwardFields<'src> {
    #[serde(borrow)]
    from: Leaf<'src>,
    to: Leaf<'src>,
}

const DRAWS: &str = "a draw is `Objects(Opaque)`, `Objects(Masked)`, `Objects(Transparent)`, `Sky` or \
                     `FullScreen(\"shader\")`";

/// A pass, once its fields are told apart.
pub(super) fn lower<'src>(reader: &mut Reader<'src>, scope: &Scope<'_>, fields: &PassFields<'src>) -> Option<Pass> {
    let name = reader.name(fields.name, "a pass");
    let what = name.as_ref().map_or_else(|| "this pass".to_owned(), |name| format!("pass `{}`", name.text));
    let draw = draw(reader, fields, &what);
    let when = optional(fields.when, |leaf| condition::lower(reader, scope, leaf));
    let sample = optional(fields.sample, |leaf| bindings::samples(reader, scope, leaf));
    let color = optional(fields.color, |leaf| targets::color(reader, scope, leaf));
    let depth = optional(fields.depth, |leaf| targets::depth(reader, scope, leaf));
    let params = optional(fields.params, |leaf| bindings::params(reader, scope, leaf));
    let otherwise = optional(fields.otherwise, |leaf| forward(reader, scope, leaf));

    if let (Some(color), Some(depth)) = (&color, &depth) {
        targets_make_sense(reader, fields, &what, color.as_deref().unwrap_or(&[]), depth.as_ref());
        if let (Some(otherwise), Some(leaf)) = (otherwise.flatten(), fields.otherwise) {
            forward_makes_sense(reader, fields, leaf, &otherwise, color.as_deref().unwrap_or(&[]), depth.as_ref());
        }
    }
    let (draw, shader) = draw?;
    Some(Pass {
        name: name?,
        when: when?,
        draw,
        shader,
        sample: sample?.unwrap_or_default(),
        color: color?.unwrap_or_default(),
        depth: depth?,
        params: params?.unwrap_or_default(),
        otherwise: otherwise?,
    })
}

/// A field that may be absent: `None` if it is there and wrong.
fn optional<'src, T>(leaf: Option<Leaf<'src>>, lower: impl FnOnce(Leaf<'src>) -> Option<T>) -> Option<Option<T>> {
    match leaf {
        Some(leaf) => lower(leaf).map(Some),
        None => Some(None),
    }
}

/// What is drawn, by which shader.
fn draw<'src>(reader: &mut Reader<'src>, fields: &PassFields<'src>, what: &str) -> Option<(Draw, Name)> {
    let leaf = fields.draw;
    let (word, rest) = reader.word(leaf, "a draw", &["Objects", "Sky", "FullScreen"], DRAWS)?;
    match word {
        "FullScreen" => {
            let (shader,): (Leaf<'_>,) = reader.inside(leaf, rest, "FullScreen(\"shader\")")?;
            if let Some(second) = fields.shader {
                reader.wrong(second, format!("{what} names its shader in `FullScreen(…)` already"), "");
                return None;
            }
            Some((Draw::FullScreen, reader.name(shader, "a shader")?))
        }
        "Sky" => {
            reader.bare(word, rest)?;
            let shader = match fields.shader {
                Some(shader) => reader.name(shader, "a shader")?,
                None => Name { text: "sky".into(), span: reader.span(leaf.0) },
            };
            Some((Draw::Sky, shader))
        }
        _ => {
            let (list,): (Leaf<'_>,) = reader.inside(leaf, rest, "Objects(Opaque)")?;
            let (list, rest) = reader.word(list, "a draw list", &["Opaque", "Masked", "Transparent"], DRAWS)?;
            reader.bare(list, rest)?;
            let list = match list {
                "Opaque" => DrawList::Opaque,
                "Masked" => DrawList::Masked,
                _ => DrawList::Transparent,
            };
            let Some(shader) = fields.shader else {
                reader.wrong(leaf, format!("{what} draws objects and needs a shader"), "add `shader: \"…\"`");
                return None;
            };
            Some((Draw::Objects(list), reader.name(shader, "a shader")?))
        }
    }
}

/// What a target takes when the pass is off.
fn forward<'src>(reader: &mut Reader<'src>, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Forward> {
    let form = "Forward(from: \"image\", to: \"image\")";
    let (_, rest) = reader.word(leaf, "a stand-in", &["Forward"], &format!("write `{form}`"))?;
    let fields: ForwardFields<'_> = reader.inside(leaf, rest, form)?;
    let (from, to) = (scope.image(reader, fields.from), scope.image(reader, fields.to));
    Some(Forward { from: from?, to: to? })
}

/// A pass draws into something, and into each image once.
fn targets_make_sense(
    reader: &mut Reader<'_>,
    fields: &PassFields<'_>,
    what: &str,
    color: &[Color],
    depth: Option<&Depth>,
) {
    if color.is_empty() && depth.is_none() {
        let nothing = Diagnostic::new(reader.span(fields.name.0), format!("{what} draws into nothing"));
        reader.report(nothing.help("give it `color: [\"image\"]` or `depth: \"image\"`"));
    }
    let mut first = HashMap::new();
    for target in color.iter().map(|c| c.image).chain(depth.map(|d| d.image)) {
        if let Some(first) = first.insert(target.index, target.span) {
            let twice = Diagnostic::new(target.span, format!("{what} draws into this image twice"));
            reader.report(twice.remark("again here").label(first, "first here"));
        }
    }
}

/// A stand-in fills one of the pass's own targets, from another image.
fn forward_makes_sense(
    reader: &mut Reader<'_>,
    fields: &PassFields<'_>,
    leaf: Leaf<'_>,
    forward: &Forward,
    color: &[Color],
    depth: Option<&Depth>,
) {
    if fields.when.is_none() {
        let idle = Diagnostic::new(reader.span(leaf.0), "`otherwise` never comes to pass: there is no `when`");
        reader.report(idle.help("add `when`, or remove `otherwise`"));
    }
    if forward.from.index == forward.to.index {
        let same = Diagnostic::new(forward.to.span, "an image can't be forwarded to itself");
        reader.report(same.label(forward.from.span, "the same image"));
        return;
    }
    let mut targets = color.iter().map(|c| c.image).chain(depth.map(|d| d.image));
    if !targets.any(|target| target.index == forward.to.index) {
        let foreign = Diagnostic::new(forward.to.span, "`otherwise` fills an image that this pass doesn't draw into");
        reader.report(foreign.help("`to` is one of the pass's `color` images, or its `depth`"));
    }
}
