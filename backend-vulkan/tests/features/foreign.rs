//! Images and buffers of the embedding program.

use framewright_graph::vulkan::Format;
use framewright_vulkan::Device;
use framewright_vulkan::ash::vk;

/// Memory of the first type that will do, for an image or buffer that needs it.
fn memory(device: &Device, needs: vk::MemoryRequirements) -> vk::DeviceMemory {
    let info = vk::MemoryAllocateInfo::default()
        .allocation_size(needs.size)
        .memory_type_index(needs.memory_type_bits.trailing_zeros());
    // SAFETY: the device lives and has such a type; the test frees the memory after what is bound to it.
    unsafe { device.raw().allocate_memory(&info, None) }.expect("memory")
}

/// An image of the program's own, of 2 by 2 texels of `R32_UINT`, with every usage that tests ask for.
pub(crate) fn own_image(device: &Device) -> (vk::Image, vk::DeviceMemory) {
    own_image_like(device, Format::R32_UINT, [2, 2])
}

/// An image of the program's own of another format and size.
pub(crate) fn own_image_like(device: &Device, format: Format, size: [u32; 2]) -> (vk::Image, vk::DeviceMemory) {
    own_image_with_layers(device, format, size, 1)
}

/// The same with several layers.
pub(crate) fn own_image_with_layers(
    device: &Device,
    format: Format,
    [width, height]: [u32; 2],
    layers: u32,
) -> (vk::Image, vk::DeviceMemory) {
    let info = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(vk::Format::from_raw(format.vulkan()))
        .extent(vk::Extent3D { width, height, depth: 1 })
        .mip_levels(1)
        .array_layers(layers)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(
            vk::ImageUsageFlags::COLOR_ATTACHMENT
                | vk::ImageUsageFlags::SAMPLED
                | vk::ImageUsageFlags::TRANSFER_SRC
                | vk::ImageUsageFlags::TRANSFER_DST,
        );
    let raw = device.raw();
    // SAFETY: the device lives, and the image is new.
    unsafe {
        let image = raw.create_image(&info, None).expect("an image");
        let memory = memory(device, raw.get_image_memory_requirements(image));
        raw.bind_image_memory(image, memory, 0).expect("it fits");
        (image, memory)
    }
}

/// # Safety
/// Nothing may use the image any more.
pub(crate) unsafe fn destroy_image(device: &Device, (image, memory): (vk::Image, vk::DeviceMemory)) {
    // SAFETY: the caller's promise.
    unsafe {
        device.raw().destroy_image(image, None);
        device.raw().free_memory(memory, None);
    }
}

/// A buffer of the program's own, of three words.
pub(crate) fn own_buffer(device: &Device) -> (vk::Buffer, vk::DeviceMemory) {
    let usage =
        vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    let info = vk::BufferCreateInfo::default().size(12).usage(usage);
    let raw = device.raw();
    // SAFETY: the device lives, and the buffer is new.
    unsafe {
        let buffer = raw.create_buffer(&info, None).expect("a buffer");
        let memory = memory(device, raw.get_buffer_memory_requirements(buffer));
        raw.bind_buffer_memory(buffer, memory, 0).expect("it fits");
        (buffer, memory)
    }
}

/// # Safety
/// Nothing may use the buffer any more.
pub(crate) unsafe fn destroy_buffer(device: &Device, (buffer, memory): (vk::Buffer, vk::DeviceMemory)) {
    // SAFETY: the caller's promise.
    unsafe {
        device.raw().destroy_buffer(buffer, None);
        device.raw().free_memory(memory, None);
    }
}
