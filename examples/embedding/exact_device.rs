use framewright::vulkan::AdoptedDevice;
use framewright::vulkan::ash::{self, vk};
use framewright::{Device, Renderer, RendererOptions, Scene, SceneDrawSource, Texels};
use std::error::Error;

/// Draws a scene on a device of the program's that is made with exactly what the pipeline's frames use.
pub(crate) fn draw(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    scene: &Scene,
) -> Result<Texels, Box<dyn Error>> {
    // What frames use is known before the program has a device: they are planned on another one.
    // SAFETY: the physical device belongs to the instance, which is one of Vulkan 1.3 and lives longer.
    let planning = unsafe { Device::open_physical(instance, &[], physical, None)? };
    let family = planning.graphics_queue_family();
    let mut planned = renderer(&planning, scene)?;
    for feature in planned.features()? {
        println!("{} for {}", feature.name, feature.by);
    }
    let mut exact = planned.device_features()?;
    drop((planned, planning));
    let extensions = exact.extensions().to_vec();
    let pointers: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    let mut features = exact.chain();
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
    let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&pointers);
    // SAFETY: the physical device has the family, the features and the extensions.
    let raw = unsafe { instance.create_device(physical, &info.push_next(&mut features), None)? };
    let program = AdoptedDevice {
        instance,
        instance_extensions: &[],
        physical,
        device: &raw,
        device_extensions: &extensions,
        features: &features,
        // SAFETY: the device was created with a queue of this family.
        queues: &[(family, unsafe { raw.get_device_queue(family, 0) })],
        allocator: None,
    };
    let drawn = {
        // SAFETY: all of it belongs together, and lives until everything that is made from the adopted device is gone.
        let exact = unsafe { Device::adopt(&program, None)? };
        let mut renderer = renderer(&exact, scene)?;
        let mut objects = SceneDrawSource::for_plan(&exact, scene, [64, 36], renderer.prepare()?.plan)?;
        renderer.frame(&mut objects)?;
        renderer.read("screen")?
    };
    // SAFETY: nothing made from the device is left.
    unsafe { raw.destroy_device(None) };
    Ok(drawn)
}

fn renderer(device: &Device, scene: &Scene) -> Result<Renderer, framewright::Error> {
    let mut renderer = Renderer::open(device, "forward", RendererOptions::default())?;
    renderer.set_scene(scene);
    renderer.set_extent([64, 36])?;
    Ok(renderer)
}
