//! Resolves, copies, blits and fills of a Plan.

use super::frame::Frame;
use crate::base::convert;
use crate::commands::{TransferSide, copy_between, fill};
use ash::vk;
use framewright_graph::plan::{Fill, Resource, Transfer};
use framewright_graph::vulkan::Filter;

impl Frame<'_> {
    pub(super) fn resolve(&self, commands: vk::CommandBuffer, transfer: &Transfer) {
        let (source, target) = (self.side(&transfer.source), self.side(&transfer.target));
        let (
            TransferSide::Image { image, range, extent, layout },
            TransferSide::Image { image: to, range: to_range, layout: to_layout, .. },
        ) = (source, target)
        else {
            return;
        };
        let regions = [vk::ImageResolve2::default()
            .src_subresource(convert::layers(range))
            .dst_subresource(convert::layers(to_range))
            .extent(extent)];
        let info = vk::ResolveImageInfo2::default()
            .src_image(image)
            .src_image_layout(layout)
            .dst_image(to)
            .dst_image_layout(to_layout)
            .regions(&regions);
        // SAFETY: the command buffer is being recorded outside a scope, and both parts exist.
        unsafe { self.gpu.raw.cmd_resolve_image2(commands, &info) };
    }

    pub(super) fn copy(&self, commands: vk::CommandBuffer, transfer: &Transfer) {
        copy_between(self.gpu, commands, self.side(&transfer.source), self.side(&transfer.target));
    }

    pub(super) fn blit(&self, commands: vk::CommandBuffer, transfer: &Transfer) {
        let (source, target) = (self.side(&transfer.source), self.side(&transfer.target));
        let (
            TransferSide::Image { image, range, extent, layout },
            TransferSide::Image { image: to, range: to_range, extent: to_extent, layout: to_layout },
        ) = (source, target)
        else {
            return;
        };
        let regions = [vk::ImageBlit2::default()
            .src_subresource(convert::layers(range))
            .src_offsets([vk::Offset3D::default(), corner(extent)])
            .dst_subresource(convert::layers(to_range))
            .dst_offsets([vk::Offset3D::default(), corner(to_extent)])];
        let info = vk::BlitImageInfo2::default()
            .src_image(image)
            .src_image_layout(layout)
            .dst_image(to)
            .dst_image_layout(to_layout)
            .regions(&regions)
            .filter(convert::filter(transfer.filter.unwrap_or(Filter::Nearest)));
        // SAFETY: the command buffer is being recorded outside a scope, and both parts exist.
        unsafe { self.gpu.raw.cmd_blit_image2(commands, &info) };
    }

    pub(super) fn fill(&self, commands: vk::CommandBuffer, plan: &Fill) {
        let format = match plan.target.resource() {
            Resource::Image(image) => Some(self.plan.image(image).format),
            Resource::Buffer(_) => None,
        };
        fill(self.gpu, commands, self.side(&plan.target), convert::clear(format, plan.value));
    }
}

fn corner(extent: vk::Extent3D) -> vk::Offset3D {
    let at = |texels: u32| i32::try_from(texels).unwrap_or(i32::MAX);
    vk::Offset3D { x: at(extent.width), y: at(extent.height), z: at(extent.depth) }
}
