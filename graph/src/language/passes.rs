//! `passes`: what each does, when, and what stands in for it when it is off.

use super::known::REPEAT;
use super::pass::{Color, Depth, Forward, Off, Part, Pass, StandIn, Work};
use super::pipeline::{BufferRef, ImageRef};
use super::scope::Scope;
use super::{bindings, parts, targets, values, views, work};
use crate::base::Diagnostic;
use crate::fields;
use crate::frame::ViewIndex;
use crate::ron::{Described, Form, Leaf, Name, Plain, Reader, Shape, Takes, Word, Words};
use std::collections::HashMap;

fields! {
    /// A pass: one thing that is done.
    /// ```ron
    /// (name: "glass", when: "scene.has_transparent", draw: Objects(Transparent), shader: "lit",
    ///     color: [(image: "image", blend: Premultiplied)], depth: (image: "depth", write: false))
    /// ```
    pub(super) struct PassFields<'src> as "Pass" {
        /// Its name, unique among passes and uses.
        pub(super) name: Leaf<'src> => Form::Plain(Plain::Name),
        /// The view that it draws for; the first if left out.
        pub(super) view: Option<Leaf<'src>> => views::NAME,
        /// How often it stands there.
        pub(super) repeat: Option<Leaf<'src>> => REPEAT,
        /// It draws.
        pub(super) draw: Option<Leaf<'src>> => work::DRAW,
        /// It runs a compute shader, `NAME.comp`.
        pub(super) dispatch: Option<Leaf<'src>> => Form::Plain(Plain::Outside),
        /// It copies bits as they are: texels to texels, bytes to bytes, or rows of texels without gaps to or from a buffer.
        pub(super) copy: Option<Leaf<'src>> => work::COPY,
        /// It copies an image and scales it.
        pub(super) blit: Option<Leaf<'src>> => work::BLIT,
        /// It sets an image or buffer to a value.
        pub(super) fill: Option<Leaf<'src>> => work::FILL,
        /// It does what the embedding program records under this name: with `color` or `depth` within a rendering scope,
        /// else outside.
        pub(super) custom: Option<Leaf<'src>> => Form::Plain(Plain::Outside),
        /// The shader of what it draws.
        pub(super) shader: Option<Leaf<'src>> => Form::Plain(Plain::Outside),
        /// How many workgroups its compute shader runs in.
        pub(super) groups: Option<Leaf<'src>> => work::WORKGROUPS,
        /// Images that its shaders sample, by the shader's names.
        pub(super) sample: Option<Leaf<'src>> => bindings::SAMPLE,
        /// Images and buffers that its shaders read and write by themselves, by the shader's names.
        pub(super) storage: Option<Leaf<'src>> => bindings::STORAGE,
        /// Buffers that its shaders read as uniform blocks, by the shader's names.
        pub(super) uniform: Option<Leaf<'src>> => bindings::UNIFORM,
        /// The buffer of the vertices of `Vertices` and `Indirect`.
        pub(super) vertex: Option<Leaf<'src>> => parts::BUFFER,
        /// The buffer of their indices, 32 bits each.
        pub(super) index: Option<Leaf<'src>> => parts::BUFFER,
        /// What it draws colour into, by location.
        pub(super) color: Option<Leaf<'src>> => targets::COLOR,
        /// What it draws depth and stencil into.
        pub(super) depth: Option<Leaf<'src>> => targets::DEPTH,
        /// `true`: as many samples of a texel are covered as the alpha says that the shader writes at location 0, where its
        /// targets have several; not if left out.
        pub(super) alpha_to_coverage: Option<Leaf<'src>> => Form::Truth,
        /// What it reads by transfer.
        pub(super) reads: Option<Leaf<'src>> => work::TRANSFERRED,
        /// What it writes by transfer, all of it.
        pub(super) writes: Option<Leaf<'src>> => work::TRANSFERRED,
        /// Values for the members of the shader's block `params`, by name.
        pub(super) params: Option<Leaf<'src>> => bindings::PARAMS,
        /// `true`: it is kept although nothing in the frame needs it.
        pub(super) side_effect: Option<Leaf<'src>> => Form::Truth,
        /// A condition: if it is false, the pass is off, and nothing that it says needs a value.
        when: Option<Leaf<'src>> => CONDITION,
        /// What images that it would write take when it is off.
        otherwise: Option<Leaf<'src>> => OTHERWISE,
    }
}

/// What `when` takes.
pub(super) const CONDITION: Form = Form::Expression("a condition");

/// What `otherwise` takes.
pub(super) const OTHERWISE: Form = Form::Either(&[Form::Words(&STAND_INS), Form::List(&Form::Words(&STAND_INS))]);

