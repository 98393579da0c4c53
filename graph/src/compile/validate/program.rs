//! Frames of programs as they are checked: no file says where a mistake is.

use crate::base::Span;
use crate::frame::check::{Checked, Place};
use crate::frame::{Buffer, BufferIndex, Frame, Image, ImageIndex, Pass};

/// A pass of a program, and its frame.
pub(super) struct OfProgram<'c> {
    pub(super) frame: &'c Frame,
    pub(super) pass: &'c Pass,
}

impl Checked for OfProgram<'_> {
    const OF_FILE: bool = false;

    fn image(&self, index: ImageIndex) -> Option<&Image> {
        self.frame.images.get(index.0 as usize)
    }

    fn buffer(&self, index: BufferIndex) -> Option<&Buffer> {
        self.frame.buffers.get(index.0 as usize)
    }

    fn span(&self, place: Place) -> Span {
        let found = match place {
            Place::Image(image, _) => self.image(image).map(|image| image.span),
            Place::Buffer(buffer) => self.buffer(buffer).map(|buffer| buffer.span),
            Place::Side(at) | Place::PartOfSide(at) => self.pass.transfers.get(at).map(|side| side.span),
            Place::Filter => None,
        };
        found.unwrap_or(self.pass.span)
    }
}
