//! `passes`: what each does, when, and what stands in for it when it is off.

use super::condition::{optional, when};
use super::pass_fields::PassFields;
use super::stand_ins::{Of, stand_ins, stand_ins_make_sense};
use super::{bindings, parts, targets, values, work};
use crate::base::Diagnostic;
use crate::language::model::{Color, Depth, Pass};
use crate::language::scope::Scope;
use crate::ron::{Name, Reader};
use std::collections::HashMap;

/// A pass, once its fields are told apart. What has no value because the pass is off is no mistake.
pub(crate) fn lower<'src>(reader: &mut Reader, scope: &Scope<'_>, fields: &PassFields<'src>) -> Option<Pass> {
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
