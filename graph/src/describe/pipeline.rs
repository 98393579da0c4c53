//! What a pipeline file says, as owned data: every name is found, every value has its place.

use super::pass::Pass;
use super::resources::{Buffer, Image, State};
use crate::facts::Fact;
use crate::frame::{BufferIndex, ImageIndex, Resource};
use crate::source::Span;
use std::sync::Arc;

/// A pipeline file, read and checked on its own: names are unique, everything that is referred to exists and has the
/// right kind, nothing follows itself. Made by [`crate::describe::read`].
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Pipeline {
    /// What a user may choose.
    pub settings: Vec<Setting>,
    /// Images; an [`ImageIndex`] is an index into this list.
    pub images: Vec<Image>,
    /// Buffers; a [`BufferIndex`] is an index into this list.
    pub buffers: Vec<Buffer>,
    /// Passes in the order that gives them meaning.
    pub passes: Vec<Pass>,
    /// Images and buffers that leave the frame.
    pub outputs: Vec<Output>,
}

/// An image or buffer that leaves the frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output {
    /// Which one.
    pub resource: ResourceRef,
    /// The state in which it is to be left, if the file asks for one.
    pub after: Option<Spanned<State>>,
}

/// A value and where it was written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub span: Span,
}

/// A name and where it was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// The name.
    pub text: Arc<str>,
    /// Where it was written.
    pub span: Span,
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

/// A setting that is referred to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SettingRef {
    /// Index into [`Pipeline::settings`].
    pub index: usize,
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
    /// A finite number.
    Number {
        /// Without a choice.
        default: f64,
        /// Least allowed.
        min: f64,
        /// Greatest allowed.
        max: f64,
    },
    /// A whole number.
    Integer {
        /// Without a choice.
        default: i64,
        /// Least allowed.
        min: i64,
        /// Greatest allowed.
        max: i64,
    },
}

/// A constant, or the value of a setting that has the same type.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value<T> {
    /// Written in place.
    Constant(T),
    /// A setting's.
    Setting(SettingRef),
}

/// When a pass runs: if all terms of any of the groups hold (`a && !b || c`).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Condition {
    /// Groups joined by `||`; the terms of each are joined by `&&`.
    pub any: Vec<Vec<Term>>,
    /// Where it was written.
    pub span: Span,
}

/// A yes-or-no question.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Term {
    /// What is asked.
    pub subject: Subject,
    /// Whether `no` is the answer that lets the pass run.
    pub negated: bool,
}

/// What a condition asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// A setting that is `true` or `false`.
    Setting(SettingRef),
    /// A fact of the scene that is `true` or `false`.
    Fact(Fact),
}
