//! What the draw source brings along for one kind of draw.

use super::{Attribute, Binding, BindingKind, PushConstants, VertexBuffer, binding_name};
use crate::vulkan::{Component, Dimension, ImageShape, PrimitiveTopology};
use std::borrow::Cow;

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
