//! What a pipeline file says, as owned data: every name is found, every value has its place.

use super::pass::Pass;
use super::resources::{Buffer, Image, Precisions, Resolves, State};
use super::views::View;
use crate::base::Span;
use crate::frame::{BufferIndex, Eye, ImageIndex, Resource};
use crate::ron::{Name, Spanned};
use crate::vulkan::Encoding;
use std::sync::Arc;

/// A pipeline with all that it was made for put in: flat lists, names unique, every reference found, every expression
/// evaluated, nothing follows itself. Made by [`Document::lower`](super::Document::lower).
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Pipeline {
    /// Views, the main one first; none: one that has the frame's size. A [`ViewIndex`](crate::frame::ViewIndex) is an index
    /// into this list.
    pub views: Vec<View>,
    /// Images; an [`ImageIndex`] is an index into this list.
    pub images: Vec<Image>,
    /// Buffers; a [`BufferIndex`] is an index into this list.
    pub buffers: Vec<Buffer>,
    /// Passes in the order that gives them meaning.
    pub passes: Vec<Pass>,
    /// How several samples of depth become one value, of images that don't say it; `None`: whatever drew it is drawn again
    /// for passes that sample it.
    pub depth: Option<Resolves>,
    /// What `Color` becomes; `None`: [`Precision::Balanced`](super::Precision).
    pub color: Option<Precisions>,
    /// What `Depth` and `DepthStencil` become; `None`: [`Precision::Exact`](super::Precision).
    pub depth_format: Option<Precisions>,
    /// Images and buffers that leave the frame.
    pub outputs: Vec<Output>,
    /// Fragments that were put in, each before those within it.
    pub instances: Vec<Instance>,
    /// Passes that a file removed from a pipeline that it extends.
    pub removed: Vec<RemovedPass>,
}

/// A pass that is no longer there: whoever misses what it wrote is told so.
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
    /// The whole name, which what is in it has before its own: `glow`, `effects.glow[1]`.
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
    /// What its numbers mean, if the file says it.
    pub encoding: Option<Spanned<Encoding>>,
    /// The eye whose it is; no file says it.
    pub eye: Option<Eye>,
}

/// An image that is referred to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImageRef {
    /// Index into [`Pipeline::images`].
    pub index: ImageIndex,
    /// Where it was named.
    pub span: Span,
}

/// A buffer that is referred to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BufferRef {
    /// Index into [`Pipeline::buffers`].
    pub index: BufferIndex,
    /// Where it was named.
    pub span: Span,
}

/// An image or buffer that is referred to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResourceRef {
    /// Index into [`Pipeline::images`] or [`Pipeline::buffers`].
    pub resource: Resource,
    /// Where it was named.
    pub span: Span,
}

/// A value that a user may choose.
#[derive(Debug, Clone)]
pub struct Setting {
    /// Unique name.
    pub name: Name,
    /// Its type, its default and what is allowed.
    pub kind: SettingKind,
    /// What it does, for people.
    pub about: Option<String>,
}

/// A setting's type, default and allowed values. The default is always allowed.
#[derive(Debug, Clone, PartialEq)]
pub enum SettingKind {
    /// `true` or `false`.
    Bool {
        /// Without a choice.
        default: bool,
    },
    /// One of a few whole numbers.
    OneOf {
        /// Without a choice.
        default: i64,
        /// What is allowed; not empty.
        of: Vec<i64>,
    },
    /// One of a few texts.
    Choice {
        /// Without a choice.
        default: Arc<str>,
        /// What is allowed; not empty.
        of: Vec<Arc<str>>,
    },
    /// A finite number.
    Number {
        /// Without a choice.
        default: f64,
        /// Least allowed.
        min: f64,
        /// Greatest allowed.
        max: f64,
        /// The distance from one allowed value to the next, counted from `min`; `None`: all between are allowed.
        step: Option<f64>,
    },
    /// A whole number.
    Integer {
        /// Without a choice.
        default: i64,
        /// Least allowed.
        min: i64,
        /// Greatest allowed.
        max: i64,
        /// The distance from one allowed value to the next, counted from `min`; at least 1.
        step: i64,
    },
}