/// What targets take when a pass is off.
static STAND_INS: Words = Words {
    name: "StandIn",
    what: "a stand-in",
    or: &[],
    all: &[
        Word::new(
            "Forward",
            &[Takes::Fields(ForwardFields::<'static>::table)],
            &["Forward(from: \"image\", to: \"image\")"],
            "One image gets what another holds.",
        ),
        Word::new(
            "Clear",
            &[Takes::Fields(ClearFields::<'static>::table)],
            &["Clear(image: \"image\", value: 0)"],
            "An image gets a value.",
        ),
    ],
};

fields! {
    /// An image that stands for another.
    struct ForwardFields<'src> {
        /// The image that is taken.
        from: Leaf<'src> => parts::WHOLE_IMAGE,
        /// The image that gets it, which the pass would write.
        to: Leaf<'src> => parts::WHOLE_IMAGE,
    }
}

fields! {
    /// A value that stands for an image.
    struct ClearFields<'src> {
        /// The image, which the pass would write.
        image: Leaf<'src> => parts::WHOLE_IMAGE,
        /// What it gets, as in [a fill](#fills).
        value: Leaf<'src> => values::FILL,
    }
}

/// A pass, once its fields are told apart. What has no value because the pass is off is no mistake.
pub(super) fn lower<'src>(reader: &mut Reader, scope: &Scope<'_>, fields: &PassFields<'src>) -> Option<Pass> {
    let name = reader.name(fields.name, "a pass");
    let off = optional(fields.when, |leaf| when(reader, scope, leaf)).map(Option::flatten);
    let is_off = matches!(off, Some(Some(_)));
    let otherwise = {
        // What never comes to pass needs no values.
        let scope = &Scope { lenient: scope.lenient || !is_off, ..*scope };
        scope.forgave.set(false);
        let otherwise = optional(fields.otherwise, |leaf| stand_ins(reader, scope, leaf));
        let otherwise = otherwise.map(Option::unwrap_or_default);
        if otherwise.is_none() && scope.forgave.get() { Some(Vec::new()) } else { otherwise }
    };
    let scope = &Scope { lenient: scope.lenient || is_off, ..*scope };
    scope.forgave.set(false);
    let before = reader.errors.len();
    let pass = parts_of(reader, scope, fields, name.as_ref());
    let idle = pass.is_none() && is_off && scope.forgave.get() && reader.errors.len() == before;
    let (name, off, otherwise) = (name?, off?, otherwise?);
    if idle {
        return Some(Pass { off, otherwise, ..Pass::idle(name) });
    }
    let pass = Pass { off, otherwise, ..pass? };
    bindings_differ(reader, &pass);
    if let Some(leaf) = fields.otherwise {
        stand_ins_make_sense(reader, fields.when.is_some(), leaf, Of::Pass, &pass);
    }
    Some(pass)
}

impl Pass {
    /// One that does nothing.
    pub(super) fn idle(name: Name) -> Pass {
        let work = Work::Custom { callback: name.clone(), reads: Vec::new(), writes: Vec::new() };
        Pass {
            name,
            off: None,
            work,
            sample: Vec::new(),
            left_out: Vec::new(),
            storage: Vec::new(),
            uniform: Vec::new(),
            vertex: None,
            index: None,
            color: Vec::new(),
            depth: None,
            alpha_to_coverage: None,
            params: Vec::new(),
            side_effect: false,
            otherwise: Vec::new(),
            view: ViewIndex::default(),
            instance: None,
        }
    }
}

/// What the pass does, with what.
fn parts_of<'src>(
    reader: &mut Reader,
    scope: &Scope<'_>,
    fields: &PassFields<'src>,
    name: Option<&Name>,
) -> Option<Pass> {
    let what = name.map_or_else(|| "this pass".to_owned(), |name| format!("pass `{}`", name.text));
    let work = work::lower(reader, scope, fields, &what);
    let sample = optional(fields.sample, |leaf| bindings::samples(reader, scope, leaf)).map(Option::unwrap_or_default);
    let storage = optional(fields.storage, |leaf| bindings::storage(reader, scope, leaf));
    let uniform = optional(fields.uniform, |leaf| bindings::uniforms(reader, scope, leaf));
    let vertex = optional(fields.vertex, |leaf| parts::buffer(reader, scope, leaf));
    let index = optional(fields.index, |leaf| parts::buffer(reader, scope, leaf));
    let color = optional(fields.color, |leaf| targets::color(reader, scope, leaf));
    let depth = optional(fields.depth, |leaf| targets::depth(reader, scope, leaf));
    let alpha_to_coverage = optional(fields.alpha_to_coverage, |leaf| {
        values::truth(reader, scope, leaf).map(|covers| covers.then(|| leaf.span()))
    });
    let params = optional(fields.params, |leaf| bindings::params(reader, scope, leaf));
    let side_effect = optional(fields.side_effect, |leaf| values::truth(reader, scope, leaf));
    if let (Some(color), Some(depth)) = (&color, &depth) {
        targets_make_sense(reader, fields, &what, color.as_deref().unwrap_or(&[]), depth.as_ref());
    }
    let (sample, left_out) = sample?;
    Some(Pass {
        work: work?,
        sample,
        left_out,
        storage: storage?.unwrap_or_default(),
        uniform: uniform?.unwrap_or_default(),
        vertex: vertex?,
        index: index?,
        color: color?.unwrap_or_default(),
        depth: depth?,
        alpha_to_coverage: alpha_to_coverage?.flatten(),
        params: params?.unwrap_or_default(),
        side_effect: side_effect?.unwrap_or_default(),
        ..Pass::idle(name?.clone())
    })
}

