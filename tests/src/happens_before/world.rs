//! The images and buffers that really exist, and which of them a Plan's entries stand for in each frame.

use framewright_graph::plan::{BufferId, ImageId, Plan, Resource, Role};
use framewright_graph::vulkan::{Aspects, State, Subresources};

/// An image or buffer with memory.
#[derive(Debug)]
pub(super) struct Physical {
    /// Name of the Plan's entry for it (with history: the one in the first frame).
    pub(super) name: String,
    /// Heap, first byte and one past the last; `None`: memory of its own.
    pub(super) bytes: Option<(u32, u64, u64)>,
    planes: Vec<Aspects>,
    mips: u32,
    layers: u32,
}

/// All of them, over a number of frames.
pub(super) struct World<'p> {
    pub(super) plan: &'p Plan,
    pub(super) frames: usize,
    /// Whether any step waits for another queue.
    pub(super) several_queues: bool,
    pub(super) physical: Vec<Physical>,
    images: Vec<Vec<usize>>,
    buffers: Vec<Vec<usize>>,
}

/// The role of an entry.
pub(super) fn role(plan: &Plan, resource: Resource) -> &Role {
    match resource {
        Resource::Image(image) => &plan.image(image).role,
        Resource::Buffer(buffer) => &plan.buffers[buffer.0 as usize].role,
    }
}

impl<'p> World<'p> {
    pub(super) fn new(plan: &'p Plan, frames: usize) -> World<'p> {
        let several_queues = plan.steps.iter().any(|step| !step.waits.is_empty());
        let mut world =
            World { plan, frames, several_queues, physical: Vec::new(), images: Vec::new(), buffers: Vec::new() };
        for _ in 0..frames {
            let images = (0..plan.images.len() as u32).map(|image| Resource::Image(ImageId(image))).collect();
            let images = world.next(images, world.images.last().cloned());
            world.images.push(images);
            let buffers = (0..plan.buffers.len() as u32).map(|buffer| Resource::Buffer(BufferId(buffer))).collect();
            let buffers = world.next(buffers, world.buffers.last().cloned());
            world.buffers.push(buffers);
        }
        world
    }

    /// The physical resources of one list's entries in a frame. `before`: those in the frame before.
    fn next(&mut self, entries: Vec<Resource>, before: Option<Vec<usize>>) -> Vec<usize> {
        let mut stand_for = vec![None; entries.len()];
        for (number, entry) in entries.iter().enumerate() {
            match (role(self.plan, *entry), &before) {
                (Role::Persistent { becomes, .. }, Some(before)) => stand_for[*becomes as usize] = Some(before[number]),
                (Role::Transient(_), Some(before)) => stand_for[number] = Some(before[number]),
                _ => {}
            }
        }
        let entries = entries.into_iter().zip(stand_for);
        entries.map(|(entry, there)| there.unwrap_or_else(|| self.add(entry))).collect()
    }

    fn add(&mut self, resource: Resource) -> usize {
        let (name, planes, mips, layers) = match resource {
            Resource::Image(image) => {
                let image = self.plan.image(image);
                (image.name.to_string(), image.format.aspects().iter().collect(), image.mips, image.layers)
            }
            Resource::Buffer(buffer) => {
                (self.plan.buffers[buffer.0 as usize].name.to_string(), vec![Aspects::empty()], 1, 1)
            }
        };
        let bytes = match role(self.plan, resource) {
            Role::Transient(placement) => {
                Some((placement.heap, placement.offset, placement.offset.saturating_add(placement.bytes)))
            }
            _ => None,
        };
        self.physical.push(Physical { name, bytes, planes, mips, layers });
        self.physical.len() - 1
    }

    /// The physical resource that an entry stands for in a frame.
    pub(super) fn physical(&self, frame: usize, resource: Resource) -> usize {
        match resource {
            Resource::Image(image) => self.images[frame][image.0 as usize],
            Resource::Buffer(buffer) => self.buffers[frame][buffer.0 as usize],
        }
    }

    /// The state in which a frame finds an entry that outlives it, if it is new to this world in that frame.
    pub(super) fn arrives(&self, frame: usize, resource: Resource) -> Option<State> {
        match role(self.plan, resource) {
            Role::Persistent { before, .. } => (frame == 0).then_some(*before),
            Role::External { before, .. } => Some(*before),
            Role::Transient(_) => None,
        }
    }

    /// Every image and buffer of the Plan.
    pub(super) fn entries(&self) -> impl Iterator<Item = Resource> + use<> {
        let images = (0..self.plan.images.len() as u32).map(|image| Resource::Image(ImageId(image)));
        images.chain((0..self.plan.buffers.len() as u32).map(|buffer| Resource::Buffer(BufferId(buffer))))
    }

    /// The numbers of all parts of it.
    pub(super) fn all_cells(&self, physical: usize) -> Vec<usize> {
        let Physical { planes, mips, layers, .. } = &self.physical[physical];
        (0..planes.len() * *mips as usize * *layers as usize).collect()
    }

    /// The numbers of the parts of it that are in `range`.
    pub(super) fn cells(&self, physical: usize, range: Subresources) -> Vec<usize> {
        let Physical { planes, mips, layers, .. } = &self.physical[physical];
        let among = |base: u32, count: u32, number: u32| number >= base && number - base < count;
        let mut cells = Vec::new();
        let mut cell = 0;
        for plane in planes {
            for mip in 0..*mips {
                for layer in 0..*layers {
                    let inside = range.aspects.is_empty() || range.aspects.contains(*plane);
                    if inside && among(range.base_mip, range.mips, mip) && among(range.base_layer, range.layers, layer)
                    {
                        cells.push(cell);
                    }
                    cell += 1;
                }
            }
        }
        cells
    }

    /// Whether two different images or buffers have bytes in common.
    pub(super) fn share_bytes(&self, one: usize, other: usize) -> bool {
        match (self.physical[one].bytes, self.physical[other].bytes) {
            (Some((heap, start, end)), Some((second_heap, second_start, second_end))) => {
                one != other && heap == second_heap && start < second_end && second_start < end
            }
            _ => false,
        }
    }
}
