//! Texture files, whose levels and layers are stored as an image's: what they hold, and where it lies.

use super::super::limits::{MOST_BYTES, MOST_SIDE, MOST_TEXELS};
use super::super::words::{damaged, parts};
use super::decode;
use flate2::read::ZlibDecoder;
use framewright_graph::frame::{ColorSpace, TextureFile, TextureInfo, TextureProblem, WantedTexels};
use framewright_graph::vulkan::{Format, Numeric};
use ruzstd::decoding::StreamingDecoder;
use std::io::Read;

/// Bytes at the beginning of a file that hold its header, whatever it is.
pub(super) const HEAD: u64 = 4096;

/// A texture file.
pub(super) struct Container {
    /// The format of its texels.
    pub(super) texels: StoredTexels,
    /// Width, height and depth.
    pub(super) extent: [u32; 3],
    pub(super) mips: u32,
    /// Array layers; of cubes six for each.
    pub(super) layers: u32,
    pub(super) cube: bool,
    /// The colour space that it names.
    pub(super) color_space: Option<ColorSpace>,
    pub(super) place: Place,
}

/// How texels are stored.
#[derive(Clone, Copy)]
pub(super) struct StoredTexels {
    /// The format that an image of them has.
    pub(super) format: Format,
    /// Bytes of a texel in the file, if it lacks a fourth component that the format has.
    pub(super) narrow: Option<u64>,
}

/// Where the texels lie.
pub(super) enum Place {
    /// A block of bytes for each mip level, which holds all layers.
    Levels(Vec<Level>),
    /// Layer after layer from this offset on, each with all of its mip levels.
    Layers(u64),
}

/// The bytes of a mip level.
pub(super) struct Level {
    pub(super) offset: u64,
    pub(super) bytes: u64,
    pub(super) packing: Packing,
}

/// How the bytes of a level are packed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Packing {
    None,
    Zstandard,
    Zlib,
}

impl StoredTexels {
    /// Texels that are stored as images hold them.
    pub(super) const fn whole(format: Format) -> StoredTexels {
        StoredTexels { format, narrow: None }
    }

    /// Texels of `bytes` bytes, of which the first three components count.
    pub(super) const fn of_three(format: Format, bytes: u64) -> StoredTexels {
        StoredTexels { format, narrow: Some(bytes) }
    }

    /// Bytes of texels of this width, height and depth in the file.
    fn bytes(self, extent: [u32; 3]) -> u64 {
        match self.narrow {
            Some(texel) => extent.iter().fold(texel, |bytes, side| bytes.saturating_mul((*side).into())),
            None => self.format.bytes(extent),
        }
    }

    /// Texels of the file as an image holds them.
    fn widened(self, bytes: Vec<u8>) -> Vec<u8> {
        let Some(texel) = self.narrow.and_then(|texel| usize::try_from(texel).ok()) else { return bytes };
        let component = self.format.texel_bytes() as usize / 4;
        let one = one(self.format.numeric(), component);
        let mut wide = Vec::with_capacity(bytes.len() / texel * 4 * component);
        for texel in bytes.chunks_exact(texel) {
            wide.extend_from_slice(&texel[..3 * component]);
            wide.extend_from_slice(&one[..component]);
        }
        wide
    }
}

/// The value 1, as a component of `bytes` bytes stores it.
fn one(numeric: Numeric, bytes: usize) -> [u8; 4] {
    match (numeric, bytes) {
        (Numeric::Unorm | Numeric::Srgb, _) => [0xFF; 4],
        (Numeric::Snorm, 1) => [0x7F, 0, 0, 0],
        (Numeric::Snorm, _) => [0xFF, 0x7F, 0, 0],
        (Numeric::Uint | Numeric::Sint, _) => [1, 0, 0, 0],
        (Numeric::Sfloat | Numeric::Ufloat, 2) => [0, 0x3C, 0, 0],
        (Numeric::Sfloat | Numeric::Ufloat, _) => 1.0_f32.to_le_bytes(),
    }
}

impl Container {
    /// Checks what the header says: images of this size are allowed, and the file, which has `bytes` bytes, holds all texels.
    pub(super) fn check(&self, bytes: u64) -> Result<(), TextureProblem> {
        let [width, height, depth] = self.extent;
        let texels = self.extent.iter().fold(u64::from(self.layers), |all, side| all.saturating_mul((*side).into()));
        if texels == 0 || self.mips == 0 {
            return Err(damaged("it is empty"));
        }
        if width.max(height).max(depth) > MOST_SIDE || texels > MOST_TEXELS || self.all_bytes() > MOST_BYTES {
            return Err(TextureProblem::TooLarge { extent: [width, height], side: MOST_SIDE, texels: MOST_TEXELS });
        }
        if self.mips > width.max(height).max(depth).ilog2() + 1 {
            return Err(damaged(format!("it says that it has {} mip levels, more than its size allows", self.mips)));
        }
        if self.cube && (width != height || depth > 1 || !self.layers.is_multiple_of(6)) {
            return Err(damaged("it says that it is a cube, and its sides aren't square"));
        }
        if depth > 1 && self.layers > 1 {
            return Err(damaged("it says that it has depth and layers"));
        }
        let end = match &self.place {
            Place::Layers(start) => start.saturating_add(self.all_bytes()),
            Place::Levels(levels) => {
                for (level, mip) in levels.iter().zip(0..) {
                    let expected = self.level_bytes(mip);
                    if level.packing == Packing::None && level.bytes != expected {
                        let found = level.bytes;
                        return Err(damaged(format!("mip level {mip} takes {expected} bytes, and it has {found}")));
                    }
                }
                levels.iter().map(|level| level.offset.saturating_add(level.bytes)).max().unwrap_or(0)
            }
        };
        if end > bytes {
            return Err(damaged(format!("it is cut off: it has {bytes} of {end} bytes")));
        }
        Ok(())
    }

