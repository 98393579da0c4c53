//! `queues`: which queue each step runs on.
//!
//! A dispatch, copy or fill leaves the graphics queue if its window has work: graphics steps that it doesn't depend on and
//! that don't depend on it. In a chain between two draws with no such work, each step would wait for the other queue; the
//! chain stays. A frame doesn't say how long its passes take, so nothing else is weighed. Each step that stays makes other
//! windows smaller, so windows are looked at again until nothing changes.

use super::crossing::Crossing;
use super::eligible::{Eligible, GraphicsOnly};
use super::layout_changes::{self, WithChanges};
use super::number::QUEUES;
use super::state::Queues;
use super::step_uses::uses_of;
use super::windows::Steps;
use crate::compile::history_ring::last_of_ring;
use crate::compile::model::{Adapted, Kind, MemorySource, OpKind, PhysicalIndex};
use crate::compile::options::Options;
use crate::compile::scope::{Scoped, Step, op_name, resource_name};
use crate::device::Profile;
use crate::frame::{Frame, Work};
use crate::plan::{Note, Queue, Stage};
use crate::vulkan::{Layout, Sharing};

/// How often all windows are looked at. Frames that people write take a few rounds.
const MOST_ROUNDS: u32 = 32;

/// Why an eligible step stays on graphics.
const ALONE: &str = "nothing that neither waits for it nor is waited for runs beside it";
const UNDECIDED: &str =
    "what can run beside what was not found out in as many rounds as are tried, so nothing leaves it";

/// The queues, and what follows from them for other stages.
#[derive(Debug)]
pub(in crate::compile) struct Assigned {
    /// The steps, with those that change layouts.
    pub(in crate::compile) scoped: Scoped,
    pub(in crate::compile) queues: Queues,
    pub(in crate::compile) notes: Vec<Note>,
    /// Physical resources that are used on other queues than graphics, with their sharing.
    pub(in crate::compile) sharing: Vec<(PhysicalIndex, Sharing)>,
}

/// Gives each step its queue, and inserts steps that change layouts.
pub(in crate::compile) fn assign(
    frame: &Frame,
    adapted: &Adapted,
    scoped: Scoped,
    device: &Profile,
    options: &Options,
) -> Assigned {
    if !options.queues || !(device.queues.compute || device.queues.transfer) {
        return one_queue(scoped, Vec::new());
    }
    let eligible = Eligible { frame, adapted, device, options };
    let bound: Vec<Result<[bool; QUEUES], GraphicsOnly>> = scoped.steps.iter().map(|step| eligible.of(step)).collect();
    let mut queues = wanted(frame, adapted, &scoped, &bound);
    let mut windows = Vec::new();
    let mut gives_up = false;
    for round in 0.. {
        if queues.iter().all(|queue| *queue == Queue::Graphics) {
            break;
        }
        if round == MOST_ROUNDS {
            queues.fill(Queue::Graphics);
            gives_up = true;
            break;
        }
        let steps = Steps { adapted, steps: &scoped.steps, queues: &queues, sharing: device.queues.sharing };
        windows = steps.beside();
        let mut stays: Vec<bool> = (windows.iter().zip(&queues))
            .map(|(window, queue)| *queue != Queue::Graphics && beside(&bound, *window).next().is_none())
            .collect();
        split_users(adapted, &scoped, &queues, &mut stays);
        if !stays.contains(&true) {
            break;
        }
        for (queue, _) in queues.iter_mut().zip(&stays).filter(|(_, stays)| **stays) {
            *queue = Queue::Graphics;
        }
    }
    let stays = if gives_up { UNDECIDED } else { ALONE };
    let notes = notes(frame, adapted, &scoped, &bound, &queues, &windows, stays);
    if queues.iter().all(|queue| *queue == Queue::Graphics) {
        return one_queue(scoped, notes);
    }
    let (crossings, sharing) = share(adapted, &scoped, device, &queues);
    let WithChanges { scoped, queues, changes } = layout_changes::insert(adapted, scoped, &queues, &crossings);
    Assigned { scoped, queues: Queues::new(queues, crossings, changes, adapted.subresources), notes, sharing }
}

