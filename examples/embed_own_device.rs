//! Framewright on a device that the program made itself: an engine keeps its own instance, device and queues.
//!
//! `cargo run --package framewright-vulkan --example embed_own_device` writes `out/own_device.png`.

use framewright_graph::base::{self, Root, Sources};
use framewright_graph::vulkan::Rotation;
use framewright_graph::{compile, expand, frame, language};
use framewright_passes::draw::{self, SceneDrawSource};
use framewright_passes::{scene, shipped};
use framewright_vulkan::ash::{self, vk};
use framewright_vulkan::{
    AdoptedDevice, Device, DeviceFeatures, Executor, ExecutorOptions, MINIMUM_VERSION, SemaphorePoint, ShaderLibrary,
};
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

const EXTENT: [u32; 2] = [320, 180];

fn main() -> Result<(), Box<dyn Error>> {
    // The engine's own Vulkan: an instance, a device with what Framewright needs, and a queue.
    // SAFETY: the system's loader is trusted.
    let entry = unsafe { ash::Entry::load()? };
    let application = vk::ApplicationInfo::default().api_version(MINIMUM_VERSION);
    // SAFETY: what the structure points to outlives the call.
    let instance =
        unsafe { entry.create_instance(&vk::InstanceCreateInfo::default().application_info(&application), None)? };
    // SAFETY: the instance lives.
    let physical = unsafe { instance.enumerate_physical_devices()? }.into_iter().next().ok_or("no device")?;
    // SAFETY: the physical device belongs to the instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let draws = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    let family = (0..).zip(&families).find(|(_, family)| family.queue_flags.contains(draws)).ok_or("no queue")?.0;
    // SAFETY: the physical device belongs to the instance, which is one of Vulkan 1.3.
    let mut needed = unsafe { DeviceFeatures::of(&instance, physical)? };
    let extensions = needed.extensions().to_vec();
    let mut features = needed.chain();
    let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
    let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&names);
    let info = info.push_next(&mut features);
    // SAFETY: the physical device has the family, the features and the extensions.
    let raw = unsafe { instance.create_device(physical, &info, None)? };
    // SAFETY: the device was created with a queue of this family.
    let queue = unsafe { raw.get_device_queue(family, 0) };

    let program = AdoptedDevice {
        instance: &instance,
        instance_extensions: &[],
        physical,
        device: &raw,
        device_extensions: &extensions,
        features: &features,
        queues: &[(family, queue)],
        allocator: None,
    };
    // SAFETY: all of it belongs together, and is destroyed below, after everything that was made from the adopted device.
    let device = unsafe { Device::adopt(&program, None)? };
    draw(&device, queue)?;
    drop(device);
    // SAFETY: nothing made from the device or the instance is left.
    unsafe {
        raw.destroy_device(None);
        instance.destroy_instance(None);
    }
    Ok(())
}

/// Draws a scene with a shipped pipeline, layer by layer; `Renderer` does all of it in one.
fn draw(device: &Device, queue: vk::Queue) -> Result<(), Box<dyn Error>> {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    let scene = scene::load(&examples.join("scenes/spheres_and_cubes.ron"))?;
    let file = examples.join("pipelines/forward.ron");
    let mut sources = Sources::default();
    let text = std::fs::read_to_string(&file)?;
    let pipeline = language::read(&mut sources, &file.to_string_lossy(), "forward.ron", text)
        .map_err(|mistakes| base::render(&sources, &mistakes))?;
    let sources = Arc::new(sources);
    let mut shaders = ShaderLibrary::new(vec![Root::new("shaders".into())], shipped::SHADERS, draw::interfaces());
    let profile = device.profile();
    let inputs = expand::Inputs {
        set: &[("msaa".to_owned(), "4".to_owned())],
        facts: scene.facts(),
        facts_known: true,
        output_extent: EXTENT,
        rotation: Rotation::Identity,
        dump: &[],
        device: Some(&profile),
        stereo: frame::Stereo::Off,
        window: None,
    };
    let frame = expand::expand(&pipeline, sources.clone(), &inputs, &mut shaders)
        .map_err(|mistakes| base::render(&sources, &mistakes))?;
    let plan = compile::compile(&frame, &profile, &mut device.memory(), &compile::Options::default())
        .map_err(|mistakes| base::render(&sources, &mistakes))?;
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    record_and_submit(device, queue, &mut executor, &mut SceneDrawSource::new(device, &scene, EXTENT)?)?;
    let texels = executor.read(0)?;
    std::fs::create_dir_all("out")?;
    image::save_buffer("out/own_device.png", &texels.bytes, EXTENT[0], EXTENT[1], image::ExtendedColorType::Rgba8)?;
    println!("drawn by {} with the program's own device; out/own_device.png", device.summary().name);
    Ok(())
}

/// Records a frame into a command buffer of the program's, submits it, and waits for it.
fn record_and_submit(
    device: &Device,
    queue: vk::Queue,
    executor: &mut Executor,
    objects: &mut SceneDrawSource,
) -> Result<(), Box<dyn Error>> {
    let raw = device.raw();
    let mut timeline = vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
    let pool = vk::CommandPoolCreateInfo::default().queue_family_index(device.graphics_queue_family());
    // SAFETY: the device lives. The command buffer is recorded outside of a rendering scope, submitted once, to the queue of its
    // family, and waited for before it is destroyed; the semaphore is signalled as the executor was told.
    unsafe {
        let done = raw.create_semaphore(&vk::SemaphoreCreateInfo::default().push_next(&mut timeline), None)?;
        let pool = raw.create_command_pool(&pool, None)?;
        let commands = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        let commands = raw.allocate_command_buffers(&commands)?[0];
        raw.begin_command_buffer(commands, &vk::CommandBufferBeginInfo::default())?;
        // The engine's own commands may stand before and after.
        let frame = executor.record_into(commands, SemaphorePoint::timeline(done, 1), &[], objects)?;
        raw.end_command_buffer(commands)?;
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
        let signals = [vk::SemaphoreSubmitInfo::default()
            .semaphore(done)
            .value(1)
            .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        let submit = vk::SubmitInfo2::default().command_buffer_infos(&commands).signal_semaphore_infos(&signals);
        raw.queue_submit2(queue, &[submit], vk::Fence::null())?;
        executor.wait(frame)?;
        raw.destroy_command_pool(pool, None);
        raw.destroy_semaphore(done, None);
    }
    Ok(())
}
