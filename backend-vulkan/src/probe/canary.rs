//! Known mistakes, planted to see whether the validation layer is awake: its silence proves something only after that. Each of its
//! checks that can be switched off by itself has a mistake of its own.
//!
//! What is recorded is never submitted. The layer checks commands as they are recorded, and objects as they are made, and the device
//! never sees them. The driver sees one mistake: a fence that two threads use at once.

use crate::base::{Error, convert};
use crate::commands::Commands;
use crate::gpu::{Device, Gpu, Message, MessageKind, Messages, Severity, switched_off};
use crate::memory::{Image, MemoryUse, RawBuffer, ViewShape};
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::{Format, Shape, Sharing, Subresources, Usage};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

/// The result of the canary: the validation layer, and its messages about the planted mistakes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Canary {
    /// The layer, in words.
    pub layer: String,
    /// Whether it sees hazards of dynamic rendering attachments. The layer of Debian 12 itself doesn't.
    pub sees_attachments: bool,
    /// The messages of the planted mistakes. They are not among [`Device::messages`].
    pub messages: Vec<Message>,
}

const EXTENT: u32 = 4;

/// What mistakes are made with.
struct CanaryObjects<'g> {
    gpu: &'g Arc<Gpu>,
    messages: &'g Messages,
    /// One for all: older layers take what was recorded into a freed command buffer for the beginning of the next one.
    commands: RefCell<Commands>,
    image: Image,
    view: vk::ImageView,
    /// Nothing may be copied to it.
    buffer: RawBuffer,
}

/// A mistake that every layer must report.
struct Mistake {
    /// The mistake, in words.
    planted: &'static str,
    /// The checks that find it.
    checks: &'static str,
    make: fn(&CanaryObjects<'_>) -> Result<Vec<Message>, Error>,
    /// Whether a message is about it: ids differ between generations of the layer.
    is_told: fn(&Message) -> bool,
}

const MISTAKES: [Mistake; 6] = [
    Mistake {
        planted: "a clear that doesn't wait for another clear",
        checks: "checks of synchronisation",
        make: |it| {
            it.recorded(|commands| {
                it.clear(commands);
                it.clear(commands);
            })
        },
        is_told: is_hazard,
    },
    Mistake {
        planted: "a fill of a buffer that was made for no fill",
        checks: "core checks",
        make: |it| it.recorded(|commands| it.fill(commands, 4)),
        is_told: breaks_a_rule,
    },
    Mistake {
        planted: "a fill of three bytes",
        checks: "checks of parameters",
        make: |it| it.recorded(|commands| it.fill(commands, 3)),
        is_told: |message| breaks_a_rule(message) && message.id.contains("-size-"),
    },
    Mistake {
        planted: "a barrier from a layout in which an image isn't",
        checks: "checks of layouts",
        make: |it| it.recorded(|commands| it.transitions(commands)),
        is_told: |message| breaks_a_rule(message) && message.id.contains("oldLayout"),
    },
    Mistake {
        planted: "a shader whose SPIR-V Vulkan doesn't allow",
        checks: "checks of shaders",
        make: |it| it.shader(),
        // Older layers have no rule's name for what the validator of SPIR-V says.
        is_told: is_validation,
    },
    Mistake {
        planted: "a fence that two threads use at once",
        checks: "checks of threads",
        make: |it| it.two_threads(),
        is_told: |message| message.severity == Severity::Error && message.id.to_lowercase().contains("thread"),
    },
];

impl Device {
    /// Plants mistakes that every layer must report: of synchronisation, parameters, layouts, shaders and threads, and one that only core
    /// checks find. And a hazard between a clear and a dynamic rendering attachment, which a layer of the current generation must report.
    ///
    /// # Errors
    /// [`Error::NoValidationLayer`] if the device was opened without validation, [`Error::LayerIsBlind`] if a message is
    /// missing, [`Error::LayerIsMuted`] if settings in the environment keep it from others.
    pub fn canary(&self) -> Result<Canary, Error> {
        let validation = self.gpu.instance.validation.as_ref();
        let validation = validation.ok_or(Error::NoValidationLayer { layer_path: None })?;
        let descriptor = ImageDescriptor {
            format: Format::R8G8B8A8_UNORM,
            shape: Shape::D2,
            extent: [EXTENT, EXTENT, 1],
            mips: 1,
            layers: 1,
            samples: 1,
            usage: Usage::TRANSFER_DST | Usage::COLOR_ATTACHMENT,
            sharing: Sharing::Exclusive,
        };
        let image = Image::with_own_memory(&self.gpu, "canary", &descriptor)?;
        let view = image.view(Subresources::all(descriptor.format, 1, 1), ViewShape::Flat)?;
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
        let buffer = RawBuffer::new(&self.gpu, "canary", 16, usage, MemoryUse::Buffers)?;
        let commands = RefCell::new(Commands::new(&self.gpu, Queue::Graphics)?);
        let things = CanaryObjects { gpu: &self.gpu, messages: &validation.messages, commands, image, view, buffer };
        let layer = validation.layer.shown.clone();
        let blind = |planted, checks| {
            Err(Error::LayerIsBlind { layer: layer.clone(), planted, checks, settings: switched_off::settings() })
        };
        let mut messages = Vec::new();
        for Mistake { planted, checks, make, is_told } in MISTAKES {
            let said = make(&things)?;
            if !said.iter().any(is_told) {
                return blind(planted, checks);
            }
            messages.extend(said);
        }
        let attachment = things.recorded(|commands| {
            things.clear(commands);
            things.render(commands);
        })?;
        let sees_attachments = attachment.iter().any(is_hazard);
        if validation.layer.current && !sees_attachments {
            return blind("a rendering attachment that doesn't wait for a clear", "checks of synchronisation");
        }
        messages.extend(attachment);
        // What is left out by its name, or by a check that no mistake was planted for.
        let settings = switched_off::muting();
        if !settings.is_empty() {
            return Err(Error::LayerIsMuted { layer, settings });
        }
        Ok(Canary { layer, sees_attachments, messages })
    }
}

fn is_validation(message: &Message) -> bool {
    (message.severity, message.kind) == (Severity::Error, MessageKind::Validation)
}

/// Ids differ between generations of the layer; all that are about synchronisation begin alike.
fn is_hazard(message: &Message) -> bool {
    is_validation(message) && message.id.starts_with("SYNC-HAZARD")
}

fn breaks_a_rule(message: &Message) -> bool {
    is_validation(message) && message.id.starts_with("VUID-")
}

impl CanaryObjects<'_> {
    /// What the layer says while commands are recorded.
    fn recorded(&self, record: impl Fn(vk::CommandBuffer)) -> Result<Vec<Message>, Error> {
        let mut commands = self.commands.borrow_mut();
        let (recorded, messages) = self.messages.apart(|| {
            commands.record(|buffer| {
                record(buffer);
                Ok(())
            })
        });
        recorded.map(|()| messages)
    }

