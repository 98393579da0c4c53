//! A known mistake, planted to see whether the validation layer is awake: its silence proves something only after that.
//!
//! The mistakes are recorded and never submitted. The layer checks commands as they are recorded, and the device never sees
//! them.

use crate::base::{Error, convert};
use crate::commands::Commands;
use crate::gpu::{Device, Gpu, Message, MessageKind, Severity};
use crate::memory::{Image, ViewShape};
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::plan::Queue;
use framewright_graph::vulkan::{Format, Shape, Sharing, Subresources, Usage};

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

impl Device {
    /// Plants a hazard between two clears, which every layer must report, and one between a clear and a dynamic rendering
    /// attachment, which a layer of the current generation must report.
    ///
    /// # Errors
    /// [`Error::NoValidationLayer`] if the device was opened without validation, [`Error::LayerIsBlind`] if a message is
    /// missing.
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
        let range = Subresources::all(descriptor.format, 1, 1);
        let view = image.view(range, ViewShape::Flat)?;
        let mut commands = Commands::new(&self.gpu, Queue::Graphics)?;
        let mut plant = |hazard: &dyn Fn(vk::CommandBuffer)| {
            let (recorded, messages) = validation.messages.apart(|| {
                commands.record(|buffer| {
                    clear(&self.gpu, buffer, &image);
                    hazard(buffer);
                    Ok(())
                })
            });
            recorded.map(|()| messages)
        };
        let clears = plant(&|buffer| clear(&self.gpu, buffer, &image))?;
        let attachment = plant(&|buffer| render(&self.gpu, buffer, view))?;
        let layer = validation.layer.shown.clone();
        let blind = |planted| Err(Error::LayerIsBlind { layer: layer.clone(), planted });
        if !clears.iter().any(is_hazard) {
            return blind("a clear that doesn't wait for another clear");
        }
        let sees_attachments = attachment.iter().any(is_hazard);
        if validation.layer.current && !sees_attachments {
            return blind("a rendering attachment that doesn't wait for a clear");
        }
        Ok(Canary { layer, sees_attachments, messages: [clears, attachment].concat() })
    }
}

/// Ids differ between generations of the layer; all that are about synchronisation begin alike.
fn is_hazard(message: &Message) -> bool {
    let validation = (message.severity, message.kind) == (Severity::Error, MessageKind::Validation);
    validation && message.id.starts_with("SYNC-HAZARD")
}

fn clear(gpu: &Gpu, commands: vk::CommandBuffer, image: &Image) {
    let layout = vk::ImageLayout::GENERAL;
    let range = convert::range(Subresources::all(image.descriptor.format, 1, 1));
    // SAFETY: the command buffer is being recorded and will never be submitted; the image lives.
    unsafe { gpu.raw.cmd_clear_color_image(commands, image.raw, layout, &vk::ClearColorValue::default(), &[range]) };
}

fn render(gpu: &Gpu, commands: vk::CommandBuffer, view: vk::ImageView) {
    let attachment = [vk::RenderingAttachmentInfo::default()
        .image_view(view)
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
        gpu.raw.cmd_begin_rendering(commands, &info);
        gpu.raw.cmd_end_rendering(commands);
    }
}