    fn extent_at(&self, mip: u32) -> [u32; 3] {
        self.extent.map(|side| side.checked_shr(mip).unwrap_or(0).max(1))
    }

    /// Bytes of one layer of a mip level in the file.
    fn layer_bytes(&self, mip: u32) -> u64 {
        self.texels.bytes(self.extent_at(mip))
    }

    fn level_bytes(&self, mip: u32) -> u64 {
        self.layer_bytes(mip).saturating_mul(self.layers.into())
    }

    fn all_bytes(&self) -> u64 {
        (0..self.mips.min(u32::BITS)).map(|mip| self.level_bytes(mip)).fold(0, u64::saturating_add)
    }

    pub(super) fn info(&self) -> TextureInfo {
        let Container { texels, extent, mips, layers, cube, color_space, .. } = *self;
        TextureInfo { extent, format: texels.format, mips, layers, cube, stored: true, color_space }
    }

    /// The texels of an image, of the whole file.
    pub(super) fn wanted(
        &self,
        bytes: &[u8],
        file: &TextureFile,
        wanted: &WantedTexels,
    ) -> Result<Vec<u8>, TextureProblem> {
        if let Some(named) = self.color_space.filter(|named| *named != file.color_space) {
            return Err(TextureProblem::ColorSpace { named });
        }
        let WantedTexels { format, extent, mips, layers } = *wanted;
        if (extent, mips, layers) != (self.extent, self.mips, self.layers) {
            let found = parts(self.extent, self.mips, self.layers);
            return Err(TextureProblem::Parts { found, expected: parts(extent, mips, layers) });
        }
        let stored = TextureFile { stored: true, ..file.clone() };
        if let Some(why) = self.info().format_problem(&stored, format) {
            return Err(TextureProblem::Format { format, why });
        }
        let mut all = Vec::new();
        for mip in 0..mips {
            let level = self.texels.widened(self.level(bytes, mip)?);
            if format == self.texels.format {
                all.extend(level);
                continue;
            }
            let [width, height, _] = self.extent_at(mip);
            let slice = self.texels.format.bytes([width, height, 1]) as usize;
            for slice in level.chunks_exact(slice) {
                decode::convert(self.texels.format, slice, [width, height], format, &mut all)?;
            }
        }
        Ok(all)
    }

    /// The bytes of a mip level, layer after layer.
    fn level(&self, file: &[u8], mip: u32) -> Result<Vec<u8>, TextureProblem> {
        let expected = self.level_bytes(mip);
        let bytes = match &self.place {
            Place::Levels(levels) => {
                let level = levels.get(mip as usize).ok_or_else(|| damaged("a mip level is missing"))?;
                let packed = part(file, level.offset, level.bytes)?;
                match level.packing {
                    Packing::None => packed.to_vec(),
                    Packing::Zlib => unpacked(ZlibDecoder::new(packed), expected)?,
                    Packing::Zstandard => unpacked(StreamingDecoder::new(packed).map_err(damaged)?, expected)?,
                }
            }
            Place::Layers(start) => {
                let before: u64 = (0..mip).map(|mip| self.layer_bytes(mip)).sum();
                let layer: u64 = (0..self.mips).map(|mip| self.layer_bytes(mip)).sum();
                let layers = (0..u64::from(self.layers)).map(|number| start + number * layer + before);
                let parts: Result<Vec<_>, _> = layers.map(|at| part(file, at, self.layer_bytes(mip))).collect();
                parts?.concat()
            }
        };
        if bytes.len() as u64 != expected {
            return Err(damaged(format!("mip level {mip} takes {expected} bytes, and it has {}", bytes.len())));
        }
        Ok(bytes)
    }
}

/// A part of a file.
fn part(file: &[u8], offset: u64, bytes: u64) -> Result<&[u8], TextureProblem> {
    let range = usize::try_from(offset).ok().zip(usize::try_from(offset.saturating_add(bytes)).ok());
    range.and_then(|(start, end)| file.get(start..end)).ok_or_else(|| damaged("it is cut off"))
}

/// What comes out of a decoder, up to one byte more than is expected.
fn unpacked(decoder: impl Read, expected: u64) -> Result<Vec<u8>, TextureProblem> {
    let mut bytes = Vec::new();
    decoder.take(expected.saturating_add(1)).read_to_end(&mut bytes).map_err(damaged)?;
    Ok(bytes)
}
