//! Whether frames take what has an outside owner, use it on one queue, and give it back.
//!
//! The owner has it when a frame begins, and when the frame has ended. So exactly one step acquires it, no later than the first one that
//! uses it, and exactly one releases it, no earlier than the last. Both name the layout in which it comes or goes, and at least the stages
//! and accesses of that state: the barriers after an acquire go on from that state, and those before a release lead to it. Where the
//! state names none, semaphores go on from it in any stage. An image whose contents aren't needed isn't acquired, as a barrier from
//! `UNDEFINED` makes any queue its owner.

use super::findings::{Findings, role};
use crate::plan::{OutsideTransfer, OutsideWay, Plan, Queue, Resource, Role, Step, StepId};
use crate::vulkan::{Accesses, Layout, OutsideOwner, Stages, State, name_of};

/// Reports what is taken or given wrongly.
pub(super) fn check(plan: &Plan, found: &mut Findings<'_>) {
    let images = plan.images.len() as u32;
    for resource in 0..images + plan.buffers.len() as u32 {
        if let Role::External { before, after, owner: Some(owner) } = role(plan, resource) {
            let checked = Owned { plan, resource, is_image: resource < images, owner: *owner };
            checked.check(before, after, found);
        }
    }
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        for transfer in &step.outside {
            let resource = number(images, transfer.resource);
            if !matches!(role(plan, resource), Role::External { owner: Some(owner), .. } if *owner == transfer.owner) {
                let what = format!("changes hands with {}, which it doesn't have", transfer.owner.words());
                found.structure(Some(id), Some(resource), what);
            }
        }
    }
}

/// Images and buffers are numbered in one row, buffers after images.
fn number(images: u32, resource: Resource) -> u32 {
    match resource {
        Resource::Image(image) => image.0,
        Resource::Buffer(buffer) => images + buffer.0,
    }
}

/// An image or buffer with an outside owner.
struct Owned<'p> {
    plan: &'p Plan,
    resource: u32,
    is_image: bool,
    owner: OutsideOwner,
}

impl Owned<'_> {
    fn check(&self, before: &State, after: &State, found: &mut Findings<'_>) {
        let users: Vec<(StepId, Queue)> =
            self.steps().filter(|(_, it)| self.uses(it)).map(|(id, it)| (id, it.queue)).collect();
        let (Some((first, queue)), Some((last, _))) = (users.first(), users.last()) else { return };
        if let Some((id, _)) = users.iter().find(|(_, other)| other != queue) {
            let what = format!("is used on two queues, and only one can take it from {}", self.owner.words());
            found.structure(Some(*id), Some(self.resource), what);
        }
        let ways = [(OutsideWay::Acquire, before, *first), (OutsideWay::Release, after, *last)];
        for (way, state, user) in ways {
            let needed = !self.is_image || state.layout != Layout::Undefined;
            self.check_way(way, needed.then_some(state), (user, *queue), found);
        }
    }

    fn steps(&self) -> impl Iterator<Item = (StepId, &Step)> {
        (0..).map(StepId).zip(&self.plan.steps)
    }

    /// Whether a step uses it, by barriers too.
    fn uses(&self, step: &Step) -> bool {
        let images = self.plan.images.len() as u32;
        let mut barriers = step.image_barriers.iter().chain(&step.releases);
        self.is_image && barriers.any(|barrier| barrier.image.0 == self.resource)
            || step.work.used().any(|(used, _)| number(images, used) == self.resource)
    }

    /// `state`: that in which it comes or goes; `None`: it isn't handed over in this way. `user`: the step that it comes before or after.
    fn check_way(&self, way: OutsideWay, state: Option<&State>, user: (StepId, Queue), found: &mut Findings<'_>) {
        let images = self.plan.images.len() as u32;
        let (does, from) = match way {
            OutsideWay::Acquire => ("taken", "from"),
            OutsideWay::Release => ("given back", "to"),
        };
        let owner = self.owner.words();
        let mut done = 0;
        for (id, step) in self.steps() {
            let here = |it: &&OutsideTransfer| it.way == way && number(images, it.resource) == self.resource;
            for transfer in step.outside.iter().filter(here) {
                done += 1;
                let Some(state) = state else { continue };
                let too = match way {
                    OutsideWay::Acquire if id > user.0 => Some("after its first use"),
                    OutsideWay::Release if id < user.0 => Some("before its last use"),
                    OutsideWay::Acquire | OutsideWay::Release => None,
                };
                let what = match too {
                    Some(too) => Some(format!("is {does} {from} {owner} {too}")),
                    None if step.queue != user.1 => Some(format!("is {does} {from} {owner} on another queue")),
                    None => wrong_state(state, &transfer.state).map(|why| format!("is {does} {from} {owner} {why}")),
                };
                if let Some(what) = what {
                    found.structure(Some(id), Some(self.resource), what);
                }
            }
        }
        let needed = u32::from(state.is_some());
        if done < needed {
            found.structure(Some(user.0), Some(self.resource), format!("is never {does} {from} {owner}"));
        } else if done > needed {
            let often = if needed == 0 { "though its contents aren't needed" } else { "twice" };
            found.structure(Some(user.0), Some(self.resource), format!("is {does} {from} {owner} {often}"));
        }
    }
}

/// Why a transfer's state doesn't serve for the one that is stated.
fn wrong_state(stated: &State, given: &State) -> Option<String> {
    if stated.layout != given.layout {
        let [given, stated] = [given.layout, stated.layout].map(|layout| name_of(&layout));
        return Some(format!("in {given}, and not in {stated}"));
    }
    if Stages::from_bits(given.stages.bits()).is_none() || Accesses::from_bits(given.accesses.bits()).is_none() {
        return Some("in stages or accesses that are not known".to_owned());
    }
    let (stages, accesses) = match stated.stages.is_empty() {
        true => (Stages::ALL_COMMANDS, Accesses::MEMORY),
        false => (stated.stages, stated.accesses),
    };
    let in_stages = given.stages.contains(stages) || given.stages.contains(Stages::ALL_COMMANDS);
    let in_accesses = given.accesses.contains(accesses) || given.accesses.contains(Accesses::MEMORY);
    let lacks = !in_stages || !in_accesses;
    lacks.then(|| {
        let [given, stated] = [(given.stages, given.accesses), (stages, accesses)]
            .map(|(stages, accesses)| format!("{} in {}", name_of(&accesses), name_of(&stages)));
        format!("for {given}, which leaves out {stated}")
    })
}
