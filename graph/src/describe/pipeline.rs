//! What a pipeline file says, as owned data: every name is found, every value has its place.

use crate::format;
use crate::frame::{Blend, Draw, ImageIndex};
use crate::source::Span;
use crate::vocabulary::{CompareOp, Filter};
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
    /// Passes in the order that gives them meaning.
    pub passes: Vec<Pass>,
    /// Images that leave the frame.
    pub outputs: Vec<ImageRef>,
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

/// An image.
#[derive(Debug, Clone)]
pub struct Image {
    /// Unique name.
    pub name: Name,
    /// Texel format.
    pub format: Spanned<Format>,
    /// Width and height.
    pub size: Spanned<Size>,
    /// Samples a texel.
    pub samples: Spanned<Samples>,
}

/// A texel format, by purpose or by name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Format {
    /// Colour: `R16G16B16A16_SFLOAT` with high dynamic range, else `R8G8B8A8_SRGB`.
    Color {
        /// Whether values above 1 are kept.
        hdr: Value<bool>,
    },
    /// Depth: `D32_SFLOAT`.
    Depth,
    /// What leaves the frame: `R8G8B8A8_SRGB`.
    Output,
    /// Vulkan's name.
    Named(format::Format),
    /// That of another image.
    Like(ImageRef),
}

/// Width and height of an image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// The frame's.
    Output,
    /// The frame's or another image's, times a factor greater than 0; rounded down, at least 1.
    Scaled {
        /// The factor.
        by: Value<f64>,
        /// Of which image; `None`: of the frame.
        of: Option<ImageRef>,
    },
    /// So many texels, 1 to 16384 each.
    Fixed([u32; 2]),
    /// That of another image.
    Like(ImageRef),
}

/// Samples a texel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Samples {
    /// As many as written here (1, 2, 4, 8 or 16) or as a whole-number setting says.
    Count(Value<u32>),
    /// As another image has.
    Like(ImageRef),
}

/// A pass.
#[derive(Debug, Clone)]
pub struct Pass {
    /// Unique name.
    pub name: Name,
    /// When it runs; `None`: always.
    pub when: Option<Condition>,
    /// What it draws.
    pub draw: Draw,
    /// By which shader.
    pub shader: Name,
    /// Images that its shader samples.
    pub sample: Vec<Sample>,
    /// Colour targets by location.
    pub color: Vec<Color>,
    /// Depth target.
    pub depth: Option<Depth>,
    /// Values for the shader's block `params`.
    pub params: Vec<Param>,
    /// What its target takes instead when it is off.
    pub otherwise: Option<Forward>,
}

/// An image that a shader samples.
#[derive(Debug, Clone)]
pub struct Sample {
    /// The shader's name for it.
    pub binding: Name,
    /// Which image.
    pub image: ImageRef,
    /// Which of its faces.
    pub face: Face,
    /// Filter, if the file chooses one.
    pub filter: Option<Spanned<Filter>>,
}

/// A face of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// Whichever the shader's declaration asks for.
    Plain,
    /// Each sample by itself.
    Samples,
    /// One value a texel.
    Resolved,
}

/// A colour target.
#[derive(Debug, Clone)]
pub struct Color {
    /// Which image.
    pub image: ImageRef,
    /// Clear value (linear red, green, blue, alpha).
    pub clear: Option<[f32; 4]>,
    /// How new colour meets old.
    pub blend: Spanned<Blend>,
}

/// A depth target.
#[derive(Debug, Clone)]
pub struct Depth {
    /// Which image.
    pub image: ImageRef,
    /// Clear value, 0 (infinitely far) to 1.
    pub clear: Option<f32>,
    /// The comparison.
    pub test: CompareOp,
    /// Whether passing fragments write depth.
    pub write: bool,
}

/// A value for a member of the shader's block `params`.
#[derive(Debug, Clone)]
pub struct Param {
    /// The member's name.
    pub name: Name,
    /// Its value.
    pub value: Spanned<ParamValue>,
}

/// A parameter's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParamValue {
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A finite number.
    Number(f64),
    /// A setting's.
    Setting(SettingRef),
}

/// What a target takes when its pass is off: `to` gets what `from` holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Forward {
    /// Source.
    pub from: ImageRef,
    /// Target, one of the pass's own.
    pub to: ImageRef,
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
    /// A fact of the scene.
    Fact(Fact),
}

/// A fact of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fact {
    /// Anything opaque is drawn.
    HasOpaque,
    /// Anything with alpha-clipped holes is drawn.
    HasAlphaClip,
    /// Anything transparent is drawn.
    HasTransparent,
}

impl Fact {
    /// Every fact.
    pub const ALL: [Fact; 3] = [Fact::HasOpaque, Fact::HasAlphaClip, Fact::HasTransparent];

    /// The name that conditions use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Fact::HasOpaque => "scene.has_opaque",
            Fact::HasAlphaClip => "scene.has_alpha_clip",
            Fact::HasTransparent => "scene.has_transparent",
        }
    }
}
