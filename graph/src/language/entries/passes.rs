//! A pass: its work, bindings and targets, and the stand-ins for its targets when it is off.

use super::pass_fields::PassFields;
use super::stand_ins::{Of, stand_ins_make_sense};
use super::values::optional;
use crate::base::{Diagnostic, Span};
use crate::language::model::{Color, Depth, Pass};
use crate::language::scope::{Context, FieldValue, FieldValueTuple};
use crate::ron::{Name, Reader};
use std::collections::HashMap;

impl Context<'_> {
    /// A pass. An expression that has no value is no mistake if the pass is off.
    pub(crate) fn pass(&mut self, fields: &PassFields<'_>) -> FieldValue<Pass> {
        let name = self.reader.name(fields.name, "a pass");
        let off = self.off(fields.when);
        let otherwise = self.otherwise(fields.otherwise, fields.when);
        let parts = self.pass_parts(fields, name.clone());
        FieldValue::computed(move |evaluator| {
            let off = evaluator.put_in(&off);
            let is_off = matches!(off, Some(Some(_)));
            // Stand-ins of a pass that runs need no values.
            evaluator.forgave = false;
            let stand_ins = evaluator.leniently(!is_off, |evaluator| match otherwise.as_ref()? {
                Some(otherwise) => otherwise.stand_ins.evaluate(evaluator),
                None => Some(Vec::new()),
            });
            let stand_ins = stand_ins.or_else(|| evaluator.forgave.then(Vec::new));
            evaluator.forgave = false;
            let before = evaluator.reader.errors.len();
            let pass = evaluator.leniently(is_off, |evaluator| parts.evaluate(evaluator));
            let idle = pass.is_none() && is_off && evaluator.forgave && evaluator.reader.errors.len() == before;
            let (name, off, stand_ins) = (name.clone()?, off?, stand_ins?);
            if idle {
                return Some(Pass { off, otherwise: stand_ins, ..Pass::idle(name) });
            }
            let pass = Pass { off, otherwise: stand_ins, ..pass? };
            bindings_differ(evaluator.reader, &pass);
            if let Some(Some(otherwise)) = &otherwise {
                stand_ins_make_sense(evaluator.reader, otherwise, Of::Pass, &pass);
            }
            Some(pass)
        })
    }

    /// The work, bindings and targets of a pass. Each field is evaluated, even where another couldn't be read.
    fn pass_parts(&mut self, fields: &PassFields<'_>, name: Option<Name>) -> FieldValue<Pass> {
        let what = name.as_ref().map_or_else(|| "this pass".to_owned(), |name| format!("pass `{}`", name.text));
        let work = self.work(fields, &what);
        let sample = optional(fields.sample, |leaf| self.sampled(leaf));
        let storage = optional(fields.storage, |leaf| self.storage(leaf));
        let uniform = optional(fields.uniform, |leaf| self.uniforms(leaf));
        let vertex = optional(fields.vertex, |leaf| self.buffer_part(leaf));
        let index = optional(fields.index, |leaf| self.buffer_part(leaf));
        let color = optional(fields.color, |leaf| self.color_targets(leaf));
        let depth = optional(fields.depth, |leaf| self.depth_target(leaf));
        let alpha_to_coverage = optional(fields.alpha_to_coverage, |leaf| self.truth(leaf));
        let params = optional(fields.params, |leaf| self.params(leaf));
        let side_effect = optional(fields.side_effect, |leaf| self.truth(leaf).map(FieldValue::alone));
        let (draws, span) = (fields.draw.is_some(), fields.name.span());
        FieldValue::computed(move |evaluator| {
            let work = evaluator.put_in(&work);
            let sample = evaluator.put_in(&sample);
            let storage = evaluator.put_in(&storage);
            let uniform = evaluator.put_in(&uniform);
            let vertex = evaluator.put_in(&vertex);
            let index = evaluator.put_in(&index);
            let color = evaluator.put_in(&color);
            let depth = evaluator.put_in(&depth);
            let alpha_to_coverage = evaluator.put_in(&alpha_to_coverage);
            let params = evaluator.put_in(&params);
            let side_effect = evaluator.put_in(&side_effect);
            if let (Some(color), Some(depth)) = (&color, &depth) {
                let draws = draws.then_some(span);
                targets_make_sense(evaluator.reader, draws, &what, color.as_deref().unwrap_or(&[]), depth.as_ref());
            }
            let (sample, left_out) = sample?.unwrap_or_default();
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
                alpha_to_coverage: alpha_to_coverage?.filter(|covers| covers.value).map(|covers| covers.span),
                params: params?.unwrap_or_default(),
                side_effect: side_effect?.unwrap_or_default(),
                ..Pass::idle(name.clone()?)
            })
        })
    }
}

/// A draw has targets, and none of them twice.
fn targets_make_sense(reader: &mut Reader, draws: Option<Span>, what: &str, color: &[Color], depth: Option<&Depth>) {
    if let Some(draws) = draws
        && color.is_empty()
        && depth.is_none()
    {
        let nothing = Diagnostic::new(draws, format!("{what} draws into nothing"));
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
