//! A pipeline as owned data: every name is found, every value has its place.

use super::pass::Pass;
use super::references::ResourceRef;
use super::resources::{Buffer, Image, Precisions, Resolves, State};
use super::view::View;
use crate::base::Span;
use crate::frame::Eye;
use crate::ron::Spanned;
use crate::vulkan::Encoding;
use std::sync::Arc;

/// A pipeline with the values of its surroundings put in: flat lists, names unique, every reference found, every expression
/// evaluated, nothing follows itself. Made by [`Document::lower`](crate::language::Document::lower).
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Pipeline {
    /// Views, the main one first; none: one that has the frame's size. A [`ViewIndex`](crate::frame::ViewIndex) is an index
    /// into this list.
    pub views: Vec<View>,
    /// Images; an [`ImageIndex`](crate::frame::ImageIndex) is an index into this list.
    pub images: Vec<Arc<Image>>,
    /// Buffers; a [`BufferIndex`](crate::frame::BufferIndex) is an index into this list.
    pub buffers: Vec<Buffer>,
    /// Passes in the order that gives them meaning.
    pub passes: Vec<Arc<Pass>>,
    /// How several samples of depth become one value, for images without `resolve`; `None`: the depth is drawn again for
    /// passes that sample it.
    pub depth: Option<Resolves>,
    /// The precision of the format `Color`; `None`: [`Precision::Balanced`](super::Precision).
    pub color: Option<Precisions>,
    /// The precision of the formats `Depth` and `DepthStencil`; `None`: [`Precision::Exact`](super::Precision).
    pub depth_format: Option<Precisions>,
    /// Images and buffers that leave the frame.
    pub outputs: Vec<Output>,
    /// Fragments that were put in, each before those within it.
    pub instances: Vec<Instance>,
    /// Passes that a file removed from a pipeline that it extends.
    pub removed: Vec<RemovedPass>,
}

/// A pass that was removed. Messages about images that are not written name it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RemovedPass {
    /// Its name.
    pub name: Arc<str>,
    /// Where it is removed.
    pub span: Span,
    /// Texts in it: names of images and buffers, among others.
    pub texts: Vec<Arc<str>>,
}

/// A fragment that was put in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Instance {
    /// The whole name: `glow`, `effects.glow[1]`. The names of its images, buffers and passes begin with it.
    pub name: Arc<str>,
    /// Where its use is named.
    pub span: Span,
    /// The instance that it is in: an index into [`Pipeline::instances`].
    pub within: Option<u32>,
}

/// An image or buffer that leaves the frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output {
    /// Which one.
    pub resource: ResourceRef,
    /// The state in which it is to be left, if the file asks for one.
    pub after: Option<Spanned<State>>,
    /// The encoding of its numbers, if the file says it.
    pub encoding: Option<Spanned<Encoding>>,
    /// The eye that it belongs to; no file says it.
    pub eye: Option<Eye>,
}
