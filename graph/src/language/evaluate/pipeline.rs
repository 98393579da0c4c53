//! A whole pipeline is evaluated: views, then all entries, then what belongs to it alone.

use super::evaluation::{Evaluation, Level, Purpose};
use super::{circles, previous};
use crate::frame::ViewIndex;
use crate::frame::change::Change;
use crate::language::entries::body::Body;
use crate::language::entries::fragments::Fragments;
use crate::language::entries::textures::Pictures;
use crate::language::entries::views::Views;
use crate::language::inputs::Surroundings;
use crate::language::model::{Pipeline, Setting};
use crate::language::scope::DecidedValue;
use crate::ron::{Leaf, Reader};
use std::collections::HashSet;

/// The entries of a pipeline.
pub(crate) struct Declared<'s, 't> {
    pub(crate) body: &'s Body<'t>,
    pub(crate) fragments: &'s Fragments<'t>,
    /// The pictures that textures name.
    pub(crate) pictures: &'s Pictures,
    pub(crate) settings: &'s [Option<Setting>],
    pub(crate) views: Option<Leaf<'t>>,
    /// The first view that is no longer there.
    pub(crate) removed_view: Option<&'s Change>,
    pub(crate) depth: Option<Leaf<'t>>,
    pub(crate) color: Option<Leaf<'t>>,
    pub(crate) depth_format: Option<Leaf<'t>>,
    pub(crate) outputs: Leaf<'t>,
}

/// Evaluates a pipeline for values of its settings. `None` if errors were reported; what a check makes is worth nothing.
pub(crate) fn evaluate(
    reader: &mut Reader,
    declared: &Declared<'_, '_>,
    values: Vec<Option<DecidedValue>>,
    surroundings: &Surroundings<'_>,
    purpose: Purpose,
) -> Option<Pipeline> {
    let mut all = Evaluation::new(purpose, surroundings, declared.fragments, declared.pictures);
    let mut level = Level::top(declared.body, values);
    if let Some(views) = declared.views {
        let mut context = all.context(reader, &level, ViewIndex::default(), None);
        all.views = Views::read(&mut context, surroundings, declared.settings, views, declared.removed_view);
    }
    all.level(reader, &mut level);
    circles::find(&all.flat.images, &all.flat.buffers, &mut reader.errors);
    previous::check(&all.flat.images, &all.flat.buffers, &all.flat.passes, &mut reader.errors);
    let mut context = all.context(reader, &level, ViewIndex::default(), None);
    let depth = declared.depth.map(|leaf| context.depth_policy(leaf));
    let color = declared.color.map(|leaf| context.color_policy(leaf));
    let depth_format = declared.depth_format.map(|leaf| context.depth_format_policy(leaf));
    let outputs = context.outputs(declared.outputs);
    let flat = std::mem::take(&mut all.flat);
    if purpose == Purpose::Check {
        all.unused(reader);
    }
    let mut seen = HashSet::new();
    reader.errors.retain(|error| error.labels.first().is_none_or(|at| seen.insert((at.span, error.message.clone()))));
    Some(Pipeline {
        views: all.views.into_list()?,
        images: flat.images.into_iter().collect::<Option<_>>()?,
        buffers: flat.buffers.into_iter().collect::<Option<_>>()?,
        passes: flat.passes.into_iter().collect::<Option<_>>()?,
        depth: depth.map_or(Some(None), |depth| depth)?,
        color: color.map_or(Some(None), |color| color.map(Some))?,
        depth_format: depth_format.map_or(Some(None), |depth_format| depth_format.map(Some))?,
        outputs: outputs?,
        instances: flat.instances,
        removed: Vec::new(),
    })
}
