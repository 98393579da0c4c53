//! Whether copies, blits, resolves and fills are well formed.

use super::layouts::planes;
use super::part_in_use::{made_extent, may_have_another_size, mip_extent};
use super::parts::overlap;
use super::structure::{fill_fits, is_of_file};
use super::work::Check;
use crate::plan::{BufferId, Fill, Image, ImageId, Queue, Side, Transfer};
use crate::vulkan::{Aspects, Component, FillValue, Filter, Format, Layout, Subresources};

/// The side of a transfer that is an image.
#[derive(Debug, Clone, Copy)]
struct ImageSide<'p> {
    image: &'p Image,
    range: Subresources,
    extent: [u32; 3],
}

impl<'p> Check<'_, 'p> {
    pub(super) fn resolve(&mut self, transfer: &'p Transfer) {
        self.moves(transfer, false);
        let Some([source, target]) = self.images(transfer) else { return };
        let (from, to) = (source.image, target.image);
        self.demand(source.extent == target.extent, to.id, "is resolved to in another size");
        self.demand(from.samples > 1, from.id, "is resolved and has one sample");
        self.demand(to.samples == 1, to.id, "is the target of a resolve and multisampled");
        self.demand(to.format == from.format, to.id, "is the target of a resolve from another format");
        self.demand(!from.format.is_depth(), from.id, "holds depth, which only a rendering scope can resolve");
    }

    pub(super) fn blit(&mut self, transfer: &'p Transfer) {
        self.moves(transfer, true);
        let Some([source, target]) = self.images(transfer) else { return };
        let (from, to) = (source.image, target.image);
        for image in [from, to] {
            self.demand(image.samples == 1, image.id, "is blitted and multisampled");
        }
        let components = Component::of(from.format) == Component::of(to.format);
        let alike = components && !from.format.is_depth() && !to.format.is_depth();
        self.demand(alike || from.format == to.format, to.id, "is blitted to from a format of another kind");
        let filtered = transfer.filter == Some(Filter::Linear);
        let nearest = from.format.is_integer() || from.format.is_depth();
        self.demand(!(filtered && nearest), from.id, "has depth or integers, which can't be filtered");
        // The outermost places that are looked up lie half a step of the target's from the edge of the source's part: nearer to
        // the edge than the middle of its outermost texel if the source is enlarged.
        let made = made_extent(from, source.range.base_mip);
        let mixes = (0..3).any(|axis| source.extent[axis] < made[axis] && target.extent[axis] > source.extent[axis]);
        self.demand(!(filtered && mixes), from.id, "is enlarged, and texels beyond the part in use are mixed in");
    }

    pub(super) fn copy(&mut self, transfer: &'p Transfer) {
        self.moves(transfer, false);
        match (transfer.source, transfer.target) {
            (Side::Image { .. }, Side::Image { .. }) => {
                let Some([source, target]) = self.images(transfer) else { return };
                let (from, to) = (source.image, target.image);
                self.demand(source.extent == target.extent, to.id, "is copied to in another size");
                let compressed = from.format.is_compressed() || to.format.is_compressed();
                self.demand(!compressed, to.id, "is copied, and compressed images are only sampled");
                self.demand(to.samples == from.samples, to.id, "is copied to from another sample count");
                let colors = !from.format.is_depth() && !to.format.is_depth();
                let alike = colors && from.format.texel_bytes() == to.format.texel_bytes();
                self.demand(alike || from.format == to.format, to.id, "is copied to from a format of another kind");
            }
            (Side::Buffer { buffer: from, bytes }, Side::Buffer { buffer: to, bytes: written }) => {
                self.buffer_side(from, bytes);
                self.buffer_side(to, written);
                if from == to || bytes != written {
                    self.wrong_buffer(to, "is copied to from itself or in another length");
                }
            }
            (Side::Image { .. }, Side::Buffer { buffer, bytes }) => self.rows(&transfer.source, buffer, bytes, true),
            (Side::Buffer { buffer, bytes }, Side::Image { .. }) => self.rows(&transfer.target, buffer, bytes, false),
        }
    }

    pub(super) fn fill(&mut self, fill: &'p Fill) {
        if let Some(name) = &fill.name {
            self.named(name);
        }
        match fill.target {
            Side::Image { image, .. } => {
                let Some(side) = self.image_side(&fill.target, false) else { return };
                let whole = side.extent == mip_extent(side.image, side.range.base_mip);
                self.demand(whole, image, "is filled in part, which only a copy can");
                self.demand(fill_fits(side.image, &fill.value), image, "is filled with what its format can't hold");
                let single =
                    self.queue == Queue::Graphics || self.queue == Queue::Compute && !side.image.format.is_depth();
                self.demand(single, image, "is filled on a queue that can't");
            }
            Side::Buffer { buffer, bytes } => {
                self.buffer_side(buffer, bytes);
                if !bytes.is_multiple_of(4) || !matches!(fill.value, FillValue::Bits(_)) {
                    self.wrong_buffer(buffer, "is filled with words of 32 bits, to a multiple of 4 bytes");
                }
            }
        }
    }

    /// Checks the parts of a transfer that belong to neither side: its name among passes, and its filter.
    fn moves(&mut self, transfer: &'p Transfer, blit: bool) {
        if let Some(name) = &transfer.name {
            self.named(name);
        }
        if transfer.filter.is_some() != blit {
            self.wrong_step("has a filter exactly if it is a blit");
        }
    }

    /// Both sides of a transfer between images.
    fn images(&mut self, transfer: &'p Transfer) -> Option<[ImageSide<'p>; 2]> {
        let sides = (self.image_side(&transfer.source, true), self.image_side(&transfer.target, false));
        let (Some(source), Some(target)) = sides else {
            self.wrong_step("moves between images what is none");
            return None;
        };
        let (from, to, id) = (source.range, target.range, target.image.id);
        self.demand(from.mips == 1 && to.mips == 1, id, "is transferred with more than one mip level");
        self.demand(from.layers == to.layers, id, "is transferred from another number of layers");
        self.demand(from.aspects == to.aspects, id, "is transferred from another plane");
        self.demand(source.image.id != id || !overlap(from, to), id, "is transferred onto itself");
        Some([source, target])
    }

    fn image_side(&mut self, side: &Side, source: bool) -> Option<ImageSide<'p>> {
        let Side::Image { image, range, extent, layout } = *side else { return None };
        let plan = self.plan;
        let described = plan.image(image);
        let optimal = if source { Layout::TransferSrcOptimal } else { Layout::TransferDstOptimal };
        let fits = layout == optimal || layout == Layout::General;
        let planes = planes(layout, described.format.aspects());
        self.demand(fits && planes.contains(range.aspects), image, "can't be transferred in its layout");
        let all = mip_extent(described, range.base_mip);
        let within = all.iter().zip(&extent).all(|(all, part)| part <= all) && !extent.contains(&0);
        self.demand(within, image, "is transferred beyond its size");
        let earlier = source && may_have_another_size(plan, described);
        self.demand(!earlier, image, "is copied from, and had another size in the frame that made it");
        self.demand(source || !is_of_file(described), image, "is written, and its contents are a file's");
        Some(ImageSide { image: described, range, extent })
    }

    /// Rows of texels in a buffer, to or from an image.
    fn rows(&mut self, side: &Side, buffer: BufferId, bytes: u64, source: bool) {
        self.buffer_side(buffer, bytes);
        let Some(side) = self.image_side(side, source) else { return };
        let id: ImageId = side.image.id;
        self.demand(side.range.mips == 1, id, "is transferred with more than one mip level");
        self.demand(!side.image.format.is_compressed(), id, "is copied, and compressed images are only sampled");
        self.demand(side.image.samples == 1, id, "is copied to or from a buffer and multisampled");
        let Some(texel) = texel_bytes(side.image.format, side.range.aspects) else {
            return self.wrong(id, "is copied to or from a buffer with more than one plane");
        };
        let texels = side.extent.iter().map(|texels| u64::from(*texels)).fold(1, u64::saturating_mul);
        if texels.saturating_mul(u64::from(side.range.layers)).saturating_mul(texel) != bytes {
            self.wrong_buffer(buffer, "takes another number of bytes than the texels beside it");
        }
    }

    fn buffer_side(&mut self, buffer: BufferId, bytes: u64) {
        if bytes == 0 || bytes > self.plan.buffers[buffer.0 as usize].bytes {
            self.wrong_buffer(buffer, "is transferred beyond its size");
        }
    }

    fn wrong_buffer(&mut self, buffer: BufferId, what: &str) {
        self.found.structure(Some(self.id), Some(self.plan.images.len() as u32 + buffer.0), what);
    }
}

/// Bytes of a texel of one plane in a buffer: depth of 24 bits takes 4, stencil 1 (Vulkan, "Copying Data Between Buffers
/// and Images").
fn texel_bytes(format: Format, plane: Aspects) -> Option<u64> {
    match plane {
        Aspects::COLOR => Some(format.texel_bytes()),
        Aspects::STENCIL => Some(1),
        Aspects::DEPTH if format == Format::D16_UNORM => Some(2),
        Aspects::DEPTH => Some(4),
        _ => None,
    }
}
