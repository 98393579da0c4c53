//! A pass: its work, bindings and targets, and the stand-ins for its targets when it is off.

use super::condition::Condition;
use super::declared_uses::QUEUES;
use super::firsts::Firsts;
use super::pass_fields::PassFields;
use super::stand_ins::{OtherwiseOwner, stand_ins_make_sense};
use super::values::{self, optional};
use crate::base::{Code, Diagnostic, Span};
use crate::frame::ViewIndex;
use crate::language::model::{Color, Depth, Pass, PassDecisions};
use crate::language::scope::{Context, FieldValue, FieldValueTuple, ReadableValue, reported};
use crate::ron::{Name, Reader};
use std::fmt::{Display, Formatter};
use std::sync::Arc;

impl Context<'_> {
    /// A pass. An expression that has no value is no mistake if the pass is off.
    pub(crate) fn pass(&mut self, fields: &PassFields<'_>) -> FieldValue<Arc<Pass>> {
        let name = self.reader.name(fields.name, "a pass");
        let condition = self.condition(fields.when);
        let otherwise = self.otherwise(fields.otherwise, fields.when);
        let is_always_on = matches!((&condition, &otherwise), (Some(FieldValue::Constant(_)), Some(None)));
        let parts = match self.pass_parts(fields, name.clone()) {
            Some(FieldValue::Constant(pass)) if is_always_on => {
                bindings_differ(self.reader, &pass);
                return FieldValue::Constant(pass);
            }
            parts => parts,
        };
        FieldValue::computed(move |evaluator| {
            let condition = evaluator.put_in(&condition);
            let is_off = condition.as_ref().is_some_and(|condition| condition.off.is_some());
            // Stand-ins of a pass that runs need no values.
            evaluator.forgave = false;
            let stand_ins = evaluator.leniently(!is_off, |evaluator| match otherwise.as_ref()? {
                Some(otherwise) => otherwise.stand_ins.evaluate(evaluator),
                None => Some(Vec::new()),
            });
            let stand_ins = stand_ins.or_else(|| evaluator.forgave.then(Vec::new));
            evaluator.forgave = false;
            let before = evaluator.reader.errors.len();
            let pass = evaluator.leniently(is_off, |evaluator| evaluator.put_in(&parts));
            let idle = pass.is_none() && is_off && evaluator.forgave && evaluator.reader.errors.len() == before;
            let (name, Condition { off, by }, stand_ins) = (name.clone()?, condition?, stand_ins?);
            let images = std::mem::take(&mut evaluator.chosen);
            let decided = PassDecisions { runs: by, images, ..PassDecisions::default() };
            if idle {
                return Some(Arc::new(Pass { off, decided, otherwise: stand_ins, ..Pass::idle(name) }));
            }
            let mut pass = pass?;
            let parts = Arc::make_mut(&mut pass);
            (parts.off, parts.decided, parts.otherwise) = (off, decided, stand_ins);
            bindings_differ(evaluator.reader, &pass);
            if let Some(Some(otherwise)) = &otherwise {
                stand_ins_make_sense(evaluator.reader, otherwise, OtherwiseOwner::Pass, &pass);
            }
            Some(pass)
        })
    }

    /// The work, bindings and targets of a pass. Each field is evaluated, even where another couldn't be read.
    fn pass_parts(&mut self, fields: &PassFields<'_>, name: Option<Name>) -> Option<FieldValue<Arc<Pass>>> {
        let work = self.work(fields, PassWords(name.as_ref()));
        let sample = optional(fields.sample, |leaf| self.sampled(leaf));
        let storage = optional(fields.storage, |leaf| self.storage(leaf));
        let uniform = optional(fields.uniform, |leaf| self.uniforms(leaf));
        let vertex = optional(fields.vertex, |leaf| self.buffer_part(leaf));
        let index = optional(fields.index, |leaf| self.buffer_part(leaf));
        let color = optional(fields.color, |leaf| self.color_targets(leaf));
        let depth = optional(fields.depth, |leaf| self.depth_target(leaf));
        let raster = optional(fields.raster, |leaf| self.raster(leaf));
        let alpha_to_coverage = optional(fields.alpha_to_coverage, |leaf| self.truth(leaf));
        let covers = optional(fields.covers, |leaf| self.truth(leaf).map(FieldValue::alone));
        let uses = optional(fields.uses, |leaf| self.declared_uses(leaf));
        let run = optional(fields.run, |leaf| self.cadence(leaf));
        let both_eyes = optional(fields.both_eyes, |leaf| self.truth(leaf).map(FieldValue::alone));
        let queue = values::optional_choice(self.reader, fields.queue, "a queue", &QUEUES);
        let params = optional(fields.params, |leaf| self.params(leaf));
        let constants = optional(fields.constants, |leaf| self.constants(leaf));
        let side_effect = optional(fields.side_effect, |leaf| self.truth(leaf).map(FieldValue::alone));
        let (draws, span) = (fields.draw.is_some(), fields.name.span());
        let bindings = (
            ReadableValue(sample),
            ReadableValue(storage),
            ReadableValue(uniform),
            (ReadableValue(params), ReadableValue(constants)),
        );
        let targets = (
            ReadableValue(color),
            ReadableValue(depth),
            ReadableValue(raster),
            ReadableValue(alpha_to_coverage),
            ReadableValue(covers),
        );
        let others = (ReadableValue(side_effect), ReadableValue(uses), ReadableValue(run), ReadableValue(both_eyes));
        let parts = (ReadableValue(work), bindings, (ReadableValue(vertex), ReadableValue(index)), targets, others);
        reported(self.reader, parts, move |reader, (work, bindings, (vertex, index), targets, others)| {
            let (sample, storage, uniform, (params, constants)) = bindings;
            let (side_effect, uses, run, both_eyes) = others;
            let (color, depth, raster, alpha_to_coverage, covers) = targets;
            if let (Some(color), Some(depth)) = (&color, &depth) {
                let (draws, color) = (draws.then_some(span), color.as_deref().unwrap_or(&[]));
                targets_make_sense(reader, draws, PassWords(name.as_ref()), color, depth.as_ref());
            }
            let any_queue = queue?.is_some_and(|queue| queue.value);
            let (sample, left_out) = sample?.unwrap_or_default();
            Some(Arc::new(Pass {
                name: name.clone()?,
                off: None,
                decided: PassDecisions::default(),
                work: work?,
                sample,
                left_out,
                storage: storage?.unwrap_or_default(),
                uniform: uniform?.unwrap_or_default(),
                vertex: vertex?,
                index: index?,
                color: color?.unwrap_or_default(),
                depth: depth?,
                raster: raster?,
                alpha_to_coverage: alpha_to_coverage?.filter(|covers| covers.value).map(|covers| covers.span),
                covers: covers?.unwrap_or_default(),
                uses: uses?.unwrap_or_default(),
                any_queue,
                both_eyes: both_eyes?.unwrap_or_default(),
                params: params?.unwrap_or_default(),
                constants: constants?.unwrap_or_default(),
                side_effect: side_effect?.unwrap_or_default(),
                otherwise: Vec::new(),
                view: ViewIndex::default(),
                run: run?,
                instance: None,
            }))
        })
    }
}

