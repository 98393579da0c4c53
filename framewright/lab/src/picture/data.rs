//! An image in memory.

use super::texel;
use framewright_graph::vulkan::{Encoding, Format};

/// Why a picture can't be encoded.
#[derive(Debug, thiserror::Error)]
pub enum EncodingError {
    /// Fewer texels than the extent says.
    #[error("it has fewer texels than its size says")]
    TooFew,
    /// An encoding of shares of 1 in a format of something else.
    #[error("its format doesn't hold shares from 0 to 1")]
    NotShares,
    /// OpenEXR holds floating-point numbers and integers.
    #[error("its format holds shares of 1")]
    IsShares,
    /// The PNG encoder's words.
    #[error(transparent)]
    Png(#[from] png::EncodingError),
    /// The OpenEXR encoder's words.
    #[error(transparent)]
    OpenExr(#[from] exr::error::Error),
}

/// An image in memory.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'t> {
    /// Format of the texels.
    pub format: Format,
    /// The encoding of its numbers; `None`: the format's own.
    pub encoding: Option<Encoding>,
    /// Width and height in texels.
    pub extent: [u32; 2],
    /// Rows from the top without padding, in the machine's byte order. Formats of depth and stencil have the depth alone.
    pub bytes: &'t [u8],
}

impl<'t> Picture<'t> {
    /// Its texels.
    pub(super) fn texels(&self) -> Result<impl Iterator<Item = &'t [u8]> + use<'t>, EncodingError> {
        let texels = self.bytes.chunks_exact(texel::bytes(self.format));
        let count = self.extent[0] as usize * self.extent[1] as usize;
        if texels.len() < count { Err(EncodingError::TooFew) } else { Ok(texels.take(count)) }
    }
}
