//! A Plan's images and buffers on a device.

use super::descriptions::{buffer_descriptor, descriptor};
use super::rings::{Period, ResourceRings, Turn};
use crate::base::Error;
use crate::gpu::Gpu;
use crate::memory::{Image, MemoryBlock, MemoryUse, RawBuffer};
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::frame::EyeForm;
use framewright_graph::plan::{self, BufferId, ImageId, Placement, Plan, Resource, Role};
use framewright_graph::vulkan::Usage;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// The images and buffers that a Plan's images and buffers are.
pub(crate) struct PhysicalResources {
    images: Vec<Arc<Image>>,
    buffers: Vec<Arc<RawBuffer>>,
    rings: ResourceRings,
    /// Images and buffers that were taken over from another Plan's executor.
    migrated: HashSet<Resource>,
    /// How far images whose size changes were used by the frame that wrote them last, by their places in `images`.
    used: HashMap<usize, [u32; 3]>,
}

impl PhysicalResources {
    /// Makes the heaps with what is placed in them, and all else with memory of its own.
    pub(crate) fn new(gpu: &Arc<Gpu>, plan: &Plan) -> Result<PhysicalResources, Error> {
        let rings = ResourceRings::new(plan);
        let heaps = heaps(gpu, plan)?;
        let heap = |place: &Placement| heaps[place.heap as usize].clone();
        let images = plan.images.iter().map(|image| {
            let descriptor = descriptor(image);
            let made = match &image.role {
                Role::Transient(place) => Image::new(gpu, &image.name, &descriptor, heap(place), place.offset),
                Role::Persistent { .. } | Role::External { .. } => {
                    let writable = gpu.writable(&descriptor);
                    Image::with_own_memory(gpu, &image.name, &writable)
                }
            };
            made.map(Arc::new)
        });
        let images = images.collect::<Result<_, _>>()?;
        let buffers = plan.buffers.iter().map(|buffer| {
            let descriptor = buffer_descriptor(buffer);
            let made = match &buffer.role {
                Role::Transient(place) => RawBuffer::placed(gpu, &buffer.name, &descriptor, heap(place), place.offset),
                Role::Persistent { .. } | Role::External { .. } => {
                    RawBuffer::persistent(gpu, &buffer.name, &descriptor)
                }
            };
            made.map(Arc::new)
        });
        let buffers = buffers.collect::<Result<_, _>>()?;
        Ok(PhysicalResources { images, buffers, rings, migrated: HashSet::new(), used: HashMap::new() })
    }

    /// The image on the device that stands for a Plan's image in frame `frame`.
    pub(crate) fn image(&self, image: ImageId, frame: u64) -> &Arc<Image> {
        &self.images[self.rings.image(image.0, frame)]
    }

    /// The buffer on the device that stands for a Plan's buffer in frame `frame`.
    pub(crate) fn buffer(&self, buffer: BufferId, frame: u64) -> &Arc<RawBuffer> {
        &self.buffers[self.rings.buffer(buffer.0, frame)]
    }

    /// Width, height and depth of what an image holds in a frame: of a part, if more is allocated. Until a frame has written it, all of it
    /// is alike.
    pub(crate) fn extent(&self, image: &plan::Image, frame: u64) -> [u32; 3] {
        let used = || self.used.get(&self.rings.image(image.id.0, frame)).copied();
        image.allocated.and_then(|_| used()).unwrap_or(image.extent)
    }

    /// The same of a mip level, with both eyes' parts if it holds both.
    pub(crate) fn level(&self, image: &plan::Image, mip: u32, frame: u64) -> [u32; 3] {
        EyeForm::extent(image.eyes, image.level(self.extent(image, frame), mip), image.rotation)
    }

    /// Notes that a frame writes this image as far as the Plan says. Returns whether it held another part before.
    pub(crate) fn write_part(&mut self, image: &plan::Image, frame: u64) -> bool {
        let before = self.extent(image, frame);
        self.used.insert(self.rings.image(image.id.0, frame), image.extent);
        before != image.extent
    }

    /// When the same stand for all of these again.
    pub(crate) fn period(&self, resources: impl IntoIterator<Item = Resource>) -> Period {
        self.rings.period(resources)
    }

