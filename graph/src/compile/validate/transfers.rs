//! Copies, blits and fills: both sides fit together.

use super::pass::Check;
use crate::frame::{Image, Resource, TransferUse, Work};
use crate::vulkan::{Filter, Subresources};

impl Check<'_> {
    #[inline]
    pub(super) fn transfers(&mut self) {
        let is_transfer = self.pass.work.is_transfer();
        if is_transfer || !self.pass.transfers.is_empty() {
            self.check_sides();
        }
    }

    /// Checks both sides of a transfer, and refuses them in passes that are none.
    fn check_sides(&mut self) {
        let pass = self.pass;
        match (&pass.work, &pass.transfers[..]) {
            (Work::Copy, [source, target]) if !source.write && target.write => self.copy(source, target),
            (Work::Blit { filter }, [source, target]) if !source.write && target.write => {
                self.blit(source, target, *filter);
            }
            (Work::Copy | Work::Blit { .. }, _) => self.wrong(pass.span, "needs one source and one target"),
            (Work::Fill { value }, [target]) if target.write => {
                let format = match target.resource {
                    Resource::Image(image) => Some(self.frame.images[image.0 as usize].format),
                    Resource::Buffer(_) => None,
                };
                if let Some(what) = value.problem(format) {
                    self.wrong(pass.span, &format!("fills with {what}"));
                }
            }
            (Work::Fill { .. }, _) => self.wrong(pass.span, "fills one image or buffer"),
            (Work::Custom { .. }, _) => {}
            _ => self.wrong(pass.span, "transfers and is no copy, blit, fill or custom pass"),
        }
    }

    /// The extent of the one mip level that a transfer is about, its layers and its image.
    fn level(&mut self, used: &TransferUse) -> Option<(Subresources, [u32; 3], &Image)> {
        let Resource::Image(image) = used.resource else { return None };
        let image = &self.frame.images[image.0 as usize];
        let part = image.part(used.range);
        Some((part, image.extent_at(part.base_mip), image))
    }

    fn copy(&mut self, source: &TransferUse, target: &TransferUse) {
        let span = self.pass.span;
        let bytes = |side: &TransferUse| match side.resource {
            Resource::Buffer(buffer) => self.frame.buffers[buffer.0 as usize].bytes,
            Resource::Image(_) => 0,
        };
        let buffers = [bytes(source), bytes(target)];
        let from = self.level(source).map(|(part, extent, image)| (part, extent, image.format, image.samples));
        let to = self.level(target).map(|(part, extent, image)| (part, extent, image.format, image.samples));
        let problem = match (from, to) {
            (None, None) if buffers[0] > buffers[1] => Some("copies into a buffer that is too small"),
            (None, None) => None,
            (Some((from, size, format, count)), Some((to, other, target_format, samples))) => {
                let same = format.copies_to(target_format) && size == other && from.layers == to.layers;
                let counts = samples == 1 || samples == count;
                let one = from.mips == 1 && to.mips == 1 && from.aspects == to.aspects && counts;
                (!same || !one).then_some("copies between images that differ in format, size, layers or samples")
            }
            (Some((part, extent, format, samples)), None) | (None, Some((part, extent, format, samples))) => {
                let texels = extent.iter().fold(u64::from(part.layers), |all, side| all.saturating_mul((*side).into()));
                let size = buffers[0].max(buffers[1]);
                if part.mips != 1 || samples > 1 && to.is_some() {
                    Some("copies several mip levels or samples at once")
                } else if let Some(texel) = format.plane_bytes(part.aspects) {
                    let larger = texels.saturating_mul(texel) > size;
                    larger.then_some("copies between a buffer and an image that is larger")
                } else {
                    Some("copies depth with stencil to or from a buffer")
                }
            }
        };
        if let Some(what) = problem {
            self.wrong(span, what);
        }
        self.apart(source, target);
    }

    fn blit(&mut self, source: &TransferUse, target: &TransferUse, filter: Filter) {
        let from = self.level(source).map(|(part, _, image)| (part, image.format, image.samples));
        let to = self.level(target).map(|(part, _, image)| (part, image.format, image.samples));
        let fits = match (from, to) {
            (Some((from, format, samples)), Some((to, target_format, target_samples))) => {
                let counts = (from.mips, to.mips, samples, target_samples) == (1, 1, 1, 1);
                counts && from.layers == to.layers && format.blits_to(target_format)
            }
            _ => false,
        };
        if !fits {
            self.wrong(self.pass.span, "blits between what is not two images of one kind with one sample");
        }
        if let Resource::Image(image) = source.resource
            && filter == Filter::Linear
            && self.frame.images[image.0 as usize].allocated.is_some()
        {
            let what = "scales an image of which a frame uses a part with a linear filter: texels beyond are mixed in";
            self.wrong(source.span, what);
        }
        self.apart(source, target);
    }

    /// Source and target of a transfer may be parts of one image that don't overlap.
    fn apart(&mut self, source: &TransferUse, target: &TransferUse) {
        if source.resource != target.resource || source.frames_ago != target.frames_ago {
            return;
        }
        let overlaps = match source.resource {
            Resource::Buffer(_) => true,
            Resource::Image(image) => self.frame.images[image.0 as usize].overlap(source.range, target.range),
        };
        if overlaps {
            self.wrong(self.pass.span, "transfers from and to the same part");
        }
    }
}