/// All steps on graphics.
fn one_queue(scoped: Scoped, notes: Vec<Note>) -> Assigned {
    Assigned { scoped, queues: Queues::default(), notes, sharing: Vec::new() }
}

/// The queue that each step would leave graphics for. A transfer of what dispatches use goes to the compute queue: that
/// saves waits.
fn wanted(
    frame: &Frame,
    adapted: &Adapted,
    scoped: &Scoped,
    bound: &[Result<[bool; QUEUES], GraphicsOnly>],
) -> Vec<Queue> {
    let [compute, transfer] = [Queue::Compute, Queue::Transfer].map(|queue| queue as usize);
    let mut dispatched = vec![false; adapted.resources.len()];
    for (step, able) in scoped.steps.iter().zip(bound) {
        if able.is_ok_and(|able| able[compute]) && is_dispatch(frame, adapted, step) {
            uses(adapted, step).for_each(|(resource, ..)| dispatched[resource as usize] = true);
        }
    }
    let choose = |(step, able): (&Step, &Result<[bool; QUEUES], GraphicsOnly>)| match able {
        Err(_) => Queue::Graphics,
        Ok(able) if able[transfer] => {
            let beside = able[compute] && uses(adapted, step).any(|(resource, ..)| dispatched[resource as usize]);
            if beside { Queue::Compute } else { Queue::Transfer }
        }
        Ok(_) => Queue::Compute,
    };
    scoped.steps.iter().zip(bound).map(choose).collect()
}

fn is_dispatch(frame: &Frame, adapted: &Adapted, step: &Step) -> bool {
    let pass = step.ops().first().and_then(|op| adapted.ops[*op as usize].kind.pass());
    pass.is_some_and(|pass| matches!(frame.passes[pass as usize].work, Work::Dispatch { .. }))
}

/// Every image and buffer that a step uses, whether it writes it, and in which layout.
fn uses<'a>(adapted: &'a Adapted, step: &'a Step) -> impl Iterator<Item = (PhysicalIndex, bool, Layout)> + 'a {
    uses_of(adapted, step).map(|used| (used.resource, used.writes, used.layout))
}

/// The graphics steps of a window, without eligible ones that stay.
fn beside(bound: &[Result<[bool; QUEUES], GraphicsOnly>], [from, to]: [u32; 2]) -> impl Iterator<Item = u32> {
    (from..to.max(from)).filter(|step| bound[*step as usize].is_err())
}

/// Imported images and buffers are used on one queue, or on graphics: the state before the frame names the stages of one queue.
fn split_users(adapted: &Adapted, scoped: &Scoped, queues: &[Queue], stays: &mut [bool]) {
    let is_imported =
        |resource: PhysicalIndex| matches!(adapted.resources[resource as usize].memory, MemorySource::Imported { .. });
    let mut user: Vec<Option<Queue>> = vec![None; adapted.resources.len()];
    let mut split = vec![false; adapted.resources.len()];
    for (step, at) in scoped.steps.iter().zip(0..) {
        let queue = if stays[at] { Queue::Graphics } else { queues[at] };
        for (resource, ..) in uses(adapted, step).filter(|(resource, ..)| is_imported(*resource)) {
            split[resource as usize] |= user[resource as usize].replace(queue).is_some_and(|other| other != queue);
        }
    }
    for (step, at) in scoped.steps.iter().zip(0..) {
        let moves = queues[at] != Queue::Graphics;
        stays[at] |= moves && uses(adapted, step).any(|(resource, ..)| split[resource as usize]);
    }
}