/// Whether a pass runs: `Some(None)`, or why it doesn't.
pub(super) fn when<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Option<Off>> {
    let Shape::Text = leaf.shape() else {
        reader.expected(leaf, "a condition in quotes");
        return None;
    };
    let outcome = scope.condition(reader, leaf)?;
    Some(outcome.map(|because| Off { span: leaf.span(), because }))
}

/// A field that may be absent: `None` if it is there and wrong.
pub(super) fn optional<'src, T>(
    leaf: Option<Leaf<'src>>,
    lower: impl FnOnce(Leaf<'src>) -> Option<T>,
) -> Option<Option<T>> {
    match leaf {
        Some(leaf) => lower(leaf).map(Some),
        None => Some(None),
    }
}

/// What targets take when the pass is off: one or several.
pub(super) fn stand_ins<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<Vec<StandIn>> {
    if let Shape::List = leaf.shape() {
        let entries = reader.list(leaf, "`otherwise`")?;
        let all: Vec<Option<StandIn>> = entries.into_iter().map(|entry| stand_in(reader, scope, entry)).collect();
        return all.into_iter().collect();
    }
    stand_in(reader, scope, leaf).map(|one| vec![one])
}

fn stand_in<'src>(reader: &mut Reader, scope: &Scope<'_>, leaf: Leaf<'src>) -> Option<StandIn> {
    let (word, rest) = reader.one_of(leaf, &STAND_INS)?;
    if word == "Clear" {
        let fields: ClearFields<'_> = reader.inside(leaf, rest, "Clear(image: \"image\", value: 0)")?;
        let (to, value) = (scope.image(reader, fields.image), values::fill(reader, scope, fields.value));
        return Some(StandIn::Clear { to: to?, value: fields.value.spanned(value?) });
    }
    let fields: ForwardFields<'_> = reader.inside(leaf, rest, "Forward(from: \"image\", to: \"image\")")?;
    let (from, to) = (scope.image(reader, fields.from), scope.image(reader, fields.to));
    Some(StandIn::Forward(Forward { from: from?, to: to? }))
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
            let number = |number: Option<crate::ron::Spanned<u32>>| number.map(|number| number.value);
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
pub(super) fn written(pass: &Pass) -> impl Iterator<Item = ImageRef> {
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

/// Buffers that a pass may write.
pub(super) fn written_buffers(pass: &Pass) -> impl Iterator<Item = BufferRef> {
    let storage = pass.storage.iter().map(|storage| storage.part);
    let transferred = match &pass.work {
        Work::Copy { to, .. } | Work::Fill { to, .. } => std::slice::from_ref(to),
        Work::Custom { writes, .. } => writes,
        Work::Blit { .. } | Work::Draw { .. } | Work::Dispatch { .. } => &[],
    };
    storage.chain(transferred.iter().copied()).filter_map(|part| match part {
        Part::Buffer(part) => Some(part.buffer),
        Part::Image(_) => None,
    })
}

/// What `otherwise` is of.
#[derive(Clone, Copy)]
pub(super) enum Of {
    Pass,
    Use,
}

impl Of {
    /// What is said of a stand-in for an image that is not written, and what to do.
    const fn foreign(self) -> (&'static str, &'static str) {
        match self {
            Of::Pass => (
                "`otherwise` fills an image that this pass doesn't write",
                "it is one of the images that the pass draws into or writes",
            ),
            Of::Use => (
                "`otherwise` fills an image that no pass of this use would write",
                "it is an image in `with` that a pass of the fragment writes; what is repeated 0 times writes nothing, on or \
                 off",
            ),
        }
    }
}

/// Stand-ins fill images of the pass's own, each once, from other images.
pub(super) fn stand_ins_make_sense(reader: &mut Reader, conditional: bool, leaf: Leaf<'_>, of: Of, pass: &Pass) {
    if !conditional {
        let idle = Diagnostic::new(leaf.span(), "`otherwise` never comes to pass: there is no `when`");
        reader.report(idle.help("add `when: …`, or remove `otherwise`"));
    }
    let mut first = HashMap::new();
    for stand_in in &pass.otherwise {
        let to = stand_in.target();
        if let StandIn::Forward(forward) = stand_in
            && forward.from.index == forward.to.index
        {
            let same = Diagnostic::new(to.span, "an image can't be forwarded to itself");
            reader.report(same.label(forward.from.span, "the same image"));
            continue;
        }
        if !written(pass).any(|image| image.index == to.index) {
            let (message, help) = of.foreign();
            reader.report(Diagnostic::new(to.span, message).help(help));
        } else if let Some(first) = first.insert(to.index, to.span) {
            let twice = Diagnostic::new(to.span, "`otherwise` fills this image twice");
            reader.report(twice.remark("again here").label(first, "first here"));
        }
    }
}
