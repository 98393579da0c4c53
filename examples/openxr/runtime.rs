//! Stands for an OpenXR runtime with one swapchain of its own images. Each function names the calls that it stands for.

use framewright::passes::draw::{EyeSight, Eyes};
use framewright::vulkan::ash::vk;
use framewright::{Device, Scene};

/// The size of an eye's picture, as a runtime recommends it (`xrEnumerateViewConfigurationViews`).
pub(crate) const EYE: [u32; 2] = [320, 180];

/// How a runtime hands images of colour out, and takes them back: stages, accesses and layout.
pub(crate) const HANDED: (vk::PipelineStageFlags2, vk::AccessFlags2, vk::ImageLayout) = (
    vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
    vk::AccessFlags2::COLOR_ATTACHMENT_WRITE,
    vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
);

/// The runtime. Its images outlive what was imported from it.
pub(crate) struct Runtime {
    device: Device,
    layers: u32,
    images: Vec<(vk::Image, vk::DeviceMemory)>,
    acquired: usize,
}

impl Runtime {
    /// `xrCreateSwapchain`, which is told size, format, usage and `arraySize`.
    pub(crate) fn create_swapchain(device: &Device, info: &vk::ImageCreateInfo<'_>) -> Result<Runtime, vk::Result> {
        let raw = device.raw();
        let create = |_| {
            // SAFETY: the device lives, and the image is new.
            unsafe {
                let image = raw.create_image(info, None)?;
                let memory = allocate(device, raw.get_image_memory_requirements(image), false)?;
                raw.bind_image_memory(image, memory, 0)?;
                Ok((image, memory))
            }
        };
        let images = (0..3).map(create).collect::<Result<_, vk::Result>>()?;
        Ok(Runtime { device: device.clone(), layers: info.array_layers, images, acquired: 0 })
    }

    /// `xrEnumerateSwapchainImages`.
    pub(crate) fn images(&self) -> Vec<vk::Image> {
        self.images.iter().map(|(image, _)| *image).collect()
    }

    /// `xrAcquireSwapchainImage` and `xrWaitSwapchainImage`: the number of the next image, which nobody reads any more.
    pub(crate) fn acquire(&mut self) -> usize {
        self.acquired = (self.acquired + 1) % self.images.len();
        self.acquired
    }

    /// `xrLocateViews`: where the eyes are, and what they see.
    pub(crate) fn locate_views(scene: &Scene) -> Eyes {
        // An `XrFovf` has the angles of these tangents, those to the left and down with a minus.
        let up = (f64::from(scene.camera.vertical_fov) * 0.5).tan();
        let across = up * f64::from(EYE[0]) / f64::from(EYE[1]);
        let eye = |x: f64| EyeSight { place: [x, 0.0, 0.0].into(), tangents: Some([across, across, up, up]) };
        Eyes { left: eye(-0.0315), right: eye(0.0315) }
    }

