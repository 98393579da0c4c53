//! A setting, or a parameter of a fragment, as expressions see it.

use crate::expression::{Type, Value};
use crate::language::model::{Setting, SettingKind};
use crate::ron::Name;
use crate::vulkan::Format;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// A setting, or a parameter of a fragment.
#[derive(Debug, Clone)]
pub(crate) struct Parameter {
    /// Its name.
    pub(crate) name: Name,
    /// Its kind.
    pub(crate) kind: ParameterKind,
    /// Whether a use of the fragment has to give it. Settings have values anyway.
    pub(crate) required: bool,
}

/// The kind of a parameter.
#[derive(Debug, Clone)]
pub(crate) enum ParameterKind {
    /// A value of the kinds that settings have.
    Value(SettingKind),
    /// An image.
    Image,
    /// A buffer.
    Buffer,
    /// A texel format.
    Format {
        /// The format if none is given.
        default: Option<Format>,
    },
}

impl From<&Setting> for Parameter {
    fn from(setting: &Setting) -> Parameter {
        Parameter { name: setting.name.clone(), kind: ParameterKind::Value(setting.kind.clone()), required: false }
    }
}

impl Parameter {
    /// The least number that it allows, if it is a number.
    pub(crate) fn least(&self) -> Option<f64> {
        if let ParameterKind::Value(kind) = &self.kind { kind.least() } else { None }
    }

    /// A whole number that it allows and that lies outside of `range`.
    pub(crate) fn whole_beyond(&self, range: &RangeInclusive<i64>) -> Option<i64> {
        if let ParameterKind::Value(kind) = &self.kind { kind.whole_beyond(range) } else { None }
    }

    /// The whole numbers of a list of allowed values; empty for other kinds.
    pub(crate) fn one_of(&self) -> &[i64] {
        match &self.kind {
            ParameterKind::Value(SettingKind::OneOf { of, .. }) => of,
            _ => &[],
        }
    }

    /// The texts of a list of allowed values; empty for other kinds.
    pub(crate) fn texts(&self) -> &[Arc<str>] {
        match &self.kind {
            ParameterKind::Value(SettingKind::Choice { of, .. }) => of,
            _ => &[],
        }
    }

    /// Its value if none is given.
    pub(crate) fn default(&self) -> Option<Value> {
        match &self.kind {
            ParameterKind::Value(kind) if !self.required => Some(kind.default()),
            ParameterKind::Format { default } => default.map(Value::Format),
            _ => None,
        }
    }
}

impl ParameterKind {
    /// The type in expressions.
    pub(crate) const fn ty(&self) -> Type {
        match self {
            ParameterKind::Value(kind) => kind.ty(),
            ParameterKind::Image => Type::Image,
            ParameterKind::Buffer => Type::Buffer,
            ParameterKind::Format { .. } => Type::Format,
        }
    }
}
