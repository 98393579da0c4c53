//! The names of an expression: declared while a file is read, given values when a frame is put together.

use super::types::{Type, Value};
use crate::base::Span;
use crate::frame::ImageIndex;
use crate::vulkan::Format;
use std::fmt;
use std::sync::Arc;

/// The kind of thing that has a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Origin {
    /// A setting, which a user chooses.
    Setting,
    /// A fact of the scene.
    Fact,
    /// A property of the view: its width, its allowances.
    View,
    /// A property of the device.
    Device,
    /// A parameter of a fragment.
    Parameter,
    /// The index of a repetition.
    Index,
    /// An image or a list of images.
    Image,
    /// A buffer or a list of buffers.
    Buffer,
}

impl Origin {
    /// The word in messages.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Origin::Setting => "setting",
            Origin::Fact => "fact",
            Origin::View => "property of the view",
            Origin::Device => "property of the device",
            Origin::Parameter => "parameter",
            Origin::Index => "index",
            Origin::Image => "image",
            Origin::Buffer => "buffer",
        }
    }

    /// Whether its value comes from outside the file, so that messages name it as a cause.
    #[must_use]
    pub const fn decides(self) -> bool {
        matches!(self, Origin::Setting | Origin::Fact | Origin::View | Origin::Device)
    }
}

/// The declaration of a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Symbol {
    /// The number by which [`Values`] knows it.
    pub id: u32,
    /// Its type; of a list, its elements' type.
    pub ty: Type,
    /// Whether it is a list, which takes an index.
    pub list: bool,
    /// The kind of thing.
    pub origin: Origin,
    /// Where it was declared, if a file declares it.
    pub declared: Span,
}

/// The binding of a name in an expression.
#[derive(Debug, Clone, Copy)]
pub(super) enum Bound {
    Symbol(Symbol),
    /// The format that has this name.
    Format(Format),
}

/// The result of a search for a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NameMeaning {
    /// The declaration of the name.
    Symbol(Symbol),
    /// It is declared, but a mistake in its declaration was reported already.
    Reported,
    /// Nothing has this name.
    Unknown,
}

/// The names that an expression may use, without values.
pub trait Declarations {
    /// The declaration of `name`: `levels`, `scene.has_opaque`.
    fn find(&self, name: &str) -> NameMeaning;

    /// Every name, those first that should be suggested first.
    fn names(&self) -> Vec<&str>;

    /// The values that a text can have, if only some can occur: a comparison with any other text is a mistake.
    fn choices(&self, id: u32) -> Option<Vec<&str>> {
        let _ = id;
        None
    }
}

/// A property of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Property {
    /// Width of the largest mip level in texels.
    Width,
    /// Height of the largest mip level in texels.
    Height,
    /// Number of mip levels.
    Mips,
    /// Number of layers.
    Layers,
    /// Samples a texel.
    Samples,
}

/// Why there is no value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MissingValue {
    /// It is only known further below, where this was declared.
    Below(Span),
    /// A mistake that was reported already is in the way.
    Reported,
}

/// The values of names, by the [`Symbol::id`] that [`Declarations`] gave them.
pub trait Values {
    /// The value of a name that is no list.
    ///
    /// # Errors
    /// If there is none, or not yet.
    fn value(&self, id: u32) -> Result<Value, MissingValue>;

    /// How many elements a list has.
    ///
    /// # Errors
    /// If that is not known, or not yet.
    fn length(&self, id: u32) -> Result<u64, MissingValue>;

    /// An element of a list, counted from 0; `at` is less than [`Values::length`].
    ///
    /// # Errors
    /// If there is none, or not yet.
    fn element(&self, id: u32, at: u64) -> Result<Value, MissingValue>;

    /// A property of an image that [`Values::value`] or [`Values::element`] gave.
    ///
    /// # Errors
    /// If it is not known, or not yet.
    fn property(&self, image: ImageIndex, property: Property) -> Result<i64, MissingValue>;

    /// The decisions behind the value of a parameter, which another expression gave.
    fn decided_by(&self, id: u32) -> &[Decision] {
        let _ = id;
        &[]
    }

    /// The decisions behind a property of an image, whose declaration holds expressions itself.
    fn property_decided_by(&self, image: ImageIndex, property: Property) -> &[Decision] {
        let _ = (image, property);
        &[]
    }
}

/// A name whose value decided, written `msaa = 4`.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// The name of a setting, a fact or a property of the view or device.
    pub name: Arc<str>,
    /// The kind of thing that has the name.
    pub origin: Origin,
    /// Its value.
    pub value: Value,
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}", self.name, self.value)
    }
}
