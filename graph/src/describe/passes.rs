//! `passes`: what each does, when, and what stands in for it when it is off.

use super::leaf::Leaf;
use super::names::Scope;
use super::pass::{Color, Depth, Forward, Part, Pass, Work};
use super::pipeline::ImageRef;
use super::reader::Reader;
use super::{Diagnostic, bindings, condition, parts, targets, work};
use crate::fields;
use std::collections::HashMap;

fields! {
    pub(super) struct PassFields<'src> as "Pass" {
        pub(super) name: Leaf<'src>,
        pub(super) draw: Option<Leaf<'src>>,
        pub(super) dispatch: Option<Leaf<'src>>,
        pub(super) copy: Option<Leaf<'src>>,
        pub(super) blit: Option<Leaf<'src>>,
        pub(super) fill: Option<Leaf<'src>>,
        pub(super) custom: Option<Leaf<'src>>,
        pub(super) shader: Option<Leaf<'src>>,
        pub(super) groups: Option<Leaf<'src>>,
        pub(super) sample: Option<Leaf<'src>>,
        pub(super) storage: Option<Leaf<'src>>,
        pub(super) uniform: Option<Leaf<'src>>,
        pub(super) vertex: Option<Leaf<'src>>,
        pub(super) index: Option<Leaf<'src>>,
        pub(super) color: Option<Leaf<'src>>,
        pub(super) depth: Option<Leaf<'src>>,
        pub(super) reads: Option<Leaf<'src>>,
        pub(super) writes: Option<Leaf<'src>>,
        pub(super) params: Option<Leaf<'src>>,
        pub(super) side_effect: Option<Leaf<'src>>,
        when: Option<Leaf<'src>>,
        otherwise: Option<Leaf<'src>>,
    }
}

fields! {
    struct ForwardFields<'src> {
        from: Leaf<'src>,
        to: Leaf<'src>,
    }
}

/// A pass, once its fields are told apart.
pub(super) fn lower<'src>(reader: &mut Reader, scope: &Scope<'_>, fields: &PassFields<'src>) -> Option<Pass> {
    let name = reader.name(fields.name, "a pass");
    let what = name.as_ref().map_or_else(|| "this pass".to_owned(), |name| format!("pass `{}`", name.text));
    let work = work::lower(reader, scope, fields, &what);
    let when = optional(fields.when, |leaf| condition::lower(reader, scope, leaf));
    let sample = optional(fields.sample, |leaf| bindings::samples(reader, scope, leaf));
    let storage = optional(fields.storage, |leaf| bindings::storage(reader, scope, leaf));
    let uniform = optional(fields.uniform, |leaf| bindings::uniforms(reader, scope, leaf));
    let vertex = optional(fields.vertex, |leaf| parts::buffer(reader, scope, leaf));
    let index = optional(fields.index, |leaf| parts::buffer(reader, scope, leaf));
    let color = optional(fields.color, |leaf| targets::color(reader, scope, leaf));
    let depth = optional(fields.depth, |leaf| targets::depth(reader, scope, leaf));
    let params = optional(fields.params, |leaf| bindings::params(reader, scope, leaf));
    let side_effect = optional(fields.side_effect, |leaf| reader.truth(leaf));
    let otherwise = optional(fields.otherwise, |leaf| forward(reader, scope, leaf));

    if let (Some(color), Some(depth)) = (&color, &depth) {
        targets_make_sense(reader, fields, &what, color.as_deref().unwrap_or(&[]), depth.as_ref());
    }
    let pass = Pass {
        name: name?,
        when: when?,
        work: work?,
        sample: sample?.unwrap_or_default(),
        storage: storage?.unwrap_or_default(),
        uniform: uniform?.unwrap_or_default(),
        vertex: vertex?,
        index: index?,
        color: color?.unwrap_or_default(),
        depth: depth?,
        params: params?.unwrap_or_default(),
        side_effect: side_effect?.unwrap_or_default(),
        otherwise: otherwise?,
    };
    bindings_differ(reader, &pass);
    if let (Some(otherwise), Some(leaf)) = (pass.otherwise, fields.otherwise) {
        forward_makes_sense(reader, fields, leaf, &otherwise, &pass);
    }
    Some(pass)
}

