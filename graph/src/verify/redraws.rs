//! Whether depth-only passes draw again what they say: the same geometry, tested in the same way, with fewer samples.

use super::findings::Findings;
use crate::plan::names::ShownText;
use crate::plan::{Image, Pass, Plan, RenderScope, StepId};
use std::collections::HashMap;

/// Reports passes that draw depth again, and not that of another pass.
pub(super) fn check(plan: &Plan, found: &mut Findings<'_>) {
    let drawn = || {
        let steps = (0..).map(StepId).zip(&plan.steps);
        steps.filter_map(|(id, step)| Some((id, step.work.scope()?)))
    };
    let passes = || drawn().flat_map(|(id, scope)| scope.passes.iter().map(move |pass| (id, scope, pass)));
    if !passes().any(|(_, _, pass)| pass.redraws.is_some()) {
        return;
    }
    let by_name: HashMap<&str, (&RenderScope, &Pass)> =
        passes().map(|(_, scope, pass)| (&*pass.name, (scope, pass))).collect();
    for (id, scope, pass) in passes() {
        let Some(redraws) = &pass.redraws else { continue };
        let wrong = match by_name.get(&**redraws) {
            None => Some("draws again what the Plan doesn't draw"),
            Some((of, original)) => wrong(plan, (scope, pass), (of, original)),
        };
        if let Some(wrong) = wrong {
            found.structure(Some(id), None, format!("pass `{}` {wrong}", ShownText(&pass.name)));
        }
    }
}

/// The mistake in a pass that draws the depth of `original` again, if there is one.
fn wrong(
    plan: &Plan,
    (scope, pass): (&RenderScope, &Pass),
    (of, original): (&RenderScope, &Pass),
) -> Option<&'static str> {
    let same = (pass.draw, &pass.shader, pass.view, pass.discards, &pass.params, pass.raster, &pass.constants)
        == (
            original.draw,
            &original.shader,
            original.view,
            original.discards,
            &original.params,
            original.raster,
            &original.constants,
        );
    let tests = pass.depth == original.depth && pass.stencil == original.stencil && pass.stencil.is_none();
    let (Some(depth), Some(drawn)) = (scope.depth(), of.depth()) else { return Some("draws no depth again") };
    let [copy, image] = [depth, drawn].map(|attachment| plan.image(attachment.image));
    let size = |image: &Image| (image.extent, image.allocated, image.rotation);
    let same_size = size(copy) == size(image);
    let fewer = scope.samples == 1 && of.samples > 1 && copy.format == image.format && same_size;
    let alone = pass.accesses.len() == 1 && pass.buffers.is_empty() && scope.color().is_empty();
    if original.redraws.is_some() || !same {
        Some("draws something else than the pass that it draws again")
    } else if !tests {
        Some("tests depth otherwise than the pass that it draws again")
    } else if !fewer {
        Some("doesn't draw into depth of one sample that fits the depth of the pass that it draws again")
    } else if !alone {
        Some("draws again and touches more than its depth")
    } else {
        None
    }
}
