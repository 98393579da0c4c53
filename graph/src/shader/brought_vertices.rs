//! The vertices that a draw source brings along: its buffers, and the attributes in them.

use super::VertexInput;
use crate::vulkan::{Component, VertexFormat};
use std::borrow::Cow;

/// A vertex buffer, by the number of its binding in [`DrawInterface::vertex_buffers`](super::DrawInterface::vertex_buffers).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VertexBuffer {
    /// Bytes from element to element, at least 1.
    pub stride: u32,
    /// When the next element is read.
    pub rate: VertexRate,
}

/// When the next element of a vertex buffer is read (`VkVertexInputRate`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VertexRate {
    /// For each vertex.
    Vertex,
    /// For each instance, or after several.
    Instance {
        /// How many instances in a row read one element, at least 1. More than 1 needs the feature
        /// `vertexAttributeInstanceRateDivisor`.
        divisor: u32,
    },
}

/// What DXC puts before the semantic of an input.
const SEMANTIC: &str = "in.var.";

/// A vertex attribute that is brought along. Shaders read it by its name, with as many components as they like: those that it doesn't
/// have are 0, and the fourth is 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Attribute {
    /// Name in shaders.
    pub name: Cow<'static, str>,
    /// Its format; of a matrix or an array that of one location.
    pub format: VertexFormat,
    /// How many locations it takes, one behind the other in the buffer, at least 1: of a matrix as many as it has columns.
    pub locations: u32,
    /// Where shaders read it that have no name for it, or that of no attribute; `None`: they can't.
    pub location: Option<u32>,
    /// The number of its vertex buffer.
    pub buffer: u32,
    /// Offset in an element of the buffer, in bytes.
    pub offset: u32,
}

/// One location of a vertex shader, and where it is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BroughtLocation {
    /// Location.
    pub location: u32,
    /// The number of the vertex buffer.
    pub buffer: u32,
    /// Offset in an element of the buffer, in bytes.
    pub offset: u32,
    /// Format.
    pub format: VertexFormat,
}

/// Why a shader can't read what is brought along as the attribute that it declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttributeMisfit {
    /// Nothing of that name is brought along.
    Unknown,
    /// It begins behind the first component of its location.
    Component,
    /// It has components of another type than this format.
    Format(VertexFormat),
    /// It takes more locations than this.
    Locations(u32),
}

impl VertexBuffer {
    /// A buffer with an element for each vertex.
    #[must_use]
    pub const fn of_vertices(stride: u32) -> VertexBuffer {
        VertexBuffer { stride, rate: VertexRate::Vertex }
    }

    /// A buffer with an element for each instance.
    #[must_use]
    pub const fn of_instances(stride: u32) -> VertexBuffer {
        VertexBuffer { stride, rate: VertexRate::Instance { divisor: 1 } }
    }

    /// What is wrong with it as the buffer of this number, in words.
    pub(super) fn fault(self, number: usize) -> Option<String> {
        Some(match (self.stride, self.rate) {
            (0, _) => format!("the vertices of buffer {number} have no bytes: leave the buffer out"),
            (_, VertexRate::Instance { divisor: 65536.. }) => {
                format!("vertex buffer {number} has one element for more instances than every device allows, 65535")
            }
            (_, VertexRate::Instance { divisor: 0 }) => {
                format!("vertex buffer {number} has one element for 0 instances; 1 is the least")
            }
            _ => return None,
        })
    }
}

impl VertexRate {
    /// Whether elements are read by instances.
    #[must_use]
    pub const fn is_by_instance(self) -> bool {
        matches!(self, VertexRate::Instance { .. })
    }
}

impl Attribute {
    /// An attribute of 1 to 4 32-bit floats, at an offset in bytes in the first buffer. Of other numbers the nearest is taken.
    #[must_use]
    pub const fn new(name: &'static str, components: u32, offset: u32) -> Attribute {
        let format = match components {
            0 | 1 => VertexFormat::R32_SFLOAT,
            2 => VertexFormat::R32G32_SFLOAT,
            3 => VertexFormat::R32G32B32_SFLOAT,
            _ => VertexFormat::R32G32B32A32_SFLOAT,
        };
        Attribute::of_format(name, format, offset)
    }

