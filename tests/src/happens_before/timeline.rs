//! The frames unrolled: every operation as a node, and which nodes happen before which.
//!
//! Nodes are made in the order of submission, so all that happens before a node is made before it, and the closure is complete
//! as soon as the last node is made. An edge stands for one rule of the specification:
//! - work → first half of a barrier, if its stage is in the barrier's first scope (logically earlier stages included);
//! - first half → layout transition → second half of the same barrier;
//! - second half → work, if its stage is in the second scope (logically later stages included);
//! - second half of one barrier → first half of a later one, if these scopes meet: an execution dependency chain;
//! - everything submitted to a queue up to a step → the signal after that step → what waits for it;
//! - a layout transition → the next one of the same image on the same queue;
//! - the first half of an ownership transfer → its second half, when a semaphore orders them.

use super::scopes::{and_earlier, and_later, each};
use super::touch::{MemoryOperation, Nodes, Touch, What};
use super::uses::{self, Kind};
use super::world::{World, role};
use framewright_graph::plan::{ImageBarrier, Queue, Resource, Role, Step};
use framewright_graph::vulkan::{Accesses, Layout, Stages, State};
use std::collections::{BTreeMap, BTreeSet};

/// Second scopes that stand open on a queue.
#[derive(Debug)]
struct Open {
    node: usize,
    stages: Stages,
    call: usize,
}

#[derive(Debug, Default)]
struct Track {
    /// Nodes of work, by stage.
    work: Vec<(usize, Stages)>,
    open: Vec<Open>,
    all: Nodes,
    transitions: BTreeMap<usize, Vec<usize>>,
}

/// Everything that happens.
pub(super) struct Timeline {
    /// For each node, those that happen before it.
    pub(super) before: Vec<Nodes>,
    pub(super) touches: Vec<Touch>,
    pub(super) operations: Vec<MemoryOperation>,
    /// Acquisitions that no semaphore orders after their releases.
    pub(super) unordered_acquisitions: Vec<String>,
    tracks: BTreeMap<Queue, Track>,
    signals: Vec<usize>,
    /// Last release of each part of each image: its node.
    releases: BTreeMap<(usize, usize), usize>,
    initial: Nodes,
}

/// Unrolls all frames of `world`.
pub(super) fn unroll(world: &World) -> Timeline {
    let mut timeline = Timeline {
        before: Vec::new(),
        touches: Vec::new(),
        operations: Vec::new(),
        unordered_acquisitions: Vec::new(),
        tracks: BTreeMap::new(),
        signals: Vec::new(),
        releases: BTreeMap::new(),
        initial: Nodes::default(),
    };
    for frame in 0..world.frames {
        for resource in world.entries() {
            timeline.arrive(world, frame, resource);
        }
        for (number, step) in world.plan.steps.iter().enumerate() {
            timeline.step(world, frame, number, step);
        }
        for resource in world.entries() {
            timeline.leave(world, frame, resource);
        }
    }
    timeline
}

impl Timeline {
    fn node(&mut self, after: Nodes) -> usize {
        let mut before = after;
        before.extend(&self.initial);
        self.before.push(before);
        self.before.len() - 1
    }

    fn after(&self, nodes: &[usize]) -> Nodes {
        let mut after = Nodes::default();
        for node in nodes {
            after.extend(&self.before[*node]);
            after.insert(*node);
        }
        after
    }

    /// The first half of a barrier before whose call everything so far was submitted.
    fn first_half(&mut self, queue: Queue, stages: Stages, call: usize) -> usize {
        let stages = and_earlier(stages);
        let track = self.tracks.entry(queue).or_default();
        let work = track.work.iter().filter(|(_, stage)| stages.contains(*stage)).map(|(node, _)| *node);
        let open = track.open.iter().filter(|open| open.call < call && stages.intersects(open.stages));
        let nodes: Vec<usize> = work.chain(open.map(|open| open.node)).collect();
        let after = self.after(&nodes);
        self.made(queue, after)
    }

    /// A node that is submitted to a queue.
    fn made(&mut self, queue: Queue, after: Nodes) -> usize {
        let node = self.node(after);
        self.tracks.entry(queue).or_default().all.insert(node);
        node
    }

