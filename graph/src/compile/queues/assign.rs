//! `assign`: the queues of a frame, and what follows from them: how resources are shared, and where layouts change.

use super::crossing::Crossing;
use super::decide::{Decision, decide};
use super::layout_changes::{self, ChangedLayoutSteps};
use super::number::QUEUES;
use super::state::Queues;
use super::step_uses::uses;
use crate::compile::history_ring::last_of_ring;
use crate::compile::model::{AdaptedFrame, Kind, MemorySource, PhysicalIndex};
use crate::compile::options::Options;
use crate::compile::scope::ScopedSteps;
use crate::device::Profile;
use crate::frame::Frame;
use crate::plan::{Note, Queue};
use crate::vulkan::{Layout, Sharing};

/// The queues, and what follows from them for other stages.
#[derive(Debug)]
pub(in crate::compile) struct QueueAssignment {
    /// The steps, with those that change layouts.
    pub(in crate::compile) scoped: ScopedSteps,
    pub(in crate::compile) queues: Queues,
    pub(in crate::compile) notes: Vec<Note>,
    /// Physical resources that are used on other queues than graphics, with their sharing.
    pub(in crate::compile) sharing: Vec<(PhysicalIndex, Sharing)>,
}

/// Gives each step its queue, and inserts steps that change layouts.
pub(in crate::compile) fn assign(
    frame: &Frame,
    adapted: &AdaptedFrame,
    scoped: ScopedSteps,
    device: &Profile,
    options: &Options,
) -> QueueAssignment {
    let Decision { queues, notes } = decide(frame, adapted, &scoped.steps, device, options);
    if queues.iter().all(|queue| *queue == Queue::Graphics) {
        return QueueAssignment { scoped, queues: Queues::default(), notes, sharing: Vec::new() };
    }
    let (crossings, sharing) = share(adapted, &scoped, device, &queues);
    let ChangedLayoutSteps { scoped, queues, changes } = layout_changes::insert(adapted, scoped, &queues, &crossings);
    QueueAssignment { scoped, queues: Queues::new(queues, crossings, changes, adapted.subresources), notes, sharing }
}

/// How several queues share each physical resource. Only a resource that another queue than graphics uses is shared.
fn share(
    adapted: &AdaptedFrame,
    scoped: &ScopedSteps,
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
