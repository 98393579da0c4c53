//! A whole Plan.

use super::barriers::StepBarriers;
use super::header::{changes, settings, views, with_bytes};
use super::ownership::Transfer;
use super::stage_results::StageResults;
use super::{attachments, notes, outputs, owners, ownership, passes, resources};
use crate::compile::scope::Step as Grouped;
use crate::compile::stages::Decisions;
use crate::compile::sync::Barriers;
use crate::device::Profile;
use crate::frame::{Cadence, Frame};
use crate::plan::{DeviceUsed, FORMAT_VERSION, Plan, Step, Totals, Work};
use std::sync::Arc;

/// The Plan of a frame.
pub(in crate::compile) fn emit(frame: &Frame, device: &Profile, decisions: &Decisions) -> Plan {
    let results = &StageResults::new(frame, decisions);
    let steps = steps(results);
    let (images, buffers) = resources::resources(results);
    let owned = owners::owned(&images, &buffers);
    let mut plan = Plan {
        format_version: FORMAT_VERSION,
        device: DeviceUsed { name: device.name.clone(), exact_memory: decisions.exact_memory },
        settings: settings(frame),
        changes: changes(frame),
        decided: Arc::clone(&frame.decided),
        extent: frame.extent,
        stereo: frame.stereo,
        views: views(frame),
        images,
        buffers,
        outputs: outputs::outputs(results),
        heaps: decisions.placed.heaps.clone(),
        totals: with_bytes(&decisions.placed, Totals::count(&steps)),
        steps,
        notes: notes::notes(results),
    };
    owners::hand_over(&mut plan, &owned);
    plan
}

/// Steps of the Plan.
fn steps(results: &StageResults<'_>) -> Vec<Step> {
    let Barriers { queues, steps: count, .. } = results.sync;
    let mut barriers = StepBarriers::new(results);
    let step = |number| {
        let (memory_barriers, image_barriers) = barriers.of(number);
        let (queue, waits, work) = (queues.queue(number), queues.waits(number), work(results, number));
        let run = cadence(results, number);
        Step { queue, run, waits, memory_barriers, image_barriers, work, releases: Vec::new(), outside: Vec::new() }
    };
    let mut steps: Vec<Step> = (0..*count).map(step).collect();
    for Transfer { from, release, to, acquire } in ownership::transfers(results) {
        steps[from as usize].releases.push(release);
        steps[to as usize].image_barriers.push(acquire);
    }
    steps
}

/// In which frames the work of a step is done.
fn cadence(results: &StageResults<'_>, number: u32) -> Cadence {
    let op = results.scoped.steps.get(number as usize).and_then(|step| step.ops().first());
    op.map_or(Cadence::Always, |op| results.adapted.cadence(*op).clone())
}

/// The work of a step. There may be one behind all others, which only has barriers.
fn work(results: &StageResults<'_>, number: u32) -> Work {
    match results.scoped.steps.get(number as usize) {
        Some(Grouped::Scope(scope)) => Work::Render(Box::new(attachments::scope(results, scope, number))),
        Some(Grouped::Single(op)) => passes::single(results, *op),
        Some(Grouped::BarriersOnly) | None => Work::Export,
    }
}