    fn touch(&mut self, touch: Touch) {
        self.touches.push(touch);
    }

    fn step(&mut self, world: &World, frame: usize, number: usize, step: &Step) {
        let (queue, time) = (step.queue, frame * world.plan.steps.len() + number);
        // Four calls a step: waits, memory barriers, image barriers, releases.
        let call = 4 * time + 1;
        let mut held_up = Vec::new();
        for wait in &step.waits {
            let Some(of) = frame.checked_sub(wait.frames_ago as usize) else { continue };
            let of = of * world.plan.steps.len() + wait.step.0 as usize;
            let Some(signal) = self.signals.get(of) else { continue };
            let after = self.after(&[*signal]);
            let node = self.made(queue, after);
            held_up.push(node);
            let all = Accesses::MEMORY_READ | Accesses::MEMORY_WRITE;
            let to = Some((wait.stages, all, node));
            self.operations.push(MemoryOperation { queue, from: None, to, part: None });
            let open = Open { node, stages: and_later(wait.stages), call: call - 1 };
            self.tracks.entry(queue).or_default().open.push(open);
        }
        let mut opened = Vec::new();
        for barrier in &step.memory_barriers {
            let from = self.first_half(queue, barrier.src_stages, call);
            let after = [&held_up[..], &[from]].concat();
            let after = self.after(&after);
            let to = self.made(queue, after);
            opened.push(Open { node: to, stages: and_later(barrier.dst_stages), call });
            self.operations.push(MemoryOperation {
                queue,
                from: Some((barrier.src_stages, barrier.src_accesses, from)),
                to: Some((barrier.dst_stages, barrier.dst_accesses, to)),
                part: None,
            });
        }
        self.tracks.entry(queue).or_default().open.append(&mut opened);
        let call = call + 1;
        for barrier in &step.image_barriers {
            let to = self.image_barrier(world, (frame, time, call), queue, barrier, &held_up);
            opened.push(Open { node: to, stages: and_later(barrier.dst_stages), call });
        }
        self.tracks.entry(queue).or_default().open.extend(opened);
        self.work(world, (frame, time), step, &held_up);
        for barrier in &step.releases {
            self.image_barrier(world, (frame, time, call + 1), queue, barrier, &held_up);
        }
        if !world.several_queues {
            return;
        }
        let after = self.tracks.entry(queue).or_default().all.clone();
        let after = self.closed(after);
        let signal = self.made(queue, after);
        let from = Some((Stages::ALL_COMMANDS, Accesses::MEMORY_WRITE, signal));
        self.operations.push(MemoryOperation { queue, from, to: None, part: None });
        self.signals.push(signal);
    }

    /// A set with all that happens before its members.
    fn closed(&self, set: Nodes) -> Nodes {
        let mut all = set.clone();
        (0..self.before.len()).filter(|node| set.contains(*node)).for_each(|node| all.extend(&self.before[node]));
        all
    }

