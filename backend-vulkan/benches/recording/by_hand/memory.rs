//! Images at the Plan's places of memory, and buffers that the host writes or reads.

use super::convert;
use ash::vk;
use framewright_graph::plan::{Plan, Role};
use framewright_graph::vulkan::Subresources;
use framewright_vulkan::Device;

/// The images of a Plan, each with a view of all of it.
pub(super) struct Images {
    device: Device,
    pub(super) raw: Vec<vk::Image>,
    pub(super) extents: Vec<vk::Extent3D>,
    pub(super) views: Vec<vk::ImageView>,
    memory: Vec<vk::DeviceMemory>,
}

impl Images {
    pub(super) fn new(device: &Device, plan: &Plan) -> Images {
        let raw = device.raw();
        let heaps = plan.heaps.iter().map(|heap| allocate(device, heap.bytes, heap.type_bits, LOCAL));
        let heaps: Vec<_> = heaps.collect();
        let (mut images, mut extents, mut views, mut memory) = (Vec::new(), Vec::new(), Vec::new(), heaps.clone());
        for image in &plan.images {
            let extent = convert::extent(image.extent);
            let info = vk::ImageCreateInfo::default()
                .image_type(vk::ImageType::TYPE_2D)
                .format(convert::format(image.format))
                .extent(extent)
                .mip_levels(image.mips)
                .array_layers(image.layers)
                .samples(convert::samples(image.samples))
                .usage(convert::usage(image.usage));
            // SAFETY: the Plan was made for this device's own memory needs, so that places fit; memory lives as long as images.
            unsafe {
                let made = raw.create_image(&info, None).expect("an image");
                let (block, offset) = match &image.role {
                    Role::Transient(place) => (heaps[place.heap as usize], place.offset),
                    _ => {
                        let needs = raw.get_image_memory_requirements(made);
                        memory.push(allocate(device, needs.size, needs.memory_type_bits, LOCAL));
                        (memory[memory.len() - 1], 0)
                    }
                };
                raw.bind_image_memory(made, block, offset).expect("an image's memory");
                let range = Subresources::all(image.format, image.mips, image.layers);
                let info = vk::ImageViewCreateInfo::default()
                    .image(made)
                    .view_type(vk::ImageViewType::TYPE_2D)
                    .format(convert::format(image.format))
                    .subresource_range(convert::range(range));
                views.push(raw.create_image_view(&info, None).expect("a view"));
                images.push(made);
                extents.push(extent);
            }
        }
        Images { device: device.clone(), raw: images, extents, views, memory }
    }
}

impl Drop for Images {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: nothing is in flight, and nothing is used again.
        unsafe {
            self.views.iter().for_each(|it| raw.destroy_image_view(*it, None));
            self.raw.iter().for_each(|it| raw.destroy_image(*it, None));
            self.memory.iter().for_each(|it| raw.free_memory(*it, None));
        }
    }
}

const LOCAL: vk::MemoryPropertyFlags = vk::MemoryPropertyFlags::DEVICE_LOCAL;

/// Memory of a type with these properties.
fn allocate(device: &Device, bytes: u64, type_bits: u32, wanted: vk::MemoryPropertyFlags) -> vk::DeviceMemory {
    let (instance, physical) = device.raw_physical();
    // SAFETY: the physical device is the instance's.
    let memory = unsafe { instance.get_physical_device_memory_properties(physical) };
    let mut types = (0..).zip(memory.memory_types_as_slice());
    let found = types.find(|(number, ty)| type_bits & (1 << number) != 0 && ty.property_flags.contains(wanted));
    let info = vk::MemoryAllocateInfo::default().allocation_size(bytes).memory_type_index(found.expect("a type").0);
    // SAFETY: the device has this type.
    unsafe { device.raw().allocate_memory(&info, None) }.expect("memory")
}

/// A buffer that the host sees.
pub(super) struct HostBuffer {
    device: Device,
    pub(super) raw: vk::Buffer,
    memory: vk::DeviceMemory,
    bytes: u64,
}

impl HostBuffer {
    pub(super) fn new(device: &Device, bytes: u64, usage: vk::BufferUsageFlags) -> HostBuffer {
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        let visible = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: the memory is the buffer's alone, and as large as it needs.
        unsafe {
            let raw = device.raw().create_buffer(&info, None).expect("a buffer");
            let needs = device.raw().get_buffer_memory_requirements(raw);
            let memory = allocate(device, needs.size, needs.memory_type_bits, visible);
            device.raw().bind_buffer_memory(raw, memory, 0).expect("a buffer's memory");
            HostBuffer { device: device.clone(), raw, memory, bytes }
        }
    }

    /// A buffer that holds `contents`.
    pub(super) fn with(device: &Device, contents: &[u8], usage: vk::BufferUsageFlags) -> HostBuffer {
        let buffer = HostBuffer::new(device, contents.len() as u64, usage);
        buffer.mapped(|bytes| bytes.copy_from_slice(contents));
        buffer
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        let mut copied = Vec::new();
        self.mapped(|bytes| copied.extend_from_slice(bytes));
        copied
    }

    fn mapped(&self, work: impl FnOnce(&mut [u8])) {
        // SAFETY: the memory is visible to the host, as long as this, and the device doesn't use it now.
        unsafe {
            let flags = vk::MemoryMapFlags::empty();
            let start = self.device.raw().map_memory(self.memory, 0, vk::WHOLE_SIZE, flags).expect("mapped memory");
            work(std::slice::from_raw_parts_mut(start.cast(), self.bytes as usize));
            self.device.raw().unmap_memory(self.memory);
        }
    }
}

impl Drop for HostBuffer {
    fn drop(&mut self) {
        // SAFETY: nothing is in flight.
        unsafe {
            self.device.raw().destroy_buffer(self.raw, None);
            self.device.raw().free_memory(self.memory, None);
        }
    }
}
