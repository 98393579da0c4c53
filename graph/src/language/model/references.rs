//! References of entries: to an image, to a buffer, or to either.

use crate::base::Span;
use crate::frame::{BufferIndex, ImageIndex, Resource};

/// An image that is referred to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImageRef {
    /// Index into [`Pipeline::images`](super::Pipeline::images).
    pub index: ImageIndex,
    /// Where it was named.
    pub span: Span,
}

/// A buffer that is referred to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BufferRef {
    /// Index into [`Pipeline::buffers`](super::Pipeline::buffers).
    pub index: BufferIndex,
    /// Where it was named.
    pub span: Span,
}

/// An image or buffer that is referred to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResourceRef {
    /// Index into [`Pipeline::images`](super::Pipeline::images) or [`Pipeline::buffers`](super::Pipeline::buffers).
    pub resource: Resource,
    /// Where it was named.
    pub span: Span,
}

impl From<ImageRef> for ResourceRef {
    fn from(ImageRef { index, span }: ImageRef) -> ResourceRef {
        ResourceRef { resource: Resource::Image(index), span }
    }
}

impl From<BufferRef> for ResourceRef {
    fn from(BufferRef { index, span }: BufferRef) -> ResourceRef {
        ResourceRef { resource: Resource::Buffer(index), span }
    }
}
