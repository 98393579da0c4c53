//! Every pair of operations on the same bytes, of which one writes: is the earlier one location-ordered before the later?
//!
//! As the memory model has it: a read before a write needs no more than to happen before it; a write before a write must
//! be available by then; a write before a read must be available, and then visible to it.

use super::scopes::take_in;
use super::timeline::Timeline;
use super::touch::{MemoryOperation, Touch, What};
use super::uses::{Kind, ordered_within_a_step};
use super::world::World;
use super::{Harm, Missing};

/// All hazards, the same one of several frames once.
pub(super) fn find(world: &World, timeline: &Timeline) -> Vec<Harm> {
    let mut harms = Vec::new();
    let touches = &timeline.touches;
    let per_image = |physical: usize| touches.iter().filter(move |touch| touch.physical == physical);
    for later in touches.iter().filter(|touch| touch.what != What::Initial) {
        let same = per_image(later.physical);
        let others = (0..world.physical.len()).filter(|other| world.share_bytes(*other, later.physical));
        for earlier in same.chain(others.flat_map(per_image)) {
            if let Some(missing) = missing(timeline, earlier, later) {
                let harm = Harm::Hazard { missing, earlier: shown(world, earlier), later: shown(world, later) };
                if !harms.contains(&harm) {
                    harms.push(harm);
                }
            }
        }
    }
    harms
}

/// A touch as people read it.
fn shown(world: &World, touch: &Touch) -> String {
    let name = &world.physical[touch.physical].name;
    let step = touch.time % world.plan.steps.len().max(1);
    match touch.what {
        What::Access(stage, access) => format!("{access:?} in {stage:?} of `{name}` by step {step}"),
        What::Transition => format!("layout transition of `{name}` before step {step}"),
        What::Initial => format!("first contents of `{name}`"),
        What::After => format!("what comes after the frame, of `{name}`"),
    }
}

/// The dependency that is missing between two touches; `None` if there is none to miss.
fn missing(timeline: &Timeline, earlier: &Touch, later: &Touch) -> Option<Missing> {
    let conflict = (earlier.what.writes() || later.what.writes())
        && earlier.what != What::After
        && (earlier.physical != later.physical || earlier.cells.iter().any(|cell| later.cells.contains(cell)));
    if !conflict {
        return None;
    }
    if let (Some((number, one)), Some((other_number, other)), true) = (earlier.of, later.of, earlier.time == later.time)
    {
        // Each pair of a step once; parts of one use belong together.
        let apart =
            earlier.physical != later.physical || (number != other_number && !ordered_within_a_step(&one, &other));
        return (number <= other_number && apart).then_some(Missing::Order);
    }
    // Any access before the frame comes after the contents that it left.
    let arrival = |touch: &Touch| touch.of.is_none() && matches!(touch.what, What::Access(..));
    if arrival(later) && (earlier.what == What::Initial || arrival(earlier)) {
        return None;
    }
    let submitted = match (earlier.what, later.what) {
        (_, What::After) => earlier.time < later.time,
        _ => earlier.node < later.node,
    };
    if !submitted {
        return None;
    }
    if !timeline.before[later.node].contains(earlier.node) {
        return Some(Missing::Order);
    }
    if !earlier.what.writes() {
        return None;
    }
    let same = earlier.physical == later.physical;
    let parts = earlier.cells.iter().filter(|cell| !same || later.cells.contains(cell));
    parts.map(|cell| lost_between(timeline, (earlier, later), *cell)).find(Option::is_some).flatten()
}

/// The dependency that is missing between a write of one part and a later touch of it that it happens before.
fn lost_between(timeline: &Timeline, (earlier, later): (&Touch, &Touch), cell: usize) -> Option<Missing> {
    let available: Vec<usize> = available_at(timeline, earlier, cell).collect();
    let before = &timeline.before[later.node];
    // Barriers of one call don't order each other: what one makes available comes too late for the others' transitions.
    if !available.iter().any(|point| before.contains(*point)) {
        return Some(Missing::Availability);
    }
    // Contents that another image left in the bytes are nobody's to see: `contents` tells whether they are read.
    let What::Access(stage, access) = later.what else { return None };
    let reads = !later.what.writes() && earlier.physical == later.physical && !replaced(timeline, later, cell);
    let visible = || {
        timeline.operations.iter().filter(|operation| covers(operation, later, cell)).any(|operation| {
            let Some((stages, accesses, node)) = operation.to else { return false };
            operation.queue == later.queue
                && node < later.node
                && take_in(stages, accesses, stage, access)
                && available.iter().any(|point| *point == node || timeline.before[node].contains(*point))
        })
    };
    (reads && !visible()).then_some(Missing::Visibility)
}

/// Whether a load operation that clears or forgets stands between a read within a scope and all that was before the scope: then
/// the read sees only what the scope itself wrote.
fn replaced(timeline: &Timeline, read: &Touch, cell: usize) -> bool {
    let within =
        read.of.is_some_and(|(_, one)| matches!(one.kind, Kind::Attachment { .. } | Kind::Store | Kind::Input { .. }));
    within
        && timeline.touches.iter().any(|touch| {
            (touch.time, touch.physical) == (read.time, read.physical)
                && touch.of.is_some_and(|(_, one)| one.kind == Kind::Load)
                && touch.what.writes()
                && touch.cells.contains(&cell)
        })
}

/// Whether a part of the image or buffer of a touch is an operation's matter.
fn covers(operation: &MemoryOperation, touch: &Touch, cell: usize) -> bool {
    match &operation.part {
        None => true,
        Some((physical, cells)) => *physical == touch.physical && cells.contains(&cell),
    }
}

/// The nodes at which a write of a part is available.
fn available_at<'t>(timeline: &'t Timeline, write: &'t Touch, cell: usize) -> Box<dyn Iterator<Item = usize> + 't> {
    let What::Access(stage, access) = write.what else { return Box::new(std::iter::once(write.node)) };
    let operations = timeline.operations.iter().filter(move |operation| covers(operation, write, cell));
    Box::new(operations.filter_map(move |operation| {
        let (stages, accesses, node) = operation.from?;
        (operation.queue == write.queue && write.node < node && take_in(stages, accesses, stage, access))
            .then_some(node)
    }))
}