    fn clear(&self, commands: vk::CommandBuffer) {
        let layout = vk::ImageLayout::GENERAL;
        let range = convert::range(Subresources::all(self.image.descriptor.format, 1, 1));
        let black = vk::ClearColorValue::default();
        // SAFETY: the command buffer is being recorded and will never be submitted; the image lives.
        unsafe { self.gpu.raw.cmd_clear_color_image(commands, self.image.raw, layout, &black, &[range]) };
    }

    fn fill(&self, commands: vk::CommandBuffer, bytes: u64) {
        // SAFETY: the command buffer is being recorded and will never be submitted; the buffer lives.
        unsafe { self.gpu.raw.cmd_fill_buffer(commands, self.buffer.raw, 0, bytes, 0) };
    }

    /// Two changes of layout. The second one begins with another layout than the first one ends in.
    fn transitions(&self, commands: vk::CommandBuffer) {
        use vk::ImageLayout as Layout;
        let range = convert::range(Subresources::all(self.image.descriptor.format, 1, 1));
        for (old, new) in
            [(Layout::UNDEFINED, Layout::GENERAL), (Layout::COLOR_ATTACHMENT_OPTIMAL, Layout::TRANSFER_DST_OPTIMAL)]
        {
            let barrier = [vk::ImageMemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
                .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
                .old_layout(old)
                .new_layout(new)
                .image(self.image.raw)
                .subresource_range(range)];
            let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
            // SAFETY: the command buffer is being recorded and will never be submitted; the image lives.
            unsafe { self.gpu.raw.cmd_pipeline_barrier2(commands, &info) };
        }
    }

