//! The contents, layout and owning queue of each part of each image, followed through the steps in order.

use super::uses::{self, Kind, Use};
use super::world::{World, role};
use framewright_graph::frame::{Blend, Draw};
use framewright_graph::plan::{Attachment, ImageBarrier, Pass, Queue, RenderScope, Resource, Role, Side, Work};
use framewright_graph::vulkan::{Accesses, CompareOp, CullMode, Layout, LoadOp, Sharing, Stages, StoreOp};
use std::hash::{DefaultHasher, Hash, Hasher};

/// The contents of a part; `None`: nothing that is defined.
type Value = Option<u64>;

fn number(of: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    hasher.finish()
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Owner {
    Nobody,
    Queue(Queue),
    Released { to: Queue, from: Layout, into: Layout },
}

#[derive(Debug, Clone, Copy)]
struct Cell {
    value: Value,
    layout: Layout,
    owner: Owner,
}

const FRESH: Cell = Cell { value: None, layout: Layout::Undefined, owner: Owner::Nobody };

struct Follower<'w> {
    world: &'w World<'w>,
    frame: usize,
    cells: Vec<Vec<Cell>>,
    wrong: Vec<String>,
    outcome: Vec<Value>,
}

/// Follows all frames: what is wrong, and what outputs hold.
pub(super) fn follow(world: &World) -> (Vec<String>, Vec<Value>) {
    let cells = (0..world.physical.len()).map(|physical| vec![FRESH; world.all_cells(physical).len()]).collect();
    let mut follower = Follower { world, frame: 0, cells, wrong: Vec::new(), outcome: Vec::new() };
    for frame in 0..world.frames {
        follower.frame = frame;
        world.entries().for_each(|resource| follower.arrive(resource));
        for (number, step) in world.plan.steps.iter().enumerate() {
            for barrier in &step.image_barriers {
                follower.barrier(number, step.queue, barrier);
            }
            for one in uses::of(&step.work) {
                follower.check(number, step.queue, &one);
            }
            follower.work(number, &step.work);
            for barrier in &step.releases {
                follower.barrier(number, step.queue, barrier);
            }
        }
        world.entries().for_each(|resource| follower.leave(resource));
    }
    follower.wrong.sort();
    follower.wrong.dedup();
    (follower.wrong, follower.outcome)
}