    /// `xrReleaseSwapchainImage`, and `xrEndFrame`, which shows each eye its part of the image: here, side by side.
    pub(crate) fn release_and_show(&self) -> Result<Vec<u8>, vk::Result> {
        let (raw, image, [width, height]) = (self.device.raw(), self.images[self.acquired].0, EYE);
        let color = vk::ImageAspectFlags::COLOR;
        let parts = [0, 1].map(|eye: u32| {
            let (layer, left) = if self.layers == 2 { (eye, 0) } else { (0, (eye * width).cast_signed()) };
            vk::BufferImageCopy::default()
                .buffer_offset(u64::from(eye * width * 4))
                .buffer_row_length(2 * width)
                .image_subresource(
                    vk::ImageSubresourceLayers::default().aspect_mask(color).base_array_layer(layer).layer_count(1),
                )
                .image_offset(vk::Offset3D { x: left, y: 0, z: 0 })
                .image_extent(vk::Extent3D { width, height, depth: 1 })
        });
        let range = vk::ImageSubresourceRange::default().aspect_mask(color).level_count(1).layer_count(self.layers);
        let between = |from: (_, _, _), to: (_, _, _)| {
            let barrier = vk::ImageMemoryBarrier2::default().image(image).subresource_range(range);
            let barrier = barrier.src_stage_mask(from.0).src_access_mask(from.1).old_layout(from.2);
            barrier.dst_stage_mask(to.0).dst_access_mask(to.1).new_layout(to.2)
        };
        let read =
            (vk::PipelineStageFlags2::COPY, vk::AccessFlags2::TRANSFER_READ, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
        let (taken, given) = ([between(HANDED, read)], [between(read, HANDED)]);
        let bytes = u64::from(2 * width * height * 4);
        let info = vk::BufferCreateInfo::default().size(bytes).usage(vk::BufferUsageFlags::TRANSFER_DST);
        // SAFETY: the device lives. The image is as it was released. What is made here is waited for before it is destroyed.
        unsafe {
            let buffer = raw.create_buffer(&info, None)?;
            let memory = allocate(&self.device, raw.get_buffer_memory_requirements(buffer), true)?;
            raw.bind_buffer_memory(buffer, memory, 0)?;
            let family = self.device.graphics_queue_family();
            let pool =
                raw.create_command_pool(&vk::CommandPoolCreateInfo::default().queue_family_index(family), None)?;
            let commands = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
            let commands = raw.allocate_command_buffers(&commands)?[0];
            raw.begin_command_buffer(commands, &vk::CommandBufferBeginInfo::default())?;
            raw.cmd_pipeline_barrier2(commands, &vk::DependencyInfo::default().image_memory_barriers(&taken));
            raw.cmd_copy_image_to_buffer(commands, image, read.2, buffer, &parts);
            raw.cmd_pipeline_barrier2(commands, &vk::DependencyInfo::default().image_memory_barriers(&given));
            raw.end_command_buffer(commands)?;
            let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
            let queue = raw.get_device_queue(family, 0);
            raw.queue_submit2(queue, &[vk::SubmitInfo2::default().command_buffer_infos(&commands)], vk::Fence::null())?;
            raw.queue_wait_idle(queue)?;
            let texels = raw.map_memory(memory, 0, bytes, vk::MemoryMapFlags::empty())?.cast::<u8>();
            let texels = std::slice::from_raw_parts(texels, bytes as usize).to_vec();
            raw.destroy_command_pool(pool, None);
            raw.destroy_buffer(buffer, None);
            raw.free_memory(memory, None);
            Ok(texels)
        }
    }
}

impl Drop for Runtime {
    fn drop(&mut self) {
        for (image, memory) in self.images.drain(..) {
            // SAFETY: what was submitted was waited for, and nobody else has the image.
            unsafe { self.device.raw().destroy_image(image, None) };
            // SAFETY: nothing lies in it any more.
            unsafe { self.device.raw().free_memory(memory, None) };
        }
    }
}

/// Memory as it is needed, which the program can map if it is `mapped`.
///
/// # Safety
/// The needs are of this device.
unsafe fn allocate(
    device: &Device,
    needs: vk::MemoryRequirements,
    mapped: bool,
) -> Result<vk::DeviceMemory, vk::Result> {
    let (instance, physical) = device.raw_physical();
    // SAFETY: both live.
    let memory = unsafe { instance.get_physical_device_memory_properties(physical) };
    let host = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
    let wanted = if mapped { host } else { vk::MemoryPropertyFlags::empty() };
    let fits = |(number, ty): &(u32, &vk::MemoryType)| {
        needs.memory_type_bits >> number & 1 == 1 && ty.property_flags.contains(wanted)
    };
    let (number, _) = (0..).zip(&memory.memory_types).find(fits).ok_or(vk::Result::ERROR_OUT_OF_DEVICE_MEMORY)?;
    let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(number);
    // SAFETY: the device lives, and has the type.
    unsafe { device.raw().allocate_memory(&info, None) }
}