/// Why each pass that isn't drawn runs on its queue. `stays`: why eligible steps stay on graphics.
fn notes(
    frame: &Frame,
    adapted: &Adapted,
    scoped: &Scoped,
    bound: &[Result<[bool; QUEUES], GraphicsOnly>],
    queues: &[Queue],
    windows: &[[u32; 2]],
    stays: &str,
) -> Vec<Note> {
    let mut notes = Vec::new();
    for (step, at) in scoped.steps.iter().zip(0..) {
        let Step::Single(op) = step else { continue };
        let OpKind::Pass(pass) = adapted.ops[*op as usize].kind else { continue };
        let declared = &frame.passes[pass as usize];
        let text = match (queues[at], bound[at]) {
            (Queue::Graphics, Err(why)) => match why.why() {
                Some(why) => format!("stays on the graphics queue: {why}"),
                None => continue,
            },
            (Queue::Graphics, Ok(_)) => format!("stays on the graphics queue: {stays}"),
            (queue, _) => {
                let mut others = beside(bound, windows[at]);
                let name = others.next().and_then(|step| first_name(frame, adapted, &scoped.steps[step as usize]));
                let name = name.map_or_else(String::new, |name| format!("`{name}`"));
                let more = match others.count() {
                    0 => String::new(),
                    count => format!(" and {count} more"),
                };
                let queue = if queue == Queue::Compute { "compute" } else { "transfer" };
                format!("runs on the {queue} queue, beside {name}{more}")
            }
        };
        let (subject, at) = (declared.name.clone(), frame.sources.place(declared.span));
        notes.push(Note { stage: Stage::Schedule, subject, text, at });
    }
    notes
}

/// The name of a step in notes.
fn first_name<'f>(frame: &'f Frame, adapted: &'f Adapted, step: &Step) -> Option<&'f str> {
    let named = step.ops().iter().find_map(|op| op_name(frame, adapted, *op));
    let transferred = || {
        let used = adapted.uses(*step.ops().first()?).first()?;
        Some(resource_name(frame, adapted, used.resource))
    };
    named.or_else(transferred).map(|name| &**name)
}

/// How several queues share each physical resource, and the sharing of those that other queues than graphics use.
fn share(
    adapted: &Adapted,
    scoped: &Scoped,
    device: &Profile,
    of: &[Queue],
) -> (Vec<Option<Crossing>>, Vec<(PhysicalIndex, Sharing)>) {
    let count = adapted.resources.len();
    let mut users = vec![[false; QUEUES]; count];
    let mut layouts: Vec<Option<Layout>> = vec![None; count];
    let mut constant = vec![true; count];
    for (step, queue) in scoped.steps.iter().zip(of) {
        for (resource, writes, layout) in uses(adapted, step) {
            let resource = resource as usize;
            users[resource][*queue as usize] = true;
            // Between frames all planes have one layout.
            let stays = adapted.resources[resource].layout_of_all_planes(layout) == layout;
            let same = layouts[resource].replace(layout).is_none_or(|other| other == layout);
            constant[resource] &= !writes && stays && same;
        }
    }
    // The members of a history ring are used by each other's queues.
    let mut first = 0;
    while first < count {
        let last = last_of_ring(adapted, first as PhysicalIndex) as usize;
        if last > first {
            let all = users[first..=last].iter().fold([false; QUEUES], |all, users| {
                let mut all = all;
                all.iter_mut().zip(users).for_each(|(all, uses)| *all |= uses);
                all
            });
            users[first..=last].fill(all);
            constant[first..=last].fill(false);
        }
        first = last + 1;
    }
    let mut crossings = vec![None; count];
    let mut sharing = Vec::new();
    for (resource, at) in adapted.resources.iter().zip(0..) {
        let beside = users[at][1..].contains(&true);
        let several = users[at].iter().filter(|uses| **uses).count() > 1;
        let transient = resource.is_transient();
        let persistent = matches!(resource.memory, MemorySource::Persistent { .. });
        // Images and buffers that outlive the frame are prepared and read on graphics.
        let shared = match (transient, &resource.kind) {
            (true, Kind::Image(_)) if several => device.queues.sharing,
            (true, Kind::Buffer(_)) if several => Sharing::Concurrent,
            (false, _) if beside => Sharing::Concurrent,
            _ => continue,
        };
        sharing.push((at as PhysicalIndex, shared));
        let crossing = match (&resource.kind, shared) {
            _ if persistent && constant[at] => Crossing::Constant,
            (Kind::Buffer(_), _) => Crossing::Buffer,
            (Kind::Image(_), Sharing::Concurrent) => Crossing::Image,
            (Kind::Image(_), Sharing::Exclusive) => Crossing::Exclusive,
        };
        crossings[at] = Some(crossing).filter(|_| several || persistent);
    }
    (crossings, sharing)
}
