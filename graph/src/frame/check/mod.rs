//! The rules of a frame that pipeline files and programs share: shapes of images, targets, raster state, samplers, copies and blits, and
//! contents that must be there. Each is checked here, and put into words here but for contents.
//!
//! `expand` knows where a file says what is wrong. `compile` checks frames of programs, and says which pass is wrong. Values that a
//! format doesn't hold, and what only a program can say wrong, each of them checks by itself.

pub(crate) mod contents;
pub(crate) mod images;
pub(crate) mod raster;
pub(crate) mod samplers;
pub(crate) mod targets;
pub(crate) mod transfers;
pub(crate) mod uses;

use super::{Buffer, BufferIndex, Frame, Image, ImageIndex};
use crate::base::Span;

/// What a pass is checked with: images and buffers, as far as they are known, and the places of mistakes.
pub(crate) trait CheckContext {
    /// Whether it comes from a file. A program may do some things that no file may.
    const OF_FILE: bool;

    /// An image; `None` if it has a mistake of its own.
    fn image(&self, index: ImageIndex) -> Option<&Image>;

    /// A buffer; `None` if it has a mistake of its own.
    fn buffer(&self, index: BufferIndex) -> Option<&Buffer>;

    /// Where something is said.
    fn span(&self, place: Place) -> Span;
}

/// A place of a mistake that only the file knows. The sides of a transfer are its source (0) and its target (1).
#[derive(Debug, Clone, Copy)]
pub(crate) enum Place {
    /// A property of an image, where it is declared.
    Image(ImageIndex, Property),
    /// The mip level or layer of a side, where the pass names it.
    PartOfSide(usize),
    /// The filter of a blit.
    Filter,
}

/// A property of an image.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Property {
    Format,
    Size,
    Shape,
    Mips,
    Layers,
    Samples,
    Lifetime,
}

/// A program's frame stands in no file.
impl CheckContext for Frame {
    const OF_FILE: bool = false;

    fn image(&self, index: ImageIndex) -> Option<&Image> {
        self.images.get(index.0 as usize)
    }

    fn buffer(&self, index: BufferIndex) -> Option<&Buffer> {
        self.buffers.get(index.0 as usize)
    }

    fn span(&self, _: Place) -> Span {
        Span::NONE
    }
}