    /// An attribute of any format, at an offset in bytes in the first buffer.
    #[must_use]
    pub const fn of_format(name: &'static str, format: VertexFormat, offset: u32) -> Attribute {
        Attribute { name: Cow::Borrowed(name), format, locations: 1, location: None, buffer: 0, offset }
    }

    /// The same in the buffer of this number.
    #[must_use]
    pub const fn in_buffer(mut self, buffer: u32) -> Attribute {
        self.buffer = buffer;
        self
    }

    /// The same of several locations, one behind the other: a matrix of as many columns, or an array.
    #[must_use]
    pub const fn with_locations(mut self, locations: u32) -> Attribute {
        self.locations = locations;
        self
    }

    /// The same, read at this location by shaders that have no name for it, or that of no attribute.
    #[must_use]
    pub const fn at_location(mut self, location: u32) -> Attribute {
        self.location = Some(location);
        self
    }

    /// Whether a shader means this by its name. Compilers of HLSL name what lies in a structure `vertex.position`: then the member's name
    /// counts. DXC tells the semantic alone, `in.var.POSITION`, and HLSL ignores the case of semantics.
    #[must_use]
    pub fn is_called(&self, input: &VertexInput) -> bool {
        match input.name.strip_prefix(SEMANTIC) {
            Some(semantic) => self.name.eq_ignore_ascii_case(semantic),
            None => input.name.rsplit('.').next() == Some(&*self.name),
        }
    }

    /// What is wrong with it in these buffers, in words.
    pub(super) fn fault(&self, buffers: &[VertexBuffer]) -> Option<String> {
        let Attribute { name, format, locations, buffer, offset, .. } = self;
        if *locations == 0 {
            return Some(format!("the vertex attribute `{name}` takes no location; one is the least"));
        }
        let Some(VertexBuffer { stride, .. }) = buffers.get(*buffer as usize) else {
            let count = buffers.len();
            return Some(match count {
                0 => format!("the vertex attribute `{name}` doesn't fit vertices of 0 bytes"),
                _ => format!("the vertex attribute `{name}` is in vertex buffer {buffer}, and there are {count}"),
            });
        };
        // That the buffer's elements have no bytes is told of the buffer.
        if *stride == 0 {
            return None;
        }
        let end = u64::from(*offset) + u64::from(*locations) * u64::from(format.bytes());
        let alignment = format.alignment();
        let aligned = [*offset, *stride, format.bytes()].iter().all(|bytes| bytes.is_multiple_of(alignment));
        if aligned && end <= u64::from(*stride) {
            return None;
        }
        let what = format!("the vertex attribute `{name}` doesn't fit vertices of {stride} bytes");
        Some(match aligned || alignment == 1 {
            true => what,
            false => format!("{what}: places of {format} are multiples of {alignment} bytes"),
        })
    }
}

impl AttributeMisfit {
    /// What should be done about it in the shader; `None`: nothing is known.
    #[must_use]
    pub fn help(self, input: &VertexInput) -> Option<String> {
        Some(match self {
            AttributeMisfit::Unknown => return None,
            AttributeMisfit::Component => {
                "attributes of a draw source begin a location: leave `component` out".to_owned()
            }
            AttributeMisfit::Format(format) => {
                let types = match format.component() {
                    Component::Float => "`float`, `vec2`, `vec3` or `vec4`",
                    Component::Int => "`int`, `ivec2`, `ivec3` or `ivec4`",
                    Component::Uint => "`uint`, `uvec2`, `uvec3` or `uvec4`",
                };
                format!("`{}` is {}, in the format {format}: {types}", input.name, format.component().words())
            }
            AttributeMisfit::Locations(1) => format!("`{}` is a vector, at one location", input.name),
            AttributeMisfit::Locations(count) => format!("`{}` takes {count} locations", input.name),
        })
    }
}