/// A field that may be absent: `None` if it is there and wrong.
fn optional<'src, T>(leaf: Option<Leaf<'src>>, lower: impl FnOnce(Leaf<'src>) -> Option<T>) -> Option<Option<T>> {
    match leaf {
        Some(leaf) => lower(leaf).map(Some),
        None => Some(None),
    }
}

/// What a target takes when the pass is off.
fn forward<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Forward> {
    let form = "Forward(from: \"image\", to: \"image\")";
    let (_, rest) = reader.word(leaf, "a stand-in", &["Forward"], &format!("write `{form}`"))?;
    let fields: ForwardFields<'_> = reader.inside(leaf, rest, form)?;
    let (from, to) = (scope.image(reader, fields.from), scope.image(reader, fields.to));
    Some(Forward { from: from?, to: to? })
}

/// A draw has targets, and none of them twice.
fn targets_make_sense(
    reader: &mut Reader,
    fields: &PassFields<'_>,
    what: &str,
    color: &[Color],
    depth: Option<&Depth>,
) {
    if fields.draw.is_some() && color.is_empty() && depth.is_none() {
        let nothing = Diagnostic::new(fields.name.span(), format!("{what} draws into nothing"));
        reader.report(nothing.help("give it `color: [\"image\"]` or `depth: \"image\"`"));
    }
    let mut first = HashMap::new();
    for target in color.iter().map(|c| c.part).chain(depth.map(|d| d.part)) {
        let numbers = [target.mips, target.layers].map(|selection| {
            let number = |number: Option<super::Spanned<u32>>| number.map(|number| number.value);
            (number(selection.first), number(selection.count))
        });
        if let Some(first) = first.insert((target.image.index, numbers), target.image.span) {
            let twice = Diagnostic::new(target.image.span, format!("{what} draws into this image twice"));
            reader.report(twice.remark("again here").label(first, "first here"));
        }
    }
}

/// A name of the shader stands in one map only.
fn bindings_differ(reader: &mut Reader, pass: &Pass) {
    let sampled = pass.sample.iter().map(|sample| &sample.binding);
    let storage = pass.storage.iter().map(|storage| &storage.binding);
    let names = sampled.chain(storage).chain(pass.uniform.iter().map(|uniform| &uniform.binding));
    let mut first = HashMap::new();
    for name in names {
        if let Some(first) = first.insert(name.text.clone(), name.span) {
            let message = format!("pass `{}` gives `{}` in two ways", pass.name.text, name.text);
            reader.report(Diagnostic::new(name.span, message).remark("again here").label(first, "first here"));
        }
    }
}

/// Images that a pass may write.
fn written(pass: &Pass) -> impl Iterator<Item = ImageRef> {
    let targets = pass.color.iter().map(|color| color.part).chain(pass.depth.as_ref().map(|depth| depth.part));
    let storage = pass.storage.iter().map(|storage| storage.part);
    let transferred = match &pass.work {
        Work::Copy { to, .. } | Work::Blit { to, .. } | Work::Fill { to, .. } => std::slice::from_ref(to),
        Work::Custom { writes, .. } => writes,
        Work::Draw { .. } | Work::Dispatch { .. } => &[],
    };
    let parts = storage.chain(transferred.iter().copied()).filter_map(|part| match part {
        Part::Image(part) => Some(part),
        Part::Buffer(_) => None,
    });
    targets.chain(parts).map(|part| part.image)
}

/// A stand-in fills one of the pass's own images, from another image.
fn forward_makes_sense(reader: &mut Reader, fields: &PassFields<'_>, leaf: Leaf<'_>, forward: &Forward, pass: &Pass) {
    if fields.when.is_none() {
        let idle = Diagnostic::new(leaf.span(), "`otherwise` never comes to pass: there is no `when`");
        reader.report(idle.help("add `when`, or remove `otherwise`"));
    }
    if forward.from.index == forward.to.index {
        let same = Diagnostic::new(forward.to.span, "an image can't be forwarded to itself");
        reader.report(same.label(forward.from.span, "the same image"));
        return;
    }
    if !written(pass).any(|image| image.index == forward.to.index) {
        let foreign = Diagnostic::new(forward.to.span, "`otherwise` fills an image that this pass doesn't write");
        reader.report(foreign.help("`to` is one of the images that the pass draws into or writes"));
    }
}
