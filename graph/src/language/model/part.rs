//! Parts of images and buffers that passes access.

use super::references::{BufferRef, ImageRef, ResourceRef};
use crate::frame::Eye;
use crate::ron::Spanned;
use crate::vulkan::Aspects;

/// An image or buffer, or a part of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Part {
    /// An image or a part of it.
    Image(ImagePart),
    /// A buffer.
    Buffer(BufferPart),
}

/// A part of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImagePart {
    /// Which image.
    pub image: ImageRef,
    /// Which mip levels.
    pub mips: Selection,
    /// Which array layers.
    pub layers: Selection,
    /// Which plane; `None`: all that it has.
    pub plane: Option<Spanned<Aspects>>,
    /// How many frames back; `None`: this frame.
    pub previous: Option<Spanned<u32>>,
    /// The eye whose image it is; `None`: the eye that the pass is drawn for.
    pub eye: Option<Spanned<Eye>>,
}

/// A buffer, of this frame or an earlier one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BufferPart {
    /// Which buffer.
    pub buffer: BufferRef,
    /// How many frames back; `None`: this frame.
    pub previous: Option<Spanned<u32>>,
}

/// Some of the mip levels or array layers of an image.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Selection {
    /// The first; `None`: from the beginning.
    pub first: Option<Spanned<u32>>,
    /// How many, [`REMAINING`](crate::vulkan::Subresources::REMAINING) for all further ones; `None`: one, or all if
    /// `first` is `None` too.
    pub count: Option<Spanned<u32>>,
}

impl BufferPart {
    /// All of a buffer.
    #[must_use]
    pub const fn whole(buffer: BufferRef) -> BufferPart {
        BufferPart { buffer, previous: None }
    }
}

impl ImagePart {
    /// All of an image.
    #[must_use]
    pub const fn whole(image: ImageRef) -> ImagePart {
        let all = Selection { first: None, count: None };
        ImagePart { image, mips: all, layers: all, plane: None, previous: None, eye: None }
    }
}

impl Part {
    /// The image or buffer, and where it was named.
    #[must_use]
    pub fn resource(&self) -> ResourceRef {
        match self {
            Part::Image(part) => part.image.into(),
            Part::Buffer(part) => part.buffer.into(),
        }
    }

    /// How many frames back; `None`: this frame.
    #[must_use]
    pub const fn previous(&self) -> Option<Spanned<u32>> {
        match self {
            Part::Image(part) => part.previous,
            Part::Buffer(part) => part.previous,
        }
    }
}
