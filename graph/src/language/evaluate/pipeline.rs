//! A whole pipeline is evaluated: views, then all entries, then its policies and outputs.

use super::evaluation::{Evaluation, Level, Purpose};
use super::memory::Memory;
use super::{circles, previous};
use crate::frame::ViewIndex;
use crate::language::entries::pipeline::Entries;
use crate::language::entries::views::Views;
use crate::language::inputs::Surroundings;
use crate::language::model::Pipeline;
use crate::language::scope::DecidedValue;
use crate::ron::Reader;
use std::collections::HashSet;

/// Evaluates a pipeline for values of its settings. `None` if errors were reported, and for a check. `memory` is of earlier evaluations
/// of these same entries.
pub(crate) fn evaluate<'a>(
    reader: &mut Reader,
    entries: &'a Entries,
    values: Vec<Option<DecidedValue>>,
    surroundings: &'a Surroundings<'a>,
    purpose: Purpose,
    memory: Option<&'a mut Memory>,
) -> Option<Pipeline> {
    let mut all = Evaluation::new(purpose, surroundings, &entries.fragments);
    all.memory = memory;
    let mut level = Level::top(&entries.body, values);
    let mut evaluator = all.evaluator(reader, &level, ViewIndex::default(), None);
    let views = Views::new(&entries.views, surroundings, &mut evaluator);
    all.views = views;
    all.level(reader, &mut level);
    circles::find(&all.flat.images, &all.flat.buffers, &mut reader.errors);
    previous::check(&all.flat.images, &all.flat.buffers, &all.flat.passes, &mut reader.errors);
    let mut evaluator = all.evaluator(reader, &level, ViewIndex::default(), None);
    let depth = evaluator.put_in(&entries.depth);
    let color = evaluator.put_in(&entries.color);
    let depth_format = evaluator.put_in(&entries.depth_format);
    let outputs = entries.outputs.as_ref().and_then(|outputs| evaluator.outputs(outputs));
    let flat = std::mem::take(&mut all.flat);
    all.memory.iter_mut().for_each(|memory| memory.end());
    if purpose == Purpose::Check {
        all.unused(reader);
    }
    let mut seen = HashSet::new();
    reader.errors.retain(|error| error.labels.first().is_none_or(|at| seen.insert((at.span, error.message.clone()))));
    if purpose != Purpose::Pipeline {
        return None;
    }
    Some(Pipeline {
        views: all.views.into_list()?,
        images: flat.images.into_iter().collect::<Option<_>>()?,
        buffers: flat.buffers.into_iter().collect::<Option<_>>()?,
        passes: flat.passes.into_iter().collect::<Option<_>>()?,
        depth: depth?.flatten(),
        color: color?,
        depth_format: depth_format?,
        outputs: outputs?,
        instances: flat.instances,
        removed: Vec::new(),
    })
}
