//! Resolves, copies, blits and fills.

use super::Frame;
use crate::convert::{self, Clear};
use crate::device::Shared;
use ash::vk;
use framewright_graph::frame::EyeForm;
use framewright_graph::plan::{Fill, ImageId, Resource, Side, Subresources, Transfer};
use framewright_graph::vulkan::{Aspects, Filter, Layout};

/// One side of a transfer, on the device.
#[derive(Clone, Copy)]
pub(crate) enum Place {
    /// A part of an image.
    Image { image: vk::Image, range: Subresources, extent: vk::Extent3D, layout: vk::ImageLayout },
    /// The beginning of a buffer.
    Buffer { buffer: vk::Buffer, bytes: u64 },
}

impl Frame<'_> {
    /// Where a side of a transfer is in this frame.
    pub(crate) fn place(&self, side: &Side) -> Place {
        match side {
            Side::Image { image, range, extent, layout } => self.image_place(*image, *range, *extent, *layout),
            Side::Buffer { buffer, bytes } => {
                Place::Buffer { buffer: self.prepared.physical.buffer(*buffer, self.number).raw, bytes: *bytes }
            }
        }
    }

    pub(crate) fn image_place(&self, image: ImageId, range: Subresources, extent: [u32; 3], layout: Layout) -> Place {
        let planned = self.plan.image(image);
        Place::Image {
            image: self.prepared.physical.image(image, self.number).raw,
            range: crate::physical::part(planned, range),
            extent: convert::extent(EyeForm::extent(planned.eyes, extent, planned.rotation)),
            layout: convert::layout(layout),
        }
    }

    pub(super) fn resolve(&self, commands: vk::CommandBuffer, transfer: &Transfer) {
        let (source, target) = (self.place(&transfer.source), self.place(&transfer.target));
        let (
            Place::Image { image, range, extent, layout },
            Place::Image { image: to, range: to_range, layout: to_layout, .. },
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
        unsafe { self.shared.raw.cmd_resolve_image2(commands, &info) };
    }

    pub(super) fn copy(&self, commands: vk::CommandBuffer, transfer: &Transfer) {
        copy_between(self.shared, commands, self.place(&transfer.source), self.place(&transfer.target));
    }

    pub(super) fn blit(&self, commands: vk::CommandBuffer, transfer: &Transfer) {
        let (source, target) = (self.place(&transfer.source), self.place(&transfer.target));
        let (
            Place::Image { image, range, extent, layout },
            Place::Image { image: to, range: to_range, extent: to_extent, layout: to_layout },
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
        unsafe { self.shared.raw.cmd_blit_image2(commands, &info) };
    }

    pub(super) fn fill(&self, commands: vk::CommandBuffer, plan: &Fill) {
        let format = match plan.target.resource() {
            Resource::Image(image) => Some(self.plan.image(image).format),
            Resource::Buffer(_) => None,
        };
        fill(self.shared, commands, self.place(&plan.target), convert::clear(format, plan.value));
    }
}

fn corner(extent: vk::Extent3D) -> vk::Offset3D {
    let at = |texels: u32| i32::try_from(texels).unwrap_or(i32::MAX);
    vk::Offset3D { x: at(extent.width), y: at(extent.height), z: at(extent.depth) }
}

/// Copies one place to another: texel for texel, byte for byte, or texels without gaps to or from a buffer.
pub(crate) fn copy_between(shared: &Shared, commands: vk::CommandBuffer, source: Place, target: Place) {
    let device = &shared.raw;
    match (source, target) {
        (
            Place::Image { image, range, extent, layout },
            Place::Image { image: to, range: to_range, layout: to_layout, .. },
        ) => {
            let regions = [vk::ImageCopy2::default()
                .src_subresource(convert::layers(range))
                .dst_subresource(convert::layers(to_range))
                .extent(extent)];
            let info = vk::CopyImageInfo2::default()
                .src_image(image)
                .src_image_layout(layout)
                .dst_image(to)
                .dst_image_layout(to_layout)
                .regions(&regions);
            // SAFETY: recording outside a scope; both parts exist and are in these layouts.
            unsafe { device.cmd_copy_image2(commands, &info) };
        }
        (Place::Image { image, range, extent, layout }, Place::Buffer { buffer, .. }) => {
            let regions = [rows(range, extent)];
            let info = vk::CopyImageToBufferInfo2::default()
                .src_image(image)
                .src_image_layout(layout)
                .dst_buffer(buffer)
                .regions(&regions);
            // SAFETY: recording outside a scope; the part is in this layout, and the buffer holds its texels.
            unsafe { device.cmd_copy_image_to_buffer2(commands, &info) };
        }
        (Place::Buffer { buffer, .. }, Place::Image { image, range, extent, layout }) => {
            let regions = [rows(range, extent)];
            let info = vk::CopyBufferToImageInfo2::default()
                .src_buffer(buffer)
                .dst_image(image)
                .dst_image_layout(layout)
                .regions(&regions);
            // SAFETY: recording outside a scope; the part is in this layout, and the buffer holds its texels.
            unsafe { device.cmd_copy_buffer_to_image2(commands, &info) };
        }
        (Place::Buffer { buffer, bytes }, Place::Buffer { buffer: to, bytes: to_bytes }) => {
            let regions = [vk::BufferCopy2::default().size(bytes.min(to_bytes))];
            let info = vk::CopyBufferInfo2::default().src_buffer(buffer).dst_buffer(to).regions(&regions);
            // SAFETY: recording outside a scope; both buffers hold as many bytes.
            unsafe { device.cmd_copy_buffer2(commands, &info) };
        }
    }
}

/// A part of an image beside a buffer; of depth and stencil one plane, depth before stencil.
fn rows(range: Subresources, extent: vk::Extent3D) -> vk::BufferImageCopy2<'static> {
    let plane = [Aspects::COLOR, Aspects::DEPTH, Aspects::STENCIL].into_iter().find(|it| range.aspects.contains(*it));
    let range = Subresources { aspects: plane.unwrap_or(range.aspects), ..range };
    vk::BufferImageCopy2::default().image_subresource(convert::layers(range)).image_extent(extent)
}

/// Sets all of a place to a value.
pub(crate) fn fill(shared: &Shared, commands: vk::CommandBuffer, target: Place, value: Clear) {
    let device = &shared.raw;
    match (target, value) {
        (Place::Image { image, range, layout, .. }, Clear::Color(color)) => {
            let ranges = [convert::range(range)];
            // SAFETY: recording outside a scope; the part of this colour image exists and is in this layout.
            unsafe { device.cmd_clear_color_image(commands, image, layout, &color, &ranges) };
        }
        (Place::Image { image, range, layout, .. }, Clear::DepthStencil(value)) => {
            let ranges = [convert::range(range)];
            // SAFETY: recording outside a scope; the part of this depth image exists and is in this layout.
            unsafe { device.cmd_clear_depth_stencil_image(commands, image, layout, &value, &ranges) };
        }
        (Place::Buffer { buffer, bytes }, Clear::Word(word)) => {
            let bytes = bytes.next_multiple_of(4);
            // SAFETY: recording outside a scope; buffers are made of whole words.
            unsafe { device.cmd_fill_buffer(commands, buffer, 0, bytes, word) };
        }
        // A format's clear is of its own kind.
        (Place::Image { .. }, Clear::Word(_)) | (Place::Buffer { .. }, Clear::Color(_) | Clear::DepthStencil(_)) => {}
    }
}
