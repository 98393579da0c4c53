//! Vulkan's names of enumerants and flags.

use serde::Serialize;

/// Vulkan's own name of an enumerant or set of flags, as the JSON form writes it: what a person is told, where `Debug` would be Rust.
#[must_use]
pub fn name_of(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(name)) if !name.is_empty() => name,
        _ => "NONE".to_owned(),
    }
}

/// A value as the Plan's JSON form has it: for people who compare Plans.
pub(crate) fn in_plan(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(name)) => name,
        Ok(value) => value.to_string(),
        Err(_) => "NONE".to_owned(),
    }
}
