//! The encoding of a picture that leaves the frame: the meaning of its numbers.

use super::{Format, Numeric};
use serde::{Deserialize, Serialize};

/// The meaning of a picture's numbers to a screen or a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Encoding {
    /// Primaries of Rec. 709, encoded with the sRGB curve (IEC 61966-2-1): by the format, or by a shader into a UNORM one.
    Srgb,
    /// Shares from 0 to 1 as they are, without any curve.
    Unorm,
    /// Linear light with the primaries of Rec. 709, in floating point.
    Linear,
    /// Primaries of Rec. 2020, encoded with the curve of SMPTE ST 2084, by a shader: 1 is 10,000 cd/m².
    Hdr10,
}

impl Encoding {
    /// The encoding that a format implies; `None` where the format leaves it open (UNORM) or holds no colour.
    #[must_use]
    pub const fn of(format: Format) -> Option<Encoding> {
        match format.numeric() {
            _ if format.is_depth() => None,
            Numeric::Srgb => Some(Encoding::Srgb),
            Numeric::Sfloat | Numeric::Ufloat => Some(Encoding::Linear),
            Numeric::Unorm | Numeric::Snorm | Numeric::Uint | Numeric::Sint => None,
        }
    }

    /// Whether a format can hold the encoding.
    #[must_use]
    pub const fn fits(self, format: Format) -> bool {
        let unorm = matches!(format.numeric(), Numeric::Unorm) && !format.is_depth();
        match self {
            Encoding::Srgb => matches!(format.numeric(), Numeric::Srgb) || unorm,
            Encoding::Unorm => unorm,
            Encoding::Linear => matches!(Encoding::of(format), Some(Encoding::Linear)),
            Encoding::Hdr10 => {
                matches!(format, Format::A2B10G10R10_UNORM_PACK32 | Format::R16G16B16A16_UNORM)
            }
        }
    }

    /// The formats that can hold it, in words.
    #[must_use]
    pub const fn formats(self) -> &'static str {
        match self {
            Encoding::Srgb => "an _SRGB format, or a UNORM one that a shader encodes into",
            Encoding::Unorm => "a UNORM format",
            Encoding::Linear => "a floating-point format",
            Encoding::Hdr10 => "A2B10G10R10_UNORM_PACK32 or R16G16B16A16_UNORM",
        }
    }

    /// The help for an image whose format can't hold the encoding.
    pub(crate) fn help(self, image: &str) -> String {
        let format = match self {
            Encoding::Srgb => Format::R8G8B8A8_SRGB,
            Encoding::Unorm => Format::R8G8B8A8_UNORM,
            Encoding::Linear => Format::R16G16B16A16_SFLOAT,
            Encoding::Hdr10 => Format::A2B10G10R10_UNORM_PACK32,
        };
        format!("`{}` takes {}: say `format: {format}` of `{image}`", self.name(), self.formats())
    }

    /// Its name, as pipelines write it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Encoding::Srgb => "Srgb",
            Encoding::Unorm => "Unorm",
            Encoding::Linear => "Linear",
            Encoding::Hdr10 => "Hdr10",
        }
    }
}
