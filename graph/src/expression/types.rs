//! Types of expressions, their values, and the types that a place in a file wants.

use crate::base::shown_number;
use crate::frame::{BufferIndex, ImageIndex};
use crate::vulkan::Format;
use std::fmt;
use std::sync::Arc;

/// The type of an expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Type {
    /// `true` or `false`.
    Bool,
    /// A whole number of 64 bits.
    Integer,
    /// A finite number in double precision.
    Number,
    /// A text, such as the choice of a setting.
    Text,
    /// A texel format.
    Format,
    /// An image of the frame.
    Image,
    /// A buffer of the frame.
    Buffer,
}

impl Type {
    /// The name of one value in messages.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Type::Bool => "`true` or `false`",
            Type::Integer => "a whole number",
            Type::Number => "a number",
            Type::Text => "a text",
            Type::Format => "a format",
            Type::Image => "an image",
            Type::Buffer => "a buffer",
        }
    }

    /// The name of several values in messages.
    #[must_use]
    pub const fn several(self) -> &'static str {
        match self {
            Type::Bool => "truth values",
            Type::Integer => "whole numbers",
            Type::Number => "numbers",
            Type::Text => "texts",
            Type::Format => "formats",
            Type::Image => "images",
            Type::Buffer => "buffers",
        }
    }

    /// Whether it can be calculated with.
    #[must_use]
    pub const fn numeric(self) -> bool {
        matches!(self, Type::Integer | Type::Number)
    }

    /// The type that both have, if any: a whole number meets a number as a number.
    #[must_use]
    pub fn meet(self, other: Type) -> Option<Type> {
        match (self, other) {
            (same, other) if same == other => Some(same),
            (Type::Integer, Type::Number) | (Type::Number, Type::Integer) => Some(Type::Number),
            _ => None,
        }
    }
}

/// The value of an expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// A finite number.
    Number(f64),
    /// A text.
    Text(Arc<str>),
    /// A texel format.
    Format(Format),
    /// An image.
    Image(ImageIndex),
    /// A buffer.
    Buffer(BufferIndex),
}

impl Value {
    /// Its type.
    #[must_use]
    pub const fn ty(&self) -> Type {
        match self {
            Value::Bool(_) => Type::Bool,
            Value::Integer(_) => Type::Integer,
            Value::Number(_) => Type::Number,
            Value::Text(_) => Type::Text,
            Value::Format(_) => Type::Format,
            Value::Image(_) => Type::Image,
            Value::Buffer(_) => Type::Buffer,
        }
    }

    /// The same value in the type `ty`, which is its own or, for a whole number, the wider type. Whole numbers beyond 2^53
    /// become the nearest number in double precision.
    pub(super) fn widened(self, ty: Type) -> Option<Value> {
        match (self, ty) {
            #[allow(clippy::cast_precision_loss, reason = "documented: the nearest number")]
            (Value::Integer(whole), Type::Number) => Some(Value::Number(whole as f64)),
            (value, ty) => (value.ty() == ty).then_some(value),
        }
    }
}

/// As it is shown to people: texts as expressions write them, images and buffers by their index.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Bool(value) => write!(f, "{value}"),
            Value::Integer(value) => write!(f, "{value}"),
            Value::Number(value) => f.write_str(&shown_number(*value)),
            Value::Text(value) => write!(f, "'{value}'"),
            Value::Format(value) => f.write_str(value.name()),
            Value::Image(ImageIndex(index)) => write!(f, "image {index}"),
            Value::Buffer(BufferIndex(index)) => write!(f, "buffer {index}"),
        }
    }
}

/// The types that a place in a file wants of its expression.
#[derive(Debug, Clone, Copy)]
pub struct WantedTypes<'a> {
    /// The types that fit. Where [`Type::Number`] fits and [`Type::Integer`] doesn't, a whole number becomes a number.
    pub types: &'a [Type],
    /// The name in messages: "a whole number".
    pub words: &'a str,
}

impl WantedTypes<'static> {
    /// `true` or `false`.
    pub const BOOL: Self = WantedTypes { types: &[Type::Bool], words: Type::Bool.words() };
    /// A whole number.
    pub const INTEGER: Self = WantedTypes { types: &[Type::Integer], words: Type::Integer.words() };
    /// A number; whole ones become numbers.
    pub const NUMBER: Self = WantedTypes { types: &[Type::Number], words: Type::Number.words() };
    /// A text.
    pub const TEXT: Self = WantedTypes { types: &[Type::Text], words: "a text in single quotes" };
    /// A format.
    pub const FORMAT: Self = WantedTypes { types: &[Type::Format], words: Type::Format.words() };
    /// An image.
    pub const IMAGE: Self = WantedTypes { types: &[Type::Image], words: Type::Image.words() };
    /// A buffer.
    pub const BUFFER: Self = WantedTypes { types: &[Type::Buffer], words: Type::Buffer.words() };
    /// An image or a buffer.
    pub const RESOURCE: Self = WantedTypes { types: &[Type::Image, Type::Buffer], words: "an image or buffer" };
    /// A value for a parameter of a shader.
    pub const PARAMETER: Self =
        WantedTypes { types: &[Type::Bool, Type::Integer, Type::Number], words: "a number, `true` or `false`" };
}
