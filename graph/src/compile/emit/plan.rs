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

/// The Plan, with the images and buffers that `resources` made.
pub(in crate::compile) fn emit(parts: &StageResults<'_>, (images, buffers): Resources) -> Plan {
    let steps = steps(parts);
    Plan {
        format_version: FORMAT_VERSION,
        device: DeviceUsed { name: parts.device.name.clone(), exact_memory: parts.exact_memory },
        settings: settings(parts),
        changes: changes(parts),
        stereo: parts.frame.stereo,
        views: views(parts),
        images,
        buffers,
        outputs: outputs::outputs(parts),
        heaps: parts.placed.heaps.clone(),
        totals: with_bytes(parts, Totals::count(&steps)),
        steps,
        notes: notes::notes(parts),
    }
}

fn steps(parts: &StageResults<'_>) -> Vec<Step> {
    let Barriers { queues, steps: count, .. } = parts.sync;
    let mut barriers = StepBarriers::new(parts);
    let step = |number| {
        let (memory_barriers, image_barriers) = barriers.of(number);
        let work = match parts.scoped.steps.get(number as usize) {
            Some(Grouped::Scope(scope)) => Work::Render(Box::new(attachments::scope(parts, scope, number))),
            Some(Grouped::Single(op)) => passes::single(parts, *op),
            Some(Grouped::BarriersOnly) | None => Work::Export,
        };
        let (queue, waits, releases) = (queues.queue(number), queues.waits(number), Vec::new());
        Step { queue, waits, memory_barriers, image_barriers, work, releases }
    };
    let mut steps: Vec<Step> = (0..*count).map(step).collect();
    for Transfer { from, release, to, acquire } in ownership::transfers(parts) {
        steps[from as usize].releases.push(release);
        steps[to as usize].image_barriers.push(acquire);
    }
    steps
}
