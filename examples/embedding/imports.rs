use framewright::vulkan::ash::vk;
use framewright::{Device, Renderer, RendererOptions, Scene, SceneDrawSource, Texels};
use std::error::Error;

/// Draws a scene into an image of the program's own, which takes the place of the pipeline's `screen`.
pub(crate) fn draw(device: &Device, scene: &Scene) -> Result<Texels, Box<dyn Error>> {
    let mut renderer = Renderer::open(device, "forward", RendererOptions::default())?;
    renderer.set_scene(scene);
    renderer.set_extent([64, 36])?;
    let plan = renderer.prepare()?.plan;
    let mut objects = SceneDrawSource::for_plan(device, scene, [64, 36], plan)?;
    let info = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(vk::Format::R8G8B8A8_SRGB)
        .extent(vk::Extent3D { width: 64, height: 36, depth: 1 })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        // What the Plan says that it is used for.
        .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC);
    let raw = device.raw();
    // SAFETY: the device lives, and the image is new.
    let (image, needs) = unsafe {
        let image = raw.create_image(&info, None)?;
        (image, raw.get_image_memory_requirements(image))
    };
    let memory = vk::MemoryAllocateInfo::default()
        .allocation_size(needs.size)
        .memory_type_index(needs.memory_type_bits.trailing_zeros());
    // SAFETY: the device has a memory type that the image may have, and the memory is large enough.
    let memory = unsafe {
        let memory = raw.allocate_memory(&memory, None)?;
        raw.bind_image_memory(image, memory, 0)?;
        memory
    };

    // Another executor, after a change of settings, doesn't know the image: import it again after `Change::Executor`.
    // SAFETY: the image is as the Plan says, lives longer than the renderer, and each frame finds it in any state (`UNDEFINED`).
    unsafe { renderer.executor_mut()?.import_image("screen", image)? };
    renderer.frame(&mut objects)?;
    assert_eq!(renderer.executor_mut()?.raw_image("screen"), Some(image));
    let texels = renderer.read("screen")?;

    drop(renderer);
    // SAFETY: the frame was waited for, and the executor is gone.
    unsafe {
        raw.destroy_image(image, None);
        raw.free_memory(memory, None);
    }
    Ok(texels)
}
