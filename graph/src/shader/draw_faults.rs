//! What of a draw interface no device could bind.

use super::{BINDINGS, DrawInterface, PASS_SET, PushConstants, SuppliedKind, SuppliedResource, VertexBuffer};
use crate::vulkan::PrimitiveTopology;
use std::collections::HashMap;

/// Descriptor sets that every device has.
const SETS: u32 = 4;

/// A part of a draw interface that no device need be able to bind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DrawFault {
    /// The part.
    pub at: DrawPart,
    /// What is wrong, in words. Names in it are not yet escaped.
    pub message: String,
    /// The earlier part that is in its way.
    pub first: Option<DrawPart>,
}

/// A part of a draw interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawPart {
    /// A vertex buffer, by its number.
    VertexBuffer(usize),
    /// An attribute, by its number in the list.
    Attribute(usize),
    /// That strips begin anew.
    Restart,
    /// A range of push constants, by its number in the list.
    PushConstants(usize),
    /// A resource, by its number in the list.
    Supplied(usize),
}

impl DrawInterface {
    /// All that is wrong with it: what not every device can bind, and what shaders couldn't tell apart.
    #[must_use]
    pub fn faults(&self) -> Vec<DrawFault> {
        let of_buffer =
            |(number, it): (usize, &VertexBuffer)| Some((DrawPart::VertexBuffer(number), it.fault(number)?));
        let of_range = |(number, it): (usize, &PushConstants)| Some((DrawPart::PushConstants(number), it.fault()?));
        let buffers = self.vertex_buffers.iter().enumerate().filter_map(of_buffer);
        let ranges = self.push_constants.iter().enumerate().filter_map(of_range);
        let alone = |(at, message)| DrawFault { at, message, first: None };
        let mut faults: Vec<DrawFault> = buffers.chain(ranges).map(alone).collect();
        if self.primitive_restart && !self.topology.is_some_and(PrimitiveTopology::is_joined) {
            let message = "strips that an index begins anew take a `topology` of strips or fans".to_owned();
            faults.push(DrawFault { at: DrawPart::Restart, message, first: None });
        }
        let mut names = HashMap::new();
        for (number, attribute) in self.attributes.iter().enumerate() {
            let at = DrawPart::Attribute(number);
            let first = *names.entry(&*attribute.name).or_insert(at);
            let twice =
                (first != at).then(|| (format!("`{}` is the name of two attributes", attribute.name), Some(first)));
            let unnamed = || (!is_identifier(&attribute.name)).then(|| no_identifier(&attribute.name));
            let wrong = || unnamed().or_else(|| attribute.fault(&self.vertex_buffers));
            let wrong = twice.or_else(|| Some((wrong()?, None)));
            faults.extend(wrong.map(|(message, first)| DrawFault { at, message, first }));
        }
        let (mut names, mut places) = (HashMap::new(), HashMap::new());
        for (number, one) in self.supplied.iter().enumerate() {
            let at = DrawPart::Supplied(number);
            let by_place = *places.entry((one.set, one.binding)).or_insert(at);
            let by_name = *names.entry(&*one.name).or_insert(at);
            let wrong = match supplied(one) {
                Some(message) => Some((message, None)),
                None if by_place != at => {
                    Some((format!("`{}` is brought along where something else is", one.name), Some(by_place)))
                }
                None if by_name != at => Some((format!("`{}` is the name of two resources", one.name), Some(by_name))),
                None => None,
            };
            faults.extend(wrong.map(|(message, first)| DrawFault { at, message, first }));
        }
        faults
    }
}

/// What is wrong with a resource, in words.
fn supplied(one: &SuppliedResource) -> Option<String> {
    let SuppliedResource { set, binding, name, kind, count } = one;
    if !is_identifier(name) {
        return Some(no_identifier(name));
    }
    if *set == PASS_SET || *set >= SETS {
        let last = SETS - 1;
        return Some(format!("`{name}` can't be brought along in set {set}: a draw source has sets 1 to {last}"));
    }
    let last = BINDINGS - 1;
    if *binding > last {
        return Some(format!("`{name}` at binding {binding}: bindings go up to {last}"));
    }
    if *count == 0 {
        return Some(format!("`{name}` is brought along 0 times; once is the least"));
    }
    let block = *count > 1 && *kind != SuppliedKind::SampledImage;
    block.then(|| format!("`{name}` is brought along {count} times, as only a `SampledImage` can be"))
}

/// Whether shaders can declare something of this name.
fn is_identifier(name: &str) -> bool {
    let mut letters = name.bytes();
    letters.next().is_some_and(|first| first.is_ascii_alphabetic() || first == b'_')
        && letters.all(|letter| letter.is_ascii_alphanumeric() || letter == b'_')
}

fn no_identifier(name: &str) -> String {
    format!("`{name}` can't be a name in shaders, which have letters from a to z, digits and `_`")
}