    /// An image barrier; its second half.
    fn image_barrier(
        &mut self,
        world: &World,
        (frame, time, call): (usize, usize, usize),
        queue: Queue,
        barrier: &ImageBarrier,
        held_up: &[usize],
    ) -> usize {
        let physical = world.physical(frame, Resource::Image(barrier.image));
        let cells = world.cells(physical, barrier.range);
        let release = barrier.ownership.is_some_and(|[from, to]| from == queue && to != queue);
        let acquisition = barrier.ownership.is_some_and(|[from, to]| to == queue && from != queue);
        let from = self.first_half(queue, barrier.src_stages, call);
        let mut first = [held_up, &[from]].concat();
        if acquisition {
            let released: BTreeSet<usize> =
                cells.iter().filter_map(|cell| self.releases.get(&(physical, *cell)).copied()).collect();
            // The semaphore, not the barrier, must bring the order.
            let known = self.after(&first);
            if released.iter().any(|release| !known.contains(*release)) {
                let name = &world.physical[physical].name;
                self.unordered_acquisitions
                    .push(format!("`{name}` is acquired before its release is known to be done"));
            }
            first.extend(released.into_iter().filter(|release| known.contains(*release)));
        }
        let changes = barrier.old_layout != barrier.new_layout || barrier.old_layout == Layout::Undefined;
        if changes {
            let track = self.tracks.entry(queue).or_default();
            first.extend(track.transitions.get(&physical).into_iter().flatten());
        }
        let after = self.after(&first);
        let middle = self.made(queue, after);
        if changes && !release {
            self.tracks.entry(queue).or_default().transitions.entry(physical).or_default().push(middle);
            let what = What::Transition;
            self.touch(Touch { node: middle, queue, time, physical, cells: cells.clone(), what, of: None });
        }
        let after = self.after(&[middle]);
        let to = self.made(queue, after);
        if release {
            self.releases.extend(cells.iter().map(|cell| ((physical, *cell), to)));
        }
        self.operations.push(MemoryOperation {
            queue,
            from: (!acquisition).then_some((barrier.src_stages, barrier.src_accesses, from)),
            to: (!release).then_some((barrier.dst_stages, barrier.dst_accesses, to)),
            part: Some((physical, cells)),
        });
        to
    }

    fn work(&mut self, world: &World, (frame, time): (usize, usize), step: &Step, held_up: &[usize]) {
        let queue = step.queue;
        let uses = uses::of(&step.work);
        let mut nodes: BTreeMap<Stages, usize> = BTreeMap::new();
        let mut local = Vec::new();
        for (number, one) in uses.into_iter().enumerate() {
            let physical = world.physical(frame, one.resource);
            let cells = world.cells(physical, one.range);
            for (stage, access) in each(one.stages, one.accesses) {
                let node = match (one.kind, nodes.get(&stage)) {
                    (Kind::Input { shown: 1.., .. }, _) => {
                        let part = (physical, cells.clone());
                        let drawn = nodes.get(&Stages::COLOR_ATTACHMENT_OUTPUT).copied();
                        let node = self.after_local_barrier(queue, (stage, drawn), held_up, part);
                        local.push((node, stage));
                        node
                    }
                    (_, Some(node)) => *node,
                    (_, None) => {
                        let open = self.open(queue, stage);
                        let after = self.after(&[held_up, &open].concat());
                        let node = self.made(queue, after);
                        nodes.insert(stage, node);
                        node
                    }
                };
                let what = What::Access(stage, access);
                let of = Some((number, one));
                self.touch(Touch { node, queue, time, physical, cells: cells.clone(), what, of });
            }
        }
        let nodes = nodes.into_iter().map(|(stage, node)| (node, stage)).chain(local);
        self.tracks.entry(queue).or_default().work.extend(nodes);
    }

    /// Second scopes that a stage is in.
    fn open(&mut self, queue: Queue, stage: Stages) -> Vec<usize> {
        let track = self.tracks.entry(queue).or_default();
        track.open.iter().filter(|open| open.stages.contains(stage)).map(|open| open.node).collect()
    }

    /// The node of what reads a part at its own position after a by-region barrier, which continues what colour output
    /// waits for, and shows what it wrote.
    fn after_local_barrier(
        &mut self,
        queue: Queue,
        (stage, drawn): (Stages, Option<usize>),
        held_up: &[usize],
        part: (usize, Vec<usize>),
    ) -> usize {
        let first = [held_up, &self.open(queue, Stages::COLOR_ATTACHMENT_OUTPUT), drawn.as_slice()].concat();
        let after = self.after(&first);
        let from = self.made(queue, after);
        let after = self.after(&[from]);
        let to = self.made(queue, after);
        self.operations.push(MemoryOperation {
            queue,
            from: Some((Stages::COLOR_ATTACHMENT_OUTPUT, Accesses::COLOR_ATTACHMENT_WRITE, from)),
            to: Some((Stages::FRAGMENT_SHADER, Accesses::INPUT_ATTACHMENT_READ, to)),
            part: Some(part),
        });
        let after = [held_up, &self.open(queue, stage), &[to]].concat();
        let after = self.after(&after);
        self.made(queue, after)
    }

