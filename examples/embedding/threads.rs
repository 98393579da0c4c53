use framewright::vulkan::ash::{self, vk};
use framewright::{Device, Draw, DrawSource, Recorder, Renderer, RendererOptions, SecondaryRecorder, Texels, vulkan};
use std::error::Error;
use std::thread;

const PIPELINE: &str = r#"Pipeline(
    version: 1,
    images: [(name: "screen", format: R8G8B8A8_UNORM, size: Output)],
    passes: [(name: "bars", custom: "bars", color: [(image: "screen", clear: (0.0, 0.0, 1.0, 1.0))])],
    outputs: ["screen"],
)"#;

/// A command pool for each thread, with a secondary command buffer.
struct Bars {
    device: Device,
    threads: Vec<(vk::CommandPool, vk::CommandBuffer)>,
}

/// Records the draws of one thread: here, its bar is cleared to white.
fn record(
    raw: &ash::Device,
    commands: vk::CommandBuffer,
    bar: i32,
    mut scope: vk::CommandBufferInheritanceRenderingInfo<'_>,
) -> Result<(), vk::Result> {
    let inherited = vk::CommandBufferInheritanceInfo::default().push_next(&mut scope);
    let flags = vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE;
    let begin = vk::CommandBufferBeginInfo::default().flags(flags).inheritance_info(&inherited);
    let color = vk::ClearValue { color: vk::ClearColorValue { float32: [1.0; 4] } };
    let white =
        vk::ClearAttachment { aspect_mask: vk::ImageAspectFlags::COLOR, color_attachment: 0, clear_value: color };
    let (offset, extent) = (vk::Offset2D { x: 16 * bar, y: 0 }, vk::Extent2D { width: 8, height: 32 });
    let place = vk::ClearRect { rect: vk::Rect2D { offset, extent }, base_array_layer: 0, layer_count: 1 };
    // SAFETY: this thread alone uses the pool of the commands, and the frame before was waited for.
    unsafe {
        raw.begin_command_buffer(commands, &begin)?;
        raw.cmd_clear_attachments(commands, &[white], &[place]);
        raw.end_command_buffer(commands)
    }
}

impl DrawSource for Bars {
    fn record(&mut self, _: Draw, recorder: &mut Recorder<'_>) -> Result<u32, vulkan::Error> {
        Err(vulkan::Error::DrawSource { what: format!("nobody draws `{}`", recorder.pass()) })
    }

    fn has_secondary(&mut self, custom: &str) -> bool {
        custom == "bars"
    }

    fn secondary(&mut self, _: &str, recorder: &mut SecondaryRecorder<'_>) -> Result<u32, vulkan::Error> {
        let raw = self.device.raw();
        let scope = recorder.formats();
        let recorded: Vec<_> = thread::scope(|threads| {
            let begun = (0..).zip(&self.threads);
            let begun = begun
                .map(|(bar, (_, commands))| threads.spawn(move || record(raw, *commands, bar, scope.inheritance())));
            begun.collect::<Vec<_>>().into_iter().map(thread::ScopedJoinHandle::join).collect()
        });
        if !recorded.iter().all(|done| matches!(done, Ok(Ok(())))) {
            return Err(vulkan::Error::DrawSource { what: "a thread recorded nothing".to_owned() });
        }
        let commands: Vec<_> = self.threads.iter().map(|(_, commands)| *commands).collect();
        // SAFETY: they were begun for this scope and ended, and their pools live until the frame was waited for.
        unsafe { recorder.execute(&commands) };
        Ok(1)
    }
}

/// A picture of bars, each of which a thread of its own draws.
pub(crate) fn draw(device: &Device) -> Result<Texels, Box<dyn Error>> {
    let mut renderer = Renderer::carried(device, "bars.ron", PIPELINE, RendererOptions::default())?;
    renderer.set_extent([64, 32])?;
    let raw = device.raw();
    let pool = vk::CommandPoolCreateInfo::default()
        .queue_family_index(device.graphics_queue_family())
        .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
    let mut bars = Bars { device: device.clone(), threads: Vec::new() };
    for _ in 0..4 {
        // SAFETY: the device lives, and the pool is new.
        unsafe {
            let pool = raw.create_command_pool(&pool, None)?;
            let info = vk::CommandBufferAllocateInfo::default().command_pool(pool);
            let info = info.level(vk::CommandBufferLevel::SECONDARY).command_buffer_count(1);
            bars.threads.push((pool, raw.allocate_command_buffers(&info)?[0]));
        }
    }
    renderer.frame(&mut bars)?;
    let texels = renderer.read("screen")?;
    // SAFETY: the frame was waited for.
    bars.threads.iter().for_each(|(pool, _)| unsafe { raw.destroy_command_pool(*pool, None) });
    Ok(texels)
}
