//! A whole Plan.

use super::barriers::StepBarriers;
use super::ownership::Transfer;
use super::resources::Resources;
use super::stage_results::StageResults;
use super::values::{changes, settings, views, with_bytes};
use super::{attachments, notes, outputs, ownership, passes};
use crate::compile::scope::Step as Grouped;
use crate::compile::sync::Barriers;
use crate::plan::{DeviceUsed, FORMAT_VERSION, Plan, Step, Totals, Work};
use std::sync::Arc;

/// The Plan, with the images and buffers that `resources` made.
pub(in crate::compile) fn emit(results: &StageResults<'_>, (images, buffers): Resources) -> Plan {
    let steps = steps(results);
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
        totals: with_bytes(results, Totals::count(&steps)),
        steps,
        notes: notes::notes(results),
    }
}

fn steps(results: &StageResults<'_>) -> Vec<Step> {
    let Barriers { queues, steps: count, .. } = results.sync;
    let mut barriers = StepBarriers::new(results);
    let step = |number| {
        let (memory_barriers, image_barriers) = barriers.of(number);
        let work = match results.scoped.steps.get(number as usize) {
            Some(Grouped::Scope(scope)) => Work::Render(Box::new(attachments::scope(results, scope, number))),
            Some(Grouped::Single(op)) => passes::single(results, *op),
            Some(Grouped::BarriersOnly) | None => Work::Export,
        };
        let (queue, waits, releases) = (queues.queue(number), queues.waits(number), Vec::new());
        Step { queue, waits, memory_barriers, image_barriers, work, releases }
    };
    let mut steps: Vec<Step> = (0..*count).map(step).collect();
    for Transfer { from, release, to, acquire } in ownership::transfers(results) {
        steps[from as usize].releases.push(release);
        steps[to as usize].image_barriers.push(acquire);
    }
    steps
}
