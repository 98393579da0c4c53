//! A whole Plan.

use super::barriers::StepBarriers;
use super::ownership::Transfer;
use super::resources::Resources;
use super::stage_results::StageResults;
use super::values::{changes, settings, views, with_bytes};
use super::{attachments, notes, outputs, ownership, passes};
use crate::compile::scope::Step as Grouped;
use crate::compile::steps::in_order;
use crate::compile::sync::Barriers;
use crate::plan::{DeviceUsed, FORMAT_VERSION, Plan, Step, Totals, Work};
use std::sync::Arc;

/// The Plan, with the steps that `steps` made, and the images and buffers that `resources` made.
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

/// Steps of the Plan, and what they alone tell of its totals.
pub(in crate::compile) fn steps(results: StageResults<'_>) -> (Vec<Step>, Totals) {
    let results = &results.with_subjects();
    let Barriers { queues, steps: count, .. } = results.sync;
    let mut barriers = StepBarriers::new(results);
    let mut made = (Vec::with_capacity(*count as usize), Totals::default());
    let read = |_: &(Vec<Step>, Totals), number: u32| {
        let ops = results.scoped.steps.get(number as usize).map_or(&[][..], Grouped::ops);
        ops.iter().for_each(|op| passes::read(results, *op));
    };
    let apart = !results.scoped.is_in_frame_order();
    in_order(&mut made, *count, apart, read, |(steps, totals), number| {
        let (memory_barriers, image_barriers) = barriers.of(number);
        let work = match results.scoped.steps.get(number as usize) {
            Some(Grouped::Scope(scope)) => Work::Render(Box::new(attachments::scope(results, scope, number))),
            Some(Grouped::Single(op)) => passes::single(results, *op),
            Some(Grouped::BarriersOnly) | None => Work::Export,
        };
        let (queue, waits, releases) = (queues.queue(number), queues.waits(number), Vec::new());
        let step = Step { queue, waits, memory_barriers, image_barriers, work, releases };
        totals.add(&step);
        steps.push(step);
    });
    let transfers = ownership::transfers(results);
    if transfers.is_empty() {
        return made;
    }
    let (mut steps, _) = made;
    for Transfer { from, release, to, acquire } in transfers {
        steps[from as usize].releases.push(release);
        steps[to as usize].image_barriers.push(acquire);
    }
    let totals = Totals::count(&steps);
    (steps, totals)
}
