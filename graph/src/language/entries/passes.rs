//! A pass: its work, bindings and targets, and what fills its targets when it is off.

use super::pass_fields::PassFields;
use super::stand_ins::{Of, Otherwise, stand_ins_make_sense};
use super::values::optional;
use crate::base::{Diagnostic, Span};
use crate::language::model::{BufferPart, Color, Depth, LeftOut, Off, Param, Pass, Sample, Storage, Uniform, Work};
use crate::language::scope::{Context, Evaluator, Given, Parts};
use crate::ron::{Leaf, Name, Reader};
use std::collections::HashMap;

/// A pass that a file says; `None` where a field couldn't be read.
pub(crate) struct PassEntry {
    name: Option<Name>,
    name_at: Span,
    /// Whether it has the field `draw`.
    draws: bool,
    off: Option<Given<Option<Off>>>,
    otherwise: Option<Option<Otherwise>>,
    work: Option<Given<Work>>,
    sample: Option<Given<(Vec<Sample>, Vec<LeftOut>)>>,
    storage: Option<Vec<Given<Storage>>>,
    uniform: Option<Vec<Given<Uniform>>>,
    vertex: Option<Option<Given<BufferPart>>>,
    index: Option<Option<Given<BufferPart>>>,
    color: Option<Vec<Given<Color>>>,
    depth: Option<Option<Given<Depth>>>,
    alpha_to_coverage: Option<Given<Option<Span>>>,
    params: Option<Vec<Given<Param>>>,
    side_effect: Option<Given<bool>>,
}

impl Context<'_> {
    /// A pass.
    pub(crate) fn pass(&mut self, fields: &PassFields<'_>) -> PassEntry {
        let name = self.reader.name(fields.name, "a pass");
        let off = self.off(fields.when);
        let otherwise = self.otherwise(fields.otherwise, fields.when);
        let work = self.work(fields, &called(name.as_ref()));
        let none = || Some(Given::Known((Vec::new(), Vec::new())));
        let no = || Some(Given::Known(false));
        PassEntry {
            name_at: fields.name.span(),
            draws: fields.draw.is_some(),
            sample: fields.sample.map_or_else(none, |leaf| self.sampled(leaf)),
            storage: listed(fields.storage, |leaf| self.storage(leaf)),
            uniform: listed(fields.uniform, |leaf| self.uniforms(leaf)),
            vertex: optional(fields.vertex, |leaf| self.buffer_part(leaf)),
            index: optional(fields.index, |leaf| self.buffer_part(leaf)),
            color: listed(fields.color, |leaf| self.color_targets(leaf)),
            depth: optional(fields.depth, |leaf| self.depth_target(leaf)),
            alpha_to_coverage: fields.alpha_to_coverage.map_or(Some(Given::Known(None)), |leaf| {
                let span = leaf.span();
                Some(self.truth(leaf)?.map(move |covers| covers.then_some(span)))
            }),
            params: listed(fields.params, |leaf| self.params(leaf)),
            side_effect: fields.side_effect.map_or_else(no, |leaf| self.truth(leaf)),
            name,
            off,
            otherwise,
            work,
        }
    }
}

/// The values of a field that may be absent: there are none then.
fn listed<'src, T>(leaf: Option<Leaf<'src>>, read: impl FnOnce(Leaf<'src>) -> Option<Vec<T>>) -> Option<Vec<T>> {
    leaf.map_or_else(|| Some(Vec::new()), read)
}

/// What a pass is called in messages.
fn called(name: Option<&Name>) -> String {
    name.map_or_else(|| "this pass".to_owned(), |name| format!("pass `{}`", name.text))
}

impl Evaluator<'_, '_> {
    /// A pass. An expression that has no value is no mistake if the pass is off.
    pub(crate) fn pass(&mut self, entry: &PassEntry) -> Option<Pass> {
        let off = self.put_in(&entry.off);
        let is_off = matches!(off, Some(Some(_)));
        // What never comes to pass needs no values.
        self.forgave = false;
        let stand_ins = entry.otherwise.as_ref().map(|otherwise| otherwise.as_ref().map(|it| &it.stand_ins));
        let otherwise = self.leniently(!is_off, |evaluator| match stand_ins? {
            Some(stand_ins) => stand_ins.evaluate(evaluator),
            None => Some(Vec::new()),
        });
        let otherwise = otherwise.or_else(|| self.forgave.then(Vec::new));
        self.forgave = false;
        let before = self.reader.errors.len();
        let pass = self.leniently(is_off, |evaluator| evaluator.pass_parts(entry));
        let idle = pass.is_none() && is_off && self.forgave && self.reader.errors.len() == before;
        let (name, off, otherwise) = (entry.name.clone()?, off?, otherwise?);
        if idle {
            return Some(Pass { off, otherwise, ..Pass::idle(name) });
        }
        let pass = Pass { off, otherwise, ..pass? };
        bindings_differ(self.reader, &pass);
        if let Some(Some(otherwise)) = &entry.otherwise {
            stand_ins_make_sense(self.reader, otherwise, Of::Pass, &pass);
        }
        Some(pass)
    }

    /// What the pass does, with what.
    fn pass_parts(&mut self, entry: &PassEntry) -> Option<Pass> {
        let work = self.put_in(&entry.work);
        let sample = self.put_in(&entry.sample);
        let storage = self.put_in(&entry.storage);
        let uniform = self.put_in(&entry.uniform);
        let vertex = self.put_in(&entry.vertex);
        let index = self.put_in(&entry.index);
        let color = self.put_in(&entry.color);
        let depth = self.put_in(&entry.depth);
        let alpha_to_coverage = self.put_in(&entry.alpha_to_coverage);
        let params = self.put_in(&entry.params);
        let side_effect = self.put_in(&entry.side_effect);
        if let (Some(color), Some(depth)) = (&color, &depth) {
            targets_make_sense(self.reader, entry, color, depth.as_ref());
        }
        let (sample, left_out) = sample?;
        Some(Pass {
            work: work?,
            sample,
            left_out,
            storage: storage?,
            uniform: uniform?,
            vertex: vertex?,
            index: index?,
            color: color?,
            depth: depth?,
            alpha_to_coverage: alpha_to_coverage?,
            params: params?,
            side_effect: side_effect?,
            ..Pass::idle(entry.name.clone()?)
        })
    }
}

/// A draw has targets, and none of them twice.
fn targets_make_sense(reader: &mut Reader, entry: &PassEntry, color: &[Color], depth: Option<&Depth>) {
    if entry.draws && color.is_empty() && depth.is_none() {
        let nothing = format!("{} draws into nothing", called(entry.name.as_ref()));
        let nothing = Diagnostic::new(entry.name_at, nothing);
        reader.report(nothing.help("give it `color: [\"image\"]` or `depth: \"image\"`"));
    }
    let mut first = HashMap::new();
    for target in color.iter().map(|c| c.part).chain(depth.map(|d| d.part)) {
        let numbers = [target.mips, target.layers].map(|selection| {
            let number = |number: Option<crate::ron::Spanned<u32>>| number.map(|number| number.value);
            (number(selection.first), number(selection.count))
        });
        if let Some(first) = first.insert((target.image.index, numbers), target.image.span) {
            let twice = format!("{} draws into this image twice", called(entry.name.as_ref()));
            let twice = Diagnostic::new(target.image.span, twice);
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