    fn render(&self, commands: vk::CommandBuffer) {
        let attachment = [vk::RenderingAttachmentInfo::default()
            .image_view(self.view)
            .image_layout(vk::ImageLayout::GENERAL)
            .load_op(vk::AttachmentLoadOp::LOAD)
            .store_op(vk::AttachmentStoreOp::STORE)];
        let extent = vk::Extent2D { width: EXTENT, height: EXTENT };
        let info = vk::RenderingInfo::default()
            .render_area(vk::Rect2D { offset: vk::Offset2D::default(), extent })
            .layer_count(1)
            .color_attachments(&attachment);
        // SAFETY: the command buffer is being recorded and will never be submitted; the view lives.
        unsafe {
            self.gpu.raw.cmd_begin_rendering(commands, &info);
            self.gpu.raw.cmd_end_rendering(commands);
        }
    }

    fn shader(&self) -> Result<Vec<Message>, Error> {
        let info = vk::ShaderModuleCreateInfo::default().code(&PIXEL_CENTER_INTEGER);
        let (made, messages) = self.messages.apart(|| {
            // SAFETY: the module is well formed, and no pipeline is made of it.
            unsafe { self.gpu.raw.create_shader_module(&info, None) }
        });
        // A driver may refuse what the layer must find.
        if let Ok(module) = made {
            // SAFETY: nothing uses it.
            unsafe { self.gpu.raw.destroy_shader_module(module, None) };
        }
        Ok(messages)
    }

    /// A thread waits for a fence that nothing signals, while this one resets it.
    fn two_threads(&self) -> Result<Vec<Message>, Error> {
        let raw = &self.gpu.raw;
        // SAFETY: the device lives.
        let fence = unsafe { raw.create_fence(&vk::FenceCreateInfo::default(), None) };
        let fence = fence.map_err(Error::vulkan("creating a fence"))?;
        let mut all = Vec::new();
        // The other thread may come late to its call: the next time it stays longer.
        for milliseconds in [2_u64, 20, 200, 2000] {
            let is_over = AtomicBool::new(false);
            let waits = || {
                let wait = || {
                    // SAFETY: the fence lives, and nothing signals it, so that the call ends when its time is over. That it is reset
                    // meanwhile breaks Vulkan's rule on purpose: the layer must say so. Drivers clear a flag that isn't set.
                    let _ = unsafe { raw.wait_for_fences(&[fence], true, milliseconds * 1_000_000) };
                };
                let ((), messages) = self.messages.apart(wait);
                is_over.store(true, Ordering::Release);
                messages
            };
            let resets = || {
                while !is_over.load(Ordering::Acquire) {
                    // SAFETY: as above.
                    let _ = unsafe { raw.reset_fences(&[fence]) };
                    thread::yield_now();
                }
            };
            let (waiting, ((), of_this)) = thread::scope(|scope| {
                let other = scope.spawn(waits);
                let here = self.messages.apart(resets);
                (other.join().unwrap_or_default(), here)
            });
            all.extend(waiting.into_iter().chain(of_this).take(1));
            if !all.is_empty() {
                break;
            }
        }
        // SAFETY: nothing uses it any more.
        unsafe { raw.destroy_fence(fence, None) };
        Ok(all)
    }
}

/// A fragment shader that does nothing, and says `PixelCenterInteger`, which Vulkan doesn't allow.
const PIXEL_CENTER_INTEGER: [u32; 35] = [
    0x0723_0203,
    0x0001_0000,
    0,
    5,
    0, // Version 1.0, ids below 5.
    0x0002_0011,
    1, // OpCapability Shader
    0x0003_000e,
    0,
    1, // OpMemoryModel Logical GLSL450
    0x0005_000f,
    4,
    1,
    0x6e69_616d,
    0, // OpEntryPoint Fragment %1 "main"
    0x0003_0010,
    1,
    7, // OpExecutionMode %1 OriginUpperLeft
    0x0003_0010,
    1,
    6, // OpExecutionMode %1 PixelCenterInteger
    0x0002_0013,
    2, // %2 = OpTypeVoid
    0x0003_0021,
    3,
    2, // %3 = OpTypeFunction %2
    0x0005_0036,
    2,
    1,
    0,
    3, // %1 = OpFunction %2 None %3
    0x0002_00f8,
    4,           // %4 = OpLabel
    0x0001_00fd, // OpReturn
    0x0001_0038, // OpFunctionEnd
];