    /// What stands for what in a frame, as the program has chosen last.
    pub(crate) fn turn(&self, frame: u64) -> Turn<'_> {
        self.rings.turn(frame)
    }

    /// Whether the program handed in so many for an external image or buffer that there is such a one.
    pub(crate) fn has_choice(&self, resource: Resource, choice: usize) -> bool {
        self.rings.has_choice(resource, choice)
    }

    /// Chooses among what the program handed in for an external image or buffer, if there is such a one.
    pub(crate) fn choose(&mut self, resource: Resource, choice: usize) {
        self.rings.choose(resource, choice);
    }

    /// The number that is chosen among what the program handed in for an external image or buffer.
    pub(crate) fn choice(&self, resource: Resource) -> usize {
        self.rings.choice(resource)
    }

    /// Takes the contents of another Plan's image for the first frame. They have this extent.
    pub(crate) fn migrate_image(&mut self, image: ImageId, from: Arc<Image>, extent: [u32; 3]) {
        self.images[image.0 as usize] = from;
        self.used.insert(image.0 as usize, extent);
        self.migrated.insert(Resource::Image(image));
    }

    /// Takes the contents of another Plan's buffer for the first frame.
    pub(crate) fn migrate_buffer(&mut self, buffer: BufferId, from: Arc<RawBuffer>) {
        self.buffers[buffer.0 as usize] = from;
        self.migrated.insert(Resource::Buffer(buffer));
    }

    /// Whether it has its contents before the first frame already.
    pub(crate) fn is_migrated(&self, resource: Resource) -> bool {
        self.migrated.contains(&resource)
    }

    /// Takes other images for an external one, at least one, and returns those before. The first is chosen. No later frame may use what was
    /// made for the images before.
    pub(super) fn replace_images(&mut self, image: ImageId, by: impl IntoIterator<Item = Image>) -> Vec<Arc<Image>> {
        let resource = Resource::Image(image);
        let (members, count, before) = replace(&mut self.images, self.rings.members(resource), by);
        self.used.retain(|place, _| !members.contains(place));
        self.rings.set_members(resource, members, count);
        before
    }

    /// Takes other buffers for an external one, as [`PhysicalResources::replace_images`] does.
    pub(super) fn replace_buffers(
        &mut self,
        buffer: BufferId,
        by: impl IntoIterator<Item = RawBuffer>,
    ) -> Vec<Arc<RawBuffer>> {
        let resource = Resource::Buffer(buffer);
        let (members, count, before) = replace(&mut self.buffers, self.rings.members(resource), by);
        self.rings.set_members(resource, members, count);
        before
    }
}

/// Puts these in the places `before` of a list, and more at its end. Returns their places, then those that aren't needed any more,
/// which hold the first of these; the number of these; and what the places held before.
fn replace<T>(
    list: &mut Vec<Arc<T>>,
    before: &[usize],
    by: impl IntoIterator<Item = T>,
) -> (Vec<usize>, usize, Vec<Arc<T>>) {
    let held = before.iter().map(|place| list[*place].clone()).collect();
    let (mut places, mut count) = (before.to_vec(), 0);
    for one in by {
        match places.get(count) {
            Some(place) => list[*place] = Arc::new(one),
            None => {
                places.push(list.len());
                list.push(Arc::new(one));
            }
        }
        count += 1;
    }
    for place in &places[count..] {
        list[*place] = list[places[0]].clone();
    }
    (places, count, held)
}

impl Gpu {
    /// `descriptor` as something that can be written by transfers too, where the device has such images.
    fn writable(&self, descriptor: &ImageDescriptor) -> ImageDescriptor {
        let writable = ImageDescriptor { usage: descriptor.usage | Usage::TRANSFER_DST, ..*descriptor };
        let transient = descriptor.usage.contains(Usage::TRANSIENT_ATTACHMENT);
        if !transient && self.can_make(&writable) { writable } else { *descriptor }
    }
}

fn heaps(gpu: &Arc<Gpu>, plan: &Plan) -> Result<Vec<Arc<MemoryBlock>>, Error> {
    let mut of_buffers = vec![false; plan.heaps.len()];
    for buffer in &plan.buffers {
        if let Role::Transient(place) = &buffer.role {
            of_buffers[place.heap as usize] = true;
        }
    }
    let mut heaps = Vec::new();
    for (index, heap) in plan.heaps.iter().enumerate() {
        let lazy = if heap.lazily_allocated { gpu.lazy_types() } else { u32::MAX };
        let requirements = vk::MemoryRequirements {
            size: heap.bytes.max(1),
            alignment: heap.alignment.max(1),
            memory_type_bits: heap.type_bits & lazy,
        };
        let kind = if of_buffers[index] { MemoryUse::Buffers } else { MemoryUse::Images };
        let memory = MemoryBlock::new(gpu, &format!("heap {index}"), requirements, kind);
        heaps.push(Arc::new(memory.map_err(|error| with_parts(error, plan, index))?));
    }
    Ok(heaps)
}

/// The error with the names of what was to lie in a heap.
fn with_parts(mut error: Error, plan: &Plan, heap: usize) -> Error {
    let placed = |name: &str, role: &Role| match role {
        Role::Transient(place) if place.heap as usize == heap => Some((name.to_owned(), place.bytes)),
        _ => None,
    };
    if let Error::OutOfMemory { parts, .. } = &mut error {
        let images = plan.images.iter().filter_map(|image| placed(&image.name, &image.role));
        let buffers = plan.buffers.iter().filter_map(|buffer| placed(&buffer.name, &buffer.role));
        *parts = images.chain(buffers).collect();
    }
    error
}
