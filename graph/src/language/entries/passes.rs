//! A pass: its work, bindings and targets, and what fills its targets when it is off.

use super::pass_fields::PassFields;
use super::stand_ins::{Of, stand_ins_make_sense};
use super::values::optional;
use crate::base::Diagnostic;
use crate::language::model::{Color, Depth, Pass};
use crate::language::scope::Context;
use crate::ron::{Name, Reader};
use std::collections::HashMap;

impl Context<'_, '_> {
    /// A pass. An expression that has no value is no mistake if the pass is off.
    pub(crate) fn pass(&mut self, fields: &PassFields<'_>) -> Option<Pass> {
        let name = self.reader.name(fields.name, "a pass");
        let off = self.off(fields.when);
        let is_off = matches!(off, Some(Some(_)));
        // What never comes to pass needs no values.
        self.forgave = false;
        let otherwise = self.leniently(!is_off, |context| optional(fields.otherwise, |leaf| context.stand_ins(leaf)));
        let otherwise = match otherwise {
            None if self.forgave => Some(Vec::new()),
            otherwise => otherwise.map(Option::unwrap_or_default),
        };
        self.forgave = false;
        let before = self.reader.errors.len();
        let pass = self.leniently(is_off, |context| context.pass_parts(fields, name.as_ref()));
        let idle = pass.is_none() && is_off && self.forgave && self.reader.errors.len() == before;
        let (name, off, otherwise) = (name?, off?, otherwise?);
        if idle {
            return Some(Pass { off, otherwise, ..Pass::idle(name) });
        }
        let pass = Pass { off, otherwise, ..pass? };
        bindings_differ(self.reader, &pass);
        if let Some(leaf) = fields.otherwise {
            stand_ins_make_sense(self.reader, fields.when.is_some(), leaf, Of::Pass, &pass);
        }
        Some(pass)
    }

    /// What the pass does, with what.
    fn pass_parts(&mut self, fields: &PassFields<'_>, name: Option<&Name>) -> Option<Pass> {
        let what = name.map_or_else(|| "this pass".to_owned(), |name| format!("pass `{}`", name.text));
        let work = self.work(fields, &what);
        let sample = optional(fields.sample, |leaf| self.sampled(leaf)).map(Option::unwrap_or_default);
        let storage = optional(fields.storage, |leaf| self.storage(leaf));
        let uniform = optional(fields.uniform, |leaf| self.uniforms(leaf));
        let vertex = optional(fields.vertex, |leaf| self.buffer_part(leaf));
        let index = optional(fields.index, |leaf| self.buffer_part(leaf));
        let color = optional(fields.color, |leaf| self.color_targets(leaf));
        let depth = optional(fields.depth, |leaf| self.depth_target(leaf));
        let alpha_to_coverage =
            optional(fields.alpha_to_coverage, |leaf| self.truth(leaf).map(|covers| covers.then(|| leaf.span())));
        let params = optional(fields.params, |leaf| self.params(leaf));
        let side_effect = optional(fields.side_effect, |leaf| self.truth(leaf));
        if let (Some(color), Some(depth)) = (&color, &depth) {
            targets_make_sense(self.reader, fields, &what, color.as_deref().unwrap_or(&[]), depth.as_ref());
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