impl Follower<'_> {
    fn name(&self, physical: usize) -> &str {
        &self.world.physical[physical].name
    }

    fn wrong(&mut self, step: usize, what: impl std::fmt::Display) {
        self.wrong.push(format!("step {step}: {what}"));
    }

    fn arrive(&mut self, resource: Resource) {
        let Some(state) = self.world.arrives(self.frame, resource) else { return };
        let physical = self.world.physical(self.frame, resource);
        let external = matches!(role(self.world.plan, resource), Role::External { .. });
        let empty = external && state.layout == Layout::Undefined && matches!(resource, Resource::Image(_));
        let name = self.name(physical).to_owned();
        for (number_of_cell, cell) in self.cells[physical].iter_mut().enumerate() {
            let value = (!empty).then(|| number(("before the frame", &name, number_of_cell)));
            *cell = Cell { value, layout: state.layout, owner: Owner::Nobody };
        }
    }

    fn leave(&mut self, resource: Resource) {
        let plan = self.world.plan;
        let physical = self.world.physical(self.frame, resource);
        let output = plan.outputs.iter().any(|output| output.resource == resource);
        let after = match role(plan, resource) {
            Role::External { after, .. } | Role::Persistent { after, .. } => after.layout,
            Role::Transient(_) => return,
        };
        for cell in self.cells[physical].clone() {
            self.outcome.push(cell.value);
            if output && cell.value.is_none() {
                let what = format!("`{}` leaves the frame undefined", self.name(physical));
                self.wrong(plan.steps.len(), what);
            }
            if matches!(resource, Resource::Image(_)) && cell.layout != after {
                let what = format!("`{}` is left in {:?}, not in {after:?}", self.name(physical), cell.layout);
                self.wrong(plan.steps.len(), what);
            }
        }
    }

    fn shared(&self, resource: Resource) -> bool {
        let sharing = match resource {
            Resource::Image(image) => self.world.plan.image(image).sharing,
            Resource::Buffer(buffer) => self.world.plan.buffers[buffer.0 as usize].sharing,
        };
        sharing == Sharing::Concurrent
    }

    fn barrier(&mut self, step: usize, queue: Queue, barrier: &ImageBarrier) {
        let resource = Resource::Image(barrier.image);
        let physical = self.world.physical(self.frame, resource);
        let shared = self.shared(resource);
        let (old, new) = (barrier.old_layout, barrier.new_layout);
        let transfer = barrier.ownership.filter(|[from, to]| from != to && !shared);
        for at in self.world.cells(physical, barrier.range) {
            let mut cell = self.cells[physical][at];
            let name = self.name(physical).to_owned();
            if old != Layout::Undefined && old != cell.layout {
                self.wrong(step, format!("barrier takes `{name}` from {old:?}, but it is in {:?}", cell.layout));
            }
            let mine = [Owner::Nobody, Owner::Queue(queue)].contains(&cell.owner) || shared;
            match transfer {
                Some([from, to]) if from == queue => {
                    if !mine {
                        self.wrong(step, format!("`{name}` is released by a queue that doesn't own it"));
                    }
                    cell.owner = Owner::Released { to, from: old, into: new };
                    self.cells[physical][at] = cell;
                    continue;
                }
                Some(_) => {
                    // The preparation of a persistent resource has released it to the first queue that acquires it.
                    let prepared = self.frame == 0
                        && cell.owner == Owner::Nobody
                        && matches!(role(self.world.plan, resource), Role::Persistent { .. });
                    if !prepared && cell.owner != (Owner::Released { to: queue, from: old, into: new }) {
                        self.wrong(step, format!("`{name}` is acquired, but was not released like that"));
                    }
                    cell.owner = Owner::Queue(queue);
                }
                None if old == Layout::Undefined => cell.owner = Owner::Queue(queue),
                None => {
                    if !mine {
                        self.wrong(step, format!("barrier on `{name}`, which another queue owns"));
                    }
                    cell.owner = Owner::Queue(queue);
                }
            }
            if old == Layout::Undefined {
                cell.value = None;
            }
            cell.layout = new;
            self.cells[physical][at] = cell;
        }
        let transition = old != new || old == Layout::Undefined;
        if transition && transfer.is_none_or(|[from, _]| from != queue) {
            self.taken(physical);
        }
    }

    /// Resources that share bytes with what was written lose their contents, and with them the layout that they were in.
    fn taken(&mut self, by: usize) {
        for other in 0..self.world.physical.len() {
            if self.world.share_bytes(other, by) {
                self.cells[other].iter_mut().for_each(|cell| (cell.value, cell.layout) = (None, Layout::Undefined));
            }
        }
    }

    /// Whether a use finds its image in its layout and on its queue.
    fn check(&mut self, step: usize, queue: Queue, one: &Use) {
        let physical = self.world.physical(self.frame, one.resource);
        for at in self.world.cells(physical, one.range) {
            let cell = self.cells[physical][at];
            let name = self.name(physical).to_owned();
            if let Some(layout) = one.layout.filter(|layout| *layout != cell.layout) {
                self.wrong(step, format!("`{name}` is used in {layout:?}, but it is in {:?}", cell.layout));
            }
            if !self.shared(one.resource) {
                if ![Owner::Nobody, Owner::Queue(queue)].contains(&cell.owner) {
                    self.wrong(step, format!("`{name}` is used by a queue that doesn't own it"));
                }
                self.cells[physical][at].owner = Owner::Queue(queue);
            }
        }
    }

    fn values(&self, one: &Use) -> Vec<Value> {
        let physical = self.world.physical(self.frame, one.resource);
        self.world.cells(physical, one.range).into_iter().map(|at| self.cells[physical][at].value).collect()
    }

    /// Reads that must find something defined: one number for all of it.
    fn read(&mut self, step: usize, one: &Use) -> Value {
        let values = self.values(one);
        if values.contains(&None) {
            let what = format!("`{}` is read, but undefined", self.name(self.world.physical(self.frame, one.resource)));
            self.wrong(step, what);
        }
        values.into_iter().collect::<Option<Vec<u64>>>().map(number)
    }

    fn write(&mut self, one: &Use, value: impl Fn(usize, Value) -> Value) {
        let physical = self.world.physical(self.frame, one.resource);
        self.taken(physical);
        for (place, at) in self.world.cells(physical, one.range).into_iter().enumerate() {
            let cell = &mut self.cells[physical][at];
            cell.value = value(place, cell.value);
        }
    }

    fn work(&mut self, step: usize, work: &Work) {
        match work {
            Work::Render(scope) => self.render(step, scope),
            Work::Dispatch(pass) => {
                let read = self.reads(step, pass, uses::of_pass(pass, [0; 2], Kind::Plain));
                self.stores(pass, read);
            }
            Work::Custom(pass) => {
                let read = self.reads(step, pass, uses::of_pass(pass, [0; 2], Kind::Custom));
                self.outcome.push(read);
                self.stores(pass, read);
            }
            Work::Resolve(it) => self.transfer(work, &it.source, &it.target, "resolved"),
            Work::Copy(it) => self.transfer(work, &it.source, &it.target, "copied"),
            Work::Blit(it) => self.transfer(work, &it.source, &it.target, &format!("scaled {:?}", it.filter)),
            Work::Fill(fill) => {
                let target = uses::of(work)[0];
                let whole = self.whole(&fill.target);
                let value = format!("{:?}", fill.value);
                self.write(&target, |_, old| filled(Some(number(&value)), old, whole));
            }
            Work::Export => {}
        }
    }

    /// Whether a side is all of each part that it names.
    fn whole(&self, side: &Side) -> bool {
        match side {
            Side::Image { image, range, extent, .. } => {
                let all = self.world.plan.image(*image).extent.map(|texels| (texels >> range.base_mip.min(31)).max(1));
                extent.iter().zip(all).all(|(own, all)| *own >= all)
            }
            Side::Buffer { buffer, bytes } => *bytes >= self.world.plan.buffers[buffer.0 as usize].bytes,
        }
    }

    fn transfer(&mut self, work: &Work, source: &Side, target: &Side, how: &str) {
        let uses = uses::of(work);
        // Like parts go to like parts, unless one side is a buffer.
        let values = self.values(&uses[0]);
        let same = self.values(&uses[1]).len() == values.len();
        let all = values.iter().copied().collect::<Option<Vec<u64>>>().map(number);
        let extent = if let Side::Image { extent, .. } = source { *extent } else { [0; 3] };
        let whole = self.whole(target);
        self.write(&uses[1], |place, old| {
            let from = if same { values[place] } else { all.map(|all| number((all, place))) };
            filled(from.map(|value| number((how, extent, value))), old, whole)
        });
    }

    /// The value that a pass reads without attachments, as one number.
    fn reads(&mut self, step: usize, pass: &Pass, uses: Vec<Use>) -> Value {
        let named = |number: usize| {
            let image = pass.accesses.get(number).map(|access| access.binding.as_ref().map(|binding| &binding.name));
            image.unwrap_or_else(|| pass.buffers[number - pass.accesses.len()].binding.as_ref()).cloned()
        };
        let mut all = Some(number(&*pass.name));
        for (at, one) in uses.iter().enumerate() {
            let reads = !(one.accesses - Accesses::WRITES).is_empty() && !matches!(one.kind, Kind::Attachment { .. });
            if reads {
                let value = self.read(step, one);
                all = all.zip(value).map(|(all, value)| number((all, named(at), value)));
            }
        }
        all
    }

    /// Writes of a pass without attachments. Parts that the pass doesn't read are replaced whole.
    fn stores(&mut self, pass: &Pass, read: Value) {
        for (at, one) in uses::of_pass(pass, [0; 2], Kind::Plain).iter().enumerate() {
            if !matches!(one.kind, Kind::Attachment { .. }) && !one.accesses.writes().is_empty() {
                self.write(one, |place, _| read.map(|read| number((read, "store", at, place))));
            }
        }
    }

    fn render(&mut self, step: usize, scope: &RenderScope) {
        for (attachment, _) in uses::attachments(scope) {
            let one = of_attachment(attachment);
            match (attachment.load, attachment.clear) {
                (LoadOp::Load, _) => {}
                (LoadOp::Clear, Some(clear)) => {
                    let value = number(clear.map(f64::to_bits));
                    let whole = self.covers_area(scope, attachment);
                    self.write(&one, |_, old| filled(Some(value), old, whole));
                }
                _ => self.write(&one, |_, _| None),
            }
        }
        for pass in &scope.passes {
            self.draw(step, scope, pass);
        }
        for (attachment, _) in uses::attachments(scope) {
            let one = of_attachment(attachment);
            if let Some(resolve) = &attachment.resolve {
                let values = self.values(&one);
                let target = Use { resource: Resource::Image(resolve.image), range: resolve.range, ..one };
                let how = format!("resolved {:?}", resolve.mode);
                self.write(&target, |place, _| values.get(place).copied().flatten().map(|value| number((&how, value))));
            }
            if attachment.store == StoreOp::DontCare {
                self.write(&one, |_, _| None);
            }
        }
    }

    fn covers_area(&self, scope: &RenderScope, attachment: &Attachment) -> bool {
        let all = self.world.plan.image(attachment.image).extent;
        (0..2).all(|side| scope.extent[side] >= (all[side] >> attachment.range.base_mip.min(31)).max(1))
    }

    fn draw(&mut self, step: usize, scope: &RenderScope, pass: &Pass) {
        let mut read = self.reads(step, pass, uses::of_pass(pass, [0; 2], Kind::Plain));
        let depth = pass.depth.zip(scope.depth());
        let stencil = pass.stencil.zip(scope.stencil());
        let tested = depth.filter(|(state, _)| state.test != CompareOp::Always).map(|(_, attachment)| attachment);
        let stencil_tested =
            stencil.filter(|(state, _)| state.test != CompareOp::Always).map(|(_, attachment)| attachment);
        for attachment in tested.into_iter().chain(stencil_tested) {
            let value = self.read(step, &of_attachment(attachment));
            read = read.zip(value).map(number);
        }
        let fills = pass.draw == Some(Draw::FullScreen) && !pass.discards && pass.untouched.is_none();
        // A triangle may be left out by its face, and all are with both.
        let (faces, mode) = (pass.raster.topology.has_faces(), pass.raster.cull_mode.unwrap_or(CullMode::None));
        let fills = fills && !(faces && mode != CullMode::None);
        let promised = pass.covers && !(faces && mode == CullMode::FrontAndBack);
        let sure = (promised || fills && tested.is_none() && stencil_tested.is_none()) && scope.layers == 1;
        for (location, attachment) in scope.color().iter().enumerate() {
            if !writes(pass, attachment) {
                continue;
            }
            let replaces = pass.blend.get(location).copied().unwrap_or_default() == Blend::Replace;
            let channels = pass.write_masks.get(location).is_none_or(|mask| mask.is_all());
            let covers = sure && replaces && channels && self.covers_area(scope, attachment);
            if !replaces {
                self.read(step, &of_attachment(attachment));
            }
            self.write(&of_attachment(attachment), |place, old| made(read, ("color", location, place), old, covers));
        }
        if let Some((_, attachment)) = depth.filter(|(state, _)| state.write) {
            let covers = sure && self.covers_area(scope, attachment);
            self.write(&of_attachment(attachment), |place, old| made(read, ("depth", 0, place), old, covers));
        }
        if let Some((_, attachment)) = stencil {
            self.write(&of_attachment(attachment), |place, old| made(read, ("stencil", 0, place), old, false));
        }
        self.stores(pass, read);
    }
}

/// Whether a pass draws into an attachment of its scope.
fn writes(pass: &Pass, attachment: &Attachment) -> bool {
    pass.accesses
        .iter()
        .any(|access| access.image == attachment.image && access.accesses.intersects(Accesses::COLOR_ATTACHMENT_WRITE))
}

fn of_attachment(attachment: &Attachment) -> Use {
    Use {
        resource: Resource::Image(attachment.image),
        range: attachment.range,
        layout: Some(attachment.layout),
        stages: Stages::empty(),
        accesses: Accesses::empty(),
        kind: Kind::Load,
        pass: 0,
    }
}

/// The value of a part after all or some of it is set to `value`.
fn filled(value: Value, old: Value, whole: bool) -> Value {
    if whole { value } else { value.zip(old).map(number) }
}

/// The value of a target after a draw.
fn made(read: Value, target: (&str, usize, usize), old: Value, covers: bool) -> Value {
    let made = read.map(|read| number((read, target)));
    if covers { made } else { made.zip(old).map(number) }
}
