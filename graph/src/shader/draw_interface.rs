//! What the draw source brings along for one kind of draw, and what of it no device could bind.

use super::{Attribute, BINDINGS, Binding, BindingKind, PASS_SET, PushConstants, VertexBuffer, binding_name};
use crate::vulkan::{Component, Dimension, ImageShape, PrimitiveTopology};
use std::borrow::Cow;
use std::collections::HashMap;

/// Descriptor sets that every device has.
const SETS: u32 = 4;

/// The interface of the draw source for one kind of draw: vertex attributes, and resources in sets from 1 on.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DrawInterface {
    /// Vertex buffers, by the numbers of their bindings.
    pub vertex_buffers: Vec<VertexBuffer>,
    /// Vertex attributes, by the name that shaders give them.
    pub attributes: Vec<Attribute>,
    /// What vertices make; `None`: triangles of each three, or what the pass says.
    pub topology: Option<PrimitiveTopology>,
    /// Whether an index of all ones ends a strip or a fan, and begins another.
    pub primitive_restart: bool,
    /// Push constants that are set for each draw.
    pub push_constants: Vec<PushConstants>,
    /// Resources that are bound.
    pub supplied: Vec<SuppliedResource>,
}

/// A resource that is brought along.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SuppliedResource {
    /// Descriptor set, 1 to 3.
    pub set: u32,
    /// Binding number.
    pub binding: u32,
    /// Name in shaders.
    pub name: Cow<'static, str>,
    /// Kind.
    pub kind: SuppliedKind,
    /// How many there are, at least 1: images can be an array, of which shaders declare as many elements or fewer.
    pub count: u32,
}

/// Kind of a resource that is brought along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SuppliedKind {
    /// A uniform block.
    UniformBlock,
    /// A storage block, read only.
    StorageBlock,
    /// A combined image sampler, two-dimensional, float.
    SampledImage,
}

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

impl SuppliedResource {
    /// A resource at a set and a binding.
    #[must_use]
    pub const fn new(set: u32, binding: u32, name: &'static str, kind: SuppliedKind) -> SuppliedResource {
        SuppliedResource { set, binding, name: Cow::Borrowed(name), kind, count: 1 }
    }

    /// An array of this many.
    #[must_use]
    pub const fn with_count(mut self, count: u32) -> SuppliedResource {
        self.count = count;
        self
    }

    /// Whether a shader that declares `binding` reads this. It may declare only the first elements of an array.
    #[must_use]
    pub fn is(&self, binding: &Binding) -> bool {
        (self.set, self.binding) == (binding.set, binding.binding)
            && self.is_called(binding)
            && self.kind.is(&binding.kind)
            && !binding.separate
            && binding.count() <= self.count
    }

    /// Whether a shader means this: by its name, or by its place where it has no names.
    #[must_use]
    pub fn is_called(&self, binding: &Binding) -> bool {
        *self.name == *binding.name
            || (self.set, self.binding) == (binding.set, binding.binding)
                && binding.name == binding_name(binding.set, binding.binding)
    }
}

impl SuppliedKind {
    /// All kinds, by name.
    pub const NAMED: [(&'static str, SuppliedKind); 3] = [
        ("UniformBlock", SuppliedKind::UniformBlock),
        ("StorageBlock", SuppliedKind::StorageBlock),
        ("SampledImage", SuppliedKind::SampledImage),
    ];

    /// Whether a shader that declares such a binding reads this kind.
    #[must_use]
    pub fn is(self, declared: &BindingKind) -> bool {
        const PLAIN: ImageShape =
            ImageShape { dimension: Dimension::D2, arrayed: false, multisampled: false, component: Component::Float };
        match self {
            SuppliedKind::UniformBlock => matches!(declared, BindingKind::UniformBlock(_)),
            SuppliedKind::StorageBlock => matches!(declared, BindingKind::StorageBlock { writable: false, .. }),
            SuppliedKind::SampledImage => matches!(declared, BindingKind::SampledImage(PLAIN)),
        }
    }

    /// The declaration that reads it, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            SuppliedKind::UniformBlock => "a uniform block",
            SuppliedKind::StorageBlock => "a storage block that is only read (`readonly buffer`)",
            SuppliedKind::SampledImage => "a two-dimensional floating-point image (`sampler2D`)",
        }
    }
}

impl DrawInterface {
    /// All that is wrong with it: what not every device can bind, and what shaders couldn't tell apart.
    #[must_use]
    pub fn faults(&self) -> Vec<DrawFault> {
        let mut faults: Vec<DrawFault> = self.buffer_faults().chain(self.push_faults()).collect();
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
            let wrong = match one.fault() {
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

impl SuppliedResource {
    fn fault(&self) -> Option<String> {
        let SuppliedResource { set, binding, name, kind, count } = self;
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
