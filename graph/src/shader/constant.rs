//! Specialization constants of shaders.

use super::constant_name;
use crate::frame::ParamValue;
use serde::{Deserialize, Serialize};

/// A specialization constant of a shader.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShaderConstant {
    /// Its name; `constant 7` if it has none.
    pub name: String,
    /// Its number, `constant_id`.
    pub number: u32,
    /// Its type, as GLSL writes it.
    pub ty: String,
}

impl ShaderConstant {
    /// Whether a pass means it by a name: its own, or by its number.
    #[must_use]
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || constant_name(self.number) == name
    }
}

/// The value that a pass gives a specialization constant: a truth value or a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ConstantValue {
    /// A truth value.
    Bool(bool),
    /// A whole number.
    Integer(i64),
    /// The bits of a number.
    Number(u64),
}

impl ConstantValue {
    /// The value of a pass; `None`: it is a list, or another one in each frame.
    #[must_use]
    pub fn of(value: &ParamValue) -> Option<ConstantValue> {
        match value {
            ParamValue::Bool(value) => Some(ConstantValue::Bool(*value)),
            ParamValue::Integer(value) => Some(ConstantValue::Integer(*value)),
            ParamValue::Number(value) => Some(ConstantValue::Number(value.to_bits())),
            ParamValue::List(_) | ParamValue::OfFrame(_) => None,
        }
    }

    /// The same as a pass has it.
    #[must_use]
    pub const fn value(self) -> ParamValue {
        match self {
            ConstantValue::Bool(value) => ParamValue::Bool(value),
            ConstantValue::Integer(value) => ParamValue::Integer(value),
            ConstantValue::Number(bits) => ParamValue::Number(f64::from_bits(bits)),
        }
    }
}
