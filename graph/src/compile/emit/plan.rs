//! A whole Plan.

use super::barriers::StepBarriers;
use super::ownership::Transfer;
use super::resources::Resources;
use super::stage_results::StageResults;
use super::values::{changes, settings, views, with_bytes};
use super::{attachments, notes, outputs, ownership, passes};
use crate::compile::scope::Step as Grouped;
use crate::compile::steps::NEVER;
use crate::compile::sync::Barriers;
use crate::plan::{DeviceUsed, FORMAT_VERSION, Plan, Step, Totals, Work};
use std::sync::Arc;

/// The Plan, with the steps that `steps` and `put_in_work` made, and the images and buffers that `resources` made.
pub(in crate::compile) fn emit(
    results: &StageResults<'_>,
    (steps, totals): (Vec<Step>, Totals),
    (images, buffers): Resources,
) -> Plan {
    Plan {
        format_version: FORMAT_VERSION,
        device: DeviceUsed { name: results.device.name.clone(), exact_memory: results.exact_memory },
        settings: settings(results),
        changes: changes(results),
        decided: Arc::clone(&results.frame.decided),
        extent: results.frame.extent,
        stereo: results.frame.stereo,
        views: views(results),
        images,
        buffers,
        outputs: outputs::outputs(results),
        heaps: results.placed.heaps.clone(),
        totals: with_bytes(results, totals),
        steps,
        notes: notes::notes(results),
    }
}

/// Steps of the Plan, with all but their work.
pub(in crate::compile) fn steps(results: &StageResults<'_>) -> Vec<Step> {
    let Barriers { queues, steps: count, .. } = results.sync;
    let mut barriers = StepBarriers::new(results);
    let step = |number| {
        let (memory_barriers, image_barriers) = barriers.of(number);
        let (queue, waits) = (queues.queue(number), queues.waits(number));
        Step { queue, waits, memory_barriers, image_barriers, work: Work::Export, releases: Vec::new() }
    };
    let mut steps: Vec<Step> = (0..*count).map(step).collect();
    for Transfer { from, release, to, acquire } in ownership::transfers(results) {
        steps[from as usize].releases.push(release);
        steps[to as usize].image_barriers.push(acquire);
    }
    steps
}

/// Puts the work of each step in. Returns what the steps alone tell of the Plan's totals.
///
/// Works in the frame's order: passes, operations and uses are then read one after the other. Only the steps, which are written,
/// may lie apart.
pub(in crate::compile) fn put_in_work(results: &StageResults<'_>, steps: &mut [Step]) -> Totals {
    let scoped = &results.scoped.steps;
    // For each operation the step that it is the first one of.
    let mut begun = vec![NEVER; results.adapted.ops.len()];
    for (step, number) in scoped.iter().zip(0_u32..) {
        if let Some(op) = step.ops().first() {
            begun[*op as usize] = number;
        }
    }
    for number in begun.into_iter().filter(|number| *number != NEVER) {
        steps[number as usize].work = match &scoped[number as usize] {
            Grouped::Scope(scope) => Work::Render(Box::new(attachments::scope(results, scope, number))),
            Grouped::Single(op) => passes::single(results, *op),
            // It has no operation to be found by.
            Grouped::BarriersOnly => continue,
        };
    }
    Totals::count(steps)
}
