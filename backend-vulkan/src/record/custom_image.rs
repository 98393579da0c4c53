//! Images and buffers of a pass, for commands of the program's own.

use crate::base::convert;
use crate::prepare::{Frame, part};
use ash::vk;
use framewright_graph::frame::{Eye, EyeForm};
use framewright_graph::plan::{self, Access, BufferAccess, Plan};
use framewright_graph::vulkan::{Accesses, Rotation, Stages, Subresources};

/// An image of a pass, for commands of the program's own.
#[derive(Debug, Clone, Copy)]
pub struct CustomImage {
    /// Vulkan's image.
    pub raw: vk::Image,
    /// The part that the pass may touch.
    pub range: Subresources,
    /// Width, height and depth in use, from the first texel on, of the first mip level of that part; where an image changes its
    /// size from frame to frame it is made larger.
    pub extent: [u32; 3],
    /// By how much the picture is turned that it holds, or is to hold; `extent` is that of the turned picture.
    pub rotation: Rotation,
    /// How it holds both eyes' parts, the left one's first: in two layers, which are in `range`, or side by side, of which `extent` is one.
    /// `None`: it is one picture.
    pub eyes: Option<EyeForm>,
    /// The eye whose part alone is meant, of an image that holds both eyes'; `None`: both, or there is one.
    pub eye: Option<Eye>,
    /// The layout that it is in and must be left in.
    pub layout: vk::ImageLayout,
    /// The stages that the barriers wait for: those that the pipeline declares in `uses`, else `ALL_COMMANDS`.
    pub stages: Stages,
    /// The accesses that the pipeline declares. Without `uses` the barriers wait for all that are possible in the layout.
    pub accesses: Accesses,
}

impl CustomImage {
    /// The image that a pass accesses, by the Plan's name or the shader's.
    pub(super) fn of(frame: &Frame<'_>, pass: &plan::Pass, name: &str) -> Option<CustomImage> {
        let plan = frame.plan;
        let access = image_named(plan, pass, name)?;
        Some(CustomImage {
            raw: frame.image(access.image).raw,
            range: part(plan.image(access.image), access.range),
            extent: frame.extent(access.image, access.range.base_mip),
            rotation: plan.image(access.image).rotation,
            eyes: plan.image(access.image).eyes,
            eye: access.eye,
            layout: convert::layout(access.layout),
            stages: access.stages,
            accesses: access.accesses - Accesses::MEMORY_READ - Accesses::MEMORY_WRITE,
        })
    }
}

/// The buffer that a pass accesses, by the Plan's name or the shader's.
pub(super) fn named_buffer(frame: &Frame<'_>, pass: &plan::Pass, name: &str) -> Option<vk::Buffer> {
    Some(frame.buffer(buffer_named(frame.plan, pass, name)?.buffer).raw)
}

/// Whether a pass accesses an image or a buffer of this name, the Plan's or the shader's.
pub(super) fn has_name(plan: &Plan, pass: &plan::Pass, name: &str) -> bool {
    image_named(plan, pass, name).is_some() || buffer_named(plan, pass, name).is_some()
}

fn image_named<'p>(plan: &Plan, pass: &'p plan::Pass, name: &str) -> Option<&'p Access> {
    pass.accesses.iter().find(|it| {
        *plan.image(it.image).name == *name || it.binding.as_ref().is_some_and(|binding| *binding.name == *name)
    })
}

fn buffer_named<'p>(plan: &Plan, pass: &'p plan::Pass, name: &str) -> Option<&'p BufferAccess> {
    let is_named =
        |it: &&BufferAccess| *plan.buffers[it.buffer.0 as usize].name == *name || it.binding.as_deref() == Some(name);
    pass.buffers.iter().find(is_named)
}
