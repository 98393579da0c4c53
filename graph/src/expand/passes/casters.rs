//! Cascades of one view are looked up together: they are cut from it in one way, and shaders look each up in the layer of its number.
//! An image that is only copied, such as a cascade that is kept for later frames, may hold any of them in any layer.

use super::state::State;
use crate::base::{Code, Diagnostic};
use crate::expand::mistakes::used_here;
use crate::expand::resources::Resources;
use crate::frame::{Cascade, DepthTarget, ImageIndex, Metres, Share, ViewIndex};
use crate::language;
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// A pass that draws casters.
struct Casters<'f> {
    pass: &'f language::Pass,
    cascade: Cascade,
    target: &'f DepthTarget,
    /// Width, height and depth of the image that it draws into, in texels; `None` where a mistake was reported.
    map: Option<[u32; 3]>,
}

/// Reports, once for each use of a fragment and each pass outside of fragments, cascades that can't be looked up with the
/// first of their view, and those that no pass draws.
pub(in crate::expand) fn agree(resources: &Resources<'_>, states: &[State], errors: &mut Vec<Diagnostic>) {
    let pipeline = resources.pipeline;
    let mut views: BTreeMap<ViewIndex, Vec<Casters<'_>>> = BTreeMap::new();
    for (pass, state) in pipeline.passes.iter().zip(states) {
        if let State::On(lowered) = state
            && let Some(cascade) = lowered.work.draw().and_then(|(draw, _)| draw.cascade())
            && let Some(target) = &lowered.depth
        {
            let map = resources.image(target.image).map(|image| image.image.extent_at(target.range.base_mip));
            views.entry(pass.view).or_default().push(Casters { pass, cascade, target, map });
        }
    }
    if views.is_empty() {
        return;
    }
    let sampled = states.iter().flat_map(State::runs).flat_map(|pass| &pass.sampled);
    let sampled: HashSet<ImageIndex> = sampled.map(|sampled| sampled.image).collect();
    for all in views.values() {
        let first = &all[0];
        let first_sampled = all.iter().find(|casters| sampled.contains(&casters.target.image));
        let mut said = HashSet::new();
        for casters in all {
            let looked_up = first_sampled.filter(|_| sampled.contains(&casters.target.image));
            let wrong = differs(first, casters).or_else(|| misplaced(looked_up?, casters));
            let Some(wrong) = wrong else { continue };
            if casters.pass.instance.is_none_or(|instance| said.insert(instance)) {
                errors.push(wrong);
                let wrong = errors.len() - 1;
                used_here(pipeline, casters.pass.instance, &mut errors[wrong..]);
            }
        }
        let drawn: BTreeSet<u8> = all.iter().map(|casters| casters.cascade.index).collect();
        if let Some(missing) = (0..first.cascade.of).find(|index| !drawn.contains(index)) {
            let message = format!("no pass draws cascade {missing} of {}", first.cascade.of);
            let wrong = Diagnostic::new(Code::CASCADES, first.pass.name.span, message).remark(first.cascade.in_words());
            errors.push(wrong.help("all cascades of a view are drawn: `repeat` a pass as often as there are"));
            let wrong = errors.len() - 1;
            used_here(pipeline, first.pass.instance, &mut errors[wrong..]);
        }
    }
}

/// The difference that keeps a pass's cascade from being one of those of the first pass.
fn differs(first: &Casters<'_>, other: &Casters<'_>) -> Option<Diagnostic> {
    let (name, before) = (&other.pass.name, &first.pass.name);
    if cut(&first.cascade) != cut(&other.cascade) {
        let message = format!("pass `{}` draws cascades otherwise than pass `{}`", name.text, before.text);
        let wrong = Diagnostic::new(Code::CASCADES, name.span, message).remark(other.cascade.in_words());
        let wrong = if name.span == before.span { wrong } else { wrong.label(before.span, first.cascade.in_words()) };
        return Some(
            wrong.help("all cascades of a view are of one number and reach, with ends of one kind: give both the same"),
        );
    }
    let ([first_width, first_height, _], [width, height, _]) = (first.map?, other.map?);
    ([first_width, first_height] != [width, height]).then(|| {
        let message = "all cascades of a view have maps of one size";
        let wrong = Diagnostic::new(Code::CASCADES, other.target.span, message);
        let wrong = wrong.remark(format!("{width}×{height} texels"));
        wrong.label(first.target.span, format!("pass `{}` draws into {first_width}×{first_height}", before.text))
    })
}

/// What keeps shaders from finding a cascade in the image that they sample, which is that of the `first` one.
fn misplaced(first: &Casters<'_>, casters: &Casters<'_>) -> Option<Diagnostic> {
    if first.target.image != casters.target.image {
        let message = "all cascades of a view that shaders sample are layers of one image";
        let wrong = Diagnostic::new(Code::CASCADES, casters.target.span, message);
        return Some(wrong.label(first.target.span, format!("pass `{}` draws into this one", first.pass.name.text)));
    }
    let (index, layer) = (casters.cascade.index, casters.target.range.base_layer);
    (u32::from(index) != layer).then(|| {
        let wrong =
            Diagnostic::new(Code::CASCADES, casters.target.span, format!("cascade {index} belongs into layer {index}"));
        wrong.remark(format!("layer {layer}")).help("shaders look each cascade up in the layer of its number")
    })
}

/// How a view is cut.
fn cut(cascade: &Cascade) -> (u8, Option<Metres>, Share) {
    (cascade.of, cascade.reach, cascade.logarithmic)
}
