//! Names by place, for what has no name in SPIR-V: `binding 3`, `offset 16`. No name of GLSL or HLSL has a space.

use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The set whose bindings belong to the pass: its sampled and storage images, its buffers, and one block of parameters.
/// Sets from 1 on belong to the draw source.
pub const PASS_SET: u32 = 0;

/// The names by which a pass gives things to SPIR-V, which may call them otherwise, or have no names.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct GivenNames {
    /// Names of images and buffers.
    pub bindings: Vec<Arc<str>>,
    /// Names of parameters.
    pub params: Vec<Arc<str>>,
}

/// The name of a resource by its binding. In another set than the pass's own it has the set's number too.
#[must_use]
pub fn binding_name(set: u32, binding: u32) -> String {
    if set == PASS_SET { format!("{BINDING}{binding}") } else { format!("set {set} {BINDING}{binding}") }
}

/// The name of a block's member by its offset in bytes.
#[must_use]
pub fn offset_name(offset: u32) -> String {
    format!("{OFFSET}{offset}")
}

/// The name of an input or output by its location.
#[must_use]
pub fn location_name(location: u32) -> String {
    format!("location {location}")
}

/// The binding of the pass's own set that a name tells the place of.
#[must_use]
pub fn binding_of(name: &str) -> Option<u32> {
    place(name, BINDING)
}

/// The offset that a member's name tells.
#[must_use]
pub fn offset_of(name: &str) -> Option<u32> {
    place(name, OFFSET)
}

/// Whether a name tells a place.
#[must_use]
pub fn is_place(name: &str) -> bool {
    binding_of(name).is_some() || offset_of(name).is_some()
}

/// The name of a specialization constant by its number.
#[must_use]
pub fn constant_name(number: u32) -> String {
    format!("constant {number}")
}

const BINDING: &str = "binding ";
const OFFSET: &str = "offset ";

fn place(name: &str, what: &str) -> Option<u32> {
    let number = name.strip_prefix(what)?;
    let plain = number == "0" || !number.starts_with(['0', '+']);
    number.parse().ok().filter(|_| plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_has_one_spelling() {
        assert_eq!(binding_of(&binding_name(0, 3)), Some(3));
        assert_eq!(offset_of(&offset_name(0)), Some(0));
        for other in ["binding 03", "binding +3", "binding", "binding x", "set 1 binding 3", "offset16", "Binding 3"] {
            assert!(!is_place(other), "{other}");
        }
    }
}