    /// The queue of the first (or last) step that uses it.
    fn queue_of(world: &World, resource: Resource, last: bool) -> Option<Queue> {
        let touches = |step: &&Step| {
            let barriers = step.image_barriers.iter().any(|barrier| Resource::Image(barrier.image) == resource);
            barriers || uses::of(&step.work).iter().any(|one| one.resource == resource)
        };
        let steps = &world.plan.steps;
        let step = if last { steps.iter().rfind(touches) } else { steps.iter().find(touches) };
        step.map(|step| step.queue)
    }

    /// The arrival of a resource from outside: its contents, and the accesses that were the last to it.
    fn arrive(&mut self, world: &World, frame: usize, resource: Resource) {
        let Some(State { stages, accesses, .. }) = world.arrives(frame, resource) else { return };
        let Some(queue) = Timeline::queue_of(world, resource, false) else { return };
        let physical = world.physical(frame, resource);
        let (time, cells) = (frame * world.plan.steps.len(), world.all_cells(physical));
        let node = self.node(Nodes::default());
        self.initial.insert(node);
        self.touch(Touch { node, queue, time, physical, cells: cells.clone(), what: What::Initial, of: None });
        let to = self.node(Nodes::default());
        self.initial.insert(to);
        let external = matches!(role(world.plan, resource), Role::External { .. });
        let mut show = |queue, stages, accesses| {
            let part = Some((physical, cells.clone()));
            self.operations.push(MemoryOperation { queue, from: None, to: Some((stages, accesses, to)), part });
        };
        if !external {
            // The preparation was waited for, and any queue may be the first to use the resource.
            let all = Accesses::MEMORY_READ | Accesses::MEMORY_WRITE;
            for queue in [Queue::Graphics, Queue::Compute, Queue::Transfer] {
                show(queue, Stages::ALL_COMMANDS, all);
            }
        } else {
            show(queue, stages, accesses);
        }
        if external && !stages.is_empty() {
            // A wait alone says stages without accesses: the next change of the image must wait for them.
            let accesses = if accesses.is_empty() { Accesses::MEMORY_READ } else { accesses };
            for (stage, access) in each(stages, accesses) {
                let node = self.made(queue, Nodes::default());
                self.tracks.entry(queue).or_default().work.push((node, stage));
                let what = What::Access(stage, access);
                self.touch(Touch { node, queue, time, physical, cells: cells.clone(), what, of: None });
            }
        }
    }

    /// The departure of a resource: somebody waits for the promised state with a barrier of its own.
    fn leave(&mut self, world: &World, frame: usize, resource: Resource) {
        let after = match role(world.plan, resource) {
            Role::External { after, .. } => *after,
            Role::Persistent { after, .. } if world.plan.outputs.iter().any(|it| it.resource == resource) => *after,
            _ => return,
        };
        let Some(queue) = Timeline::queue_of(world, resource, true) else { return };
        let physical = world.physical(frame, resource);
        let (time, cells) = ((frame + 1) * world.plan.steps.len(), world.all_cells(physical));
        let track = self.tracks.entry(queue).or_default();
        // No stages: a semaphore, which waits for all.
        let (stages, accesses) = match after.stages.is_empty() {
            true => (Stages::ALL_COMMANDS, Accesses::MEMORY_WRITE),
            false => (after.stages, after.accesses),
        };
        let scope = and_earlier(stages);
        let work = track.work.iter().filter(|(_, stage)| scope.contains(*stage)).map(|(node, _)| *node);
        let open = track.open.iter().filter(|open| scope.intersects(open.stages)).map(|open| open.node);
        let nodes: Vec<usize> = work.chain(open).collect();
        let all = track.all.clone();
        let before = if after.stages.is_empty() { self.closed(all) } else { self.after(&nodes) };
        let from = self.node(before);
        let before = self.after(&[from]);
        let node = self.node(before);
        let part = Some((physical, cells.clone()));
        let from = Some((stages, accesses, from));
        self.operations.push(MemoryOperation { queue, from, to: None, part });
        self.touch(Touch { node, queue, time, physical, cells, what: What::After, of: None });
    }
}
