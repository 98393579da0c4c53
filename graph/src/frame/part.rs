//! Parts of images: the meaning of a range for one image, and the properties that attachments share.

use super::{EyeForm, Image, allocated_extent, level_extent};
use crate::vulkan::{Aspects, Subresources, extent_at};

/// The properties that all attachments of a pass share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TargetShape {
    /// Width, height and depth of the mip level.
    pub(crate) extent: [u32; 3],
    /// The allocated width and height of the mip level, if its size may change.
    pub(crate) allocated: Option<[u32; 2]>,
    /// How it holds both eyes' parts, if it does.
    pub(crate) eyes: Option<EyeForm>,
    pub(crate) layers: u32,
    pub(crate) samples: u32,
}

/// The allocated width and height of a mip level, if its size may change.
pub(crate) fn allocated_at(extent: [u32; 3], allocated: Option<[u32; 2]>, mip: u32) -> Option<[u32; 2]> {
    let [width, height, _] = extent_at(allocated_extent(extent, Some(allocated?)), mip);
    Some([width, height])
}

impl Image {
    /// Width, height and depth of a mip level in texels: of its part in use, if more is allocated.
    pub(crate) fn extent_at(&self, mip: u32) -> [u32; 3] {
        level_extent(self.extent, self.allocated, mip)
    }

    /// The allocated width and height of a mip level, if its size may change.
    pub(crate) fn allocated_at(&self, mip: u32) -> Option<[u32; 2]> {
        allocated_at(self.extent, self.allocated, mip)
    }

    /// All of it, planes named.
    pub(crate) fn whole(&self) -> Subresources {
        Subresources::all(self.format, self.mips, self.layers)
    }

    /// The part that `range` means: counts without `REMAINING`, planes named.
    pub(crate) fn part(&self, range: Subresources) -> Subresources {
        let count = |count: u32, base: u32, all: u32| {
            if count == Subresources::REMAINING { all.saturating_sub(base) } else { count }
        };
        Subresources {
            aspects: if range.aspects.is_empty() { self.format.aspects() } else { range.aspects },
            base_mip: range.base_mip,
            mips: count(range.mips, range.base_mip, self.mips),
            base_layer: range.base_layer,
            layers: count(range.layers, range.base_layer, self.layers),
        }
    }

    /// The part that a pass samples that names `range`: shaders see one plane, of depth with stencil the depth unless the
    /// range names the stencil alone.
    pub(crate) fn sampled_part(&self, range: Subresources) -> Subresources {
        let both = Aspects::DEPTH | Aspects::STENCIL;
        let plain = self.format.aspects() == both && (range.aspects.is_empty() || range.aspects == both);
        if plain { Subresources { aspects: Aspects::DEPTH, ..range } } else { range }
    }

    /// Whether two ranges of it have a part in common.
    pub(crate) fn overlap(&self, a: Subresources, b: Subresources) -> bool {
        self.part(a).overlaps(self.part(b))
    }

    /// The shape that `range` of the image, one mip level, demands of the attachments beside it.
    pub(crate) fn target_shape(&self, range: Subresources) -> TargetShape {
        let Subresources { base_mip, layers, .. } = self.part(range);
        let Image { eyes, samples, .. } = *self;
        let (extent, allocated) = (self.extent_at(base_mip), self.allocated_at(base_mip));
        TargetShape { extent, allocated, eyes, layers, samples }
    }
}