/// A pass in messages: "pass `sky`".
#[derive(Clone, Copy)]
struct PassWords<'n>(Option<&'n Name>);

impl Display for PassWords<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            Some(name) => write!(f, "pass `{}`", name.text),
            None => f.write_str("this pass"),
        }
    }
}

/// A draw has targets, and none of them twice.
fn targets_make_sense(
    reader: &mut Reader,
    draws: Option<Span>,
    what: PassWords<'_>,
    color: &[Color],
    depth: Option<&Depth>,
) {
    if let Some(draws) = draws
        && color.is_empty()
        && depth.is_none()
    {
        let nothing = Diagnostic::new(Code::PASS_DOES_NOTHING, draws, format!("{what} draws into nothing"));
        reader.report(nothing.help("give it `color: [\"image\"]` or `depth: \"image\"`"));
    }
    let mut first = Firsts::default();
    for target in color.iter().map(|c| c.part).chain(depth.map(|d| d.part)) {
        let numbers = [target.mips, target.layers].map(|selection| {
            let number = |number: Option<crate::ron::Spanned<u32>>| number.map(|number| number.value);
            (number(selection.first), number(selection.count))
        });
        if let Some(first) = first.insert((target.image.index, numbers), target.image.span) {
            let twice =
                Diagnostic::new(Code::TARGET_TWICE, target.image.span, format!("{what} draws into this image twice"));
            reader.report(twice.remark("again here").label(first, "first here"));
        }
    }
}

/// A name of the shader stands in one map only.
fn bindings_differ(reader: &mut Reader, pass: &Pass) {
    let sampled = pass.sample.iter().map(|sample| &sample.binding);
    let storage = pass.storage.iter().map(|storage| &storage.binding);
    let names = sampled.chain(storage).chain(pass.uniform.iter().map(|uniform| &uniform.binding));
    let mut first = Firsts::default();
    for name in names {
        if let Some(first) = first.insert(&*name.text, name.span) {
            let message = format!("pass `{}` gives `{}` in two ways", pass.name.text, name.text);
            reader.report(
                Diagnostic::new(Code::BINDING_TWICE, name.span, message)
                    .remark("again here")
                    .label(first, "first here"),
            );
        }
    }
}
