//! How much memory images and buffers take on a device that is not here.

use super::{BufferDescriptor, FormatSupport, ImageDescriptor, MemoryModel, MemoryNeeds, MemoryProvider, Profile};
use crate::vulkan::{Aspects, BufferUsage, Format, Shape, Sharing, Usage};

/// Memory needs as a profile estimates them: values that were read from the device, else values of its model.
pub struct MemoryEstimate<'p>(pub &'p Profile);

impl MemoryProvider for MemoryEstimate<'_> {
    fn exact(&self) -> bool {
        false
    }

    fn image(&mut self, descriptor: &ImageDescriptor) -> MemoryNeeds {
        self.0.known(descriptor).unwrap_or_else(|| self.0.memory.image(descriptor))
    }

    fn buffer(&mut self, descriptor: &BufferDescriptor) -> MemoryNeeds {
        self.0.memory.buffer(descriptor)
    }
}

impl Profile {
    /// The memory needs of an image, if they were read from the device.
    fn known(&self, image: &ImageDescriptor) -> Option<MemoryNeeds> {
        let [width, height, depth] = image.extent;
        let usual = image.shape == Shape::D2
            && (depth, image.mips, image.layers) == (1, 1, 1)
            && image.sharing == Sharing::Exclusive;
        if !usual {
            return None;
        }
        let kind = (image.format, image.samples);
        let first = self.known_needs.partition_point(|known| (known.format, known.samples) < kind);
        let of_kind = self.known_needs[first..].iter().take_while(|known| (known.format, known.samples) == kind);
        let known = of_kind.into_iter().find(|known| known.usages.contains(&image.usage))?;
        let at = known.sizes.binary_search_by_key(&[width, height], |(extent, _)| *extent).ok()?;
        Some(known.sizes[at].1)
    }
}

impl MemoryModel {
    /// The memory needs of an image.
    #[must_use]
    pub fn image(&self, image: &ImageDescriptor) -> MemoryNeeds {
        let apart = self.separate_stencil && image.format.aspects().contains(Aspects::DEPTH | Aspects::STENCIL);
        let bytes = match (apart, image.format) {
            (false, format) => self.plane(image, format.texel_bytes()),
            // The depth takes as much as a format of depth alone.
            (true, _) => self.plane(image, 4).saturating_add(self.plane(image, 1)),
        };
        let bytes = bytes.saturating_mul(u64::from(image.layers)).saturating_mul(u64::from(image.samples));
        MemoryNeeds { bytes, alignment: power_of_two(self.alignment), type_bits: self.type_bits }
    }

    /// The memory needs of a buffer. Buffers are made of whole words, since fills write words.
    #[must_use]
    pub fn buffer(&self, buffer: &BufferDescriptor) -> MemoryNeeds {
        let alignment = power_of_two(self.buffer_alignment);
        MemoryNeeds { bytes: padded(buffer.bytes, 4), alignment, type_bits: self.type_bits }
    }

    /// The bytes of one sample of one layer of one plane.
    fn plane(&self, image: &ImageDescriptor, texel_bytes: u64) -> u64 {
        let level = |mip: u32| {
            let [width, height, depth] = image.blocks_at(mip).map(u64::from);
            let row = padded(padded(width, self.row_texels.into()).saturating_mul(texel_bytes), self.row_bytes.into());
            let texels = row.saturating_mul(padded(height, self.rows.into())).saturating_mul(depth);
            padded(texels, self.alignment)
        };
        (0..image.mips.min(u32::BITS)).map(level).fold(0, u64::saturating_add)
    }

    /// Fits the model to a device by asking what columns, rows and depths of texels need.
    #[must_use]
    pub fn fitted(memory: &mut dyn MemoryProvider, formats: &[FormatSupport]) -> MemoryModel {
        /// No tile of texels is longer, and every device has images as long.
        const LONG: u32 = 4096;
        let mut of = |format, [width, height]: [u32; 2], usage| {
            memory.image(&ImageDescriptor {
                format,
                shape: Shape::D2,
                extent: [width, height, 1],
                mips: 1,
                layers: 1,
                samples: 1,
                usage,
                sharing: Sharing::Exclusive,
            })
        };
        let (narrow, wide) = (Format::R8_UNORM, Format::R32G32B32A32_SFLOAT);
        let a_step = |needs: MemoryNeeds, bytes: u64| (needs.bytes / (u64::from(LONG) * bytes)).clamp(1, 1 << 16);
        let column = of(narrow, [1, LONG], Usage::SAMPLED);
        let row = of(wide, [LONG, 1], Usage::SAMPLED);
        let (least, most) = (a_step(column, 1), a_step(of(wide, [1, LONG], Usage::SAMPLED), 1));
        let step = |value: u64| u32::try_from(power_of_two(value)).unwrap_or(1);
        let mut model = MemoryModel {
            alignment: power_of_two(column.alignment),
            row_texels: step(most.div_ceil(wide.texel_bytes())),
            // Where the padding grows with the texel it counts texels alone.
            row_bytes: if most < least * wide.texel_bytes() { step(least) } else { 1 },
            rows: step(a_step(row, wide.texel_bytes())),
            separate_stencil: false,
            buffer_alignment: 1,
            type_bits: column.type_bits,
            heap_bytes: None,
        };
        let both = [Format::D32_SFLOAT_S8_UINT, Format::D24_UNORM_S8_UINT];
        let stencil = formats.iter().find(|support| both.contains(&support.format)).map(|support| support.format);
        if let Some(format) = stencil {
            let extent = [LONG / 4, LONG / 4];
            let needs = of(format, extent, Usage::DEPTH_STENCIL_ATTACHMENT).bytes;
            let texels = u64::from(extent[0]) * u64::from(extent[1]);
            let (beside, apart) = (texels * format.texel_bytes(), texels * 5);
            model.separate_stencil = needs.abs_diff(apart) < needs.abs_diff(beside);
        }
        let buffer = BufferDescriptor { bytes: 1 << 16, usage: BufferUsage::all(), sharing: Sharing::Exclusive };
        model.buffer_alignment = power_of_two(memory.buffer(&buffer).alignment);
        model
    }
}

/// The next power of two, of no more than an offset can be aligned to.
fn power_of_two(value: u64) -> u64 {
    value.clamp(1, 1 << 62).next_power_of_two()
}

/// The next multiple of a power of two, or of the next one.
fn padded(value: u64, to: u64) -> u64 {
    let mask = power_of_two(to) - 1;
    value.saturating_add(mask) & !mask
}
