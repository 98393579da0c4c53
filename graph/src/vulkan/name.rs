//! Vulkan's names of enumerants and flags.

use serde::Serialize;

/// Vulkan's own name of an enumerant or set of flags, as the JSON form writes it.
pub(crate) fn name_of(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(name)) if !name.is_empty() => name,
        _ => "NONE".to_owned(),
    }
}
