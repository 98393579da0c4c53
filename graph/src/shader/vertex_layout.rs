//! Vertex attributes as shaders declare them, and how a vertex lies in the buffers of a pass.

use crate::vulkan::Component;
use serde::{Deserialize, Serialize};

/// A vertex attribute.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct VertexInput {
    /// Location; of a matrix or an array the first one.
    pub location: u32,
    /// The first of the location's four components that it takes.
    pub component: u32,
    /// Name in the shader.
    pub name: String,
    /// Type, as GLSL writes it: `vec3`, `uint`, `mat4`, `vec2[4]`.
    pub ty: String,
    /// Whether the shader reads it. One that is only declared has its place in a vertex all the same.
    pub used: bool,
}

/// What an attribute is in each of its locations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Column {
    kind: Component,
    components: u32,
}

/// One location of a vertex: 1 to 4 components of 32 bits, out of one buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LocationLayout {
    /// Location.
    pub location: u32,
    /// Which of the buffers.
    pub buffer: usize,
    /// Bytes from the beginning of the vertex.
    pub offset: u32,
    /// The type of a component.
    pub kind: Component,
    /// Number of components, from the first one on.
    pub components: u32,
}

/// How a vertex lies in the buffers that a pass brings itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VertexLayout {
    /// Each location, in order.
    pub locations: Vec<LocationLayout>,
    /// Bytes from vertex to vertex of each buffer.
    pub strides: Vec<u32>,
}

/// Why there is no layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayoutFault {
    /// The attribute's name in the shader; empty if the number of buffers is wrong.
    pub name: String,
    /// What is wrong, in words.
    pub message: String,
}

impl VertexInput {
    /// Words for what the shader does with it.
    #[must_use]
    pub fn verb(&self) -> &'static str {
        if self.used { "reads" } else { "declares" }
    }

    /// How many locations it takes, and the type of their components; `None`: no buffer can hold such a type.
    pub(super) fn read_as(&self) -> Option<(u32, Component)> {
        self.columns().map(|(count, Column { kind, .. })| (count, kind))
    }

    /// How many locations it takes, and what is in each; `None`: no buffer can hold such a type.
    fn columns(&self) -> Option<(u32, Column)> {
        let (element, lengths) = self.ty.split_at(self.ty.find('[').unwrap_or(self.ty.len()));
        let lengths = lengths.split(['[', ']']).filter(|length| !length.is_empty());
        let elements = lengths
            .map(|length| length.parse::<u32>().ok())
            .try_fold(1, |all: u32, length| Some(all.saturating_mul(length?)))?;
        let vector = |kind, components: &str| Some(Column { kind, components: components.parse().ok()? });
        let (columns, column) = match element {
            "float" => (1, Column { kind: Component::Float, components: 1 }),
            "int" => (1, Column { kind: Component::Int, components: 1 }),
            "uint" => (1, Column { kind: Component::Uint, components: 1 }),
            _ if element.starts_with("mat") => {
                let size = &element[3..];
                let (columns, rows) = size.split_once('x').unwrap_or((size, size));
                (columns.parse().ok()?, vector(Component::Float, rows)?)
            }
            _ if element.starts_with("vec") => (1, vector(Component::Float, &element[3..])?),
            _ if element.starts_with("ivec") => (1, vector(Component::Int, &element[4..])?),
            _ if element.starts_with("uvec") => (1, vector(Component::Uint, &element[4..])?),
            _ => return None,
        };
        Some((elements.saturating_mul(columns), column))
    }
}

impl VertexLayout {
    /// The layout of vertices with these attributes, out of a number of buffers.
    ///
    /// From one buffer a vertex holds its locations in their order and without gaps; from several, one attribute each.
    /// Components have 32 bits. A matrix is one location a column, an array one or more an element. Attributes that share a
    /// location are one: it reaches from the location's first component to the last that any of them declares.
    ///
    /// # Errors
    /// [`LayoutFault`] names the attribute.
    pub fn of(inputs: &[VertexInput], buffers: usize) -> Result<VertexLayout, LayoutFault> {
        let mut inputs: Vec<&VertexInput> = inputs.iter().collect();
        inputs.sort_by_key(|it| (it.location, it.component));
        let mut locations: Vec<LocationLayout> = Vec::new();
        // The end of the locations of each attribute, those that share locations counted as one.
        let mut attributes: Vec<u32> = Vec::new();
        for input in inputs {
            let fault = |what: &str| LayoutFault {
                name: input.name.clone(),
                message: format!("the vertex attribute `{}` {what}", input.name),
            };
            let (count, Column { kind, components }) = input
                .columns()
                .ok_or_else(|| fault(&format!("is a {}, and vertices hold numbers of 32 bits", input.ty)))?;
            let end = input.location.saturating_add(count);
            match attributes.last_mut().filter(|last| **last > input.location) {
                Some(last) => *last = end.max(*last),
                None => attributes.push(end),
            }
            let components = input.component.saturating_add(components);
            for location in input.location..end {
                let buffer = attributes.len() - 1;
                match locations.iter_mut().find(|it| it.location == location) {
                    Some(shared) if shared.kind != kind => {
                        return Err(fault(&format!(
                            "is a {}, and another one at location {location} is of another type",
                            input.ty
                        )));
                    }
                    Some(shared) => shared.components = shared.components.max(components),
                    None => locations.push(LocationLayout { location, buffer, offset: 0, kind, components }),
                }
            }
        }
        if buffers != 1 && buffers != attributes.len() {
            let wanted = attributes.len();
            let message =
                format!("it has {buffers} vertex buffers for {wanted} vertex attributes: one buffer, or one for each");
            return Err(LayoutFault { name: String::new(), message });
        }
        locations.sort_by_key(|it| it.location);
        let mut strides = vec![0; buffers];
        for it in &mut locations {
            it.buffer = if buffers == 1 { 0 } else { it.buffer };
            it.offset = strides[it.buffer];
            strides[it.buffer] += 4 * it.components;
        }
        Ok(VertexLayout { locations, strides })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(location: u32, component: u32, ty: &str) -> VertexInput {
        VertexInput { location, component, name: format!("a{location}{component}"), ty: ty.to_owned(), used: true }
    }

    /// Location, buffer, offset and components of a location.
    type Place = (u32, usize, u32, u32);

    /// The places of all locations, and the strides.
    fn layout(inputs: &[VertexInput], buffers: usize) -> (Vec<Place>, Vec<u32>) {
        let VertexLayout { locations, strides } = VertexLayout::of(inputs, buffers).expect("a layout");
        (locations.iter().map(|it| (it.location, it.buffer, it.offset, it.components)).collect(), strides)
    }

    #[test]
    fn a_matrix_takes_a_location_a_column_and_an_array_one_an_element() {
        let inputs = [input(0, 0, "vec2"), input(1, 0, "mat2x3"), input(3, 0, "uint[2]")];
        let wanted = vec![(0, 0, 0, 2), (1, 0, 8, 3), (2, 0, 20, 3), (3, 0, 32, 1), (4, 0, 36, 1)];
        assert_eq!(layout(&inputs, 1), (wanted, vec![40]));
        let wanted = vec![(0, 0, 0, 2), (1, 1, 0, 3), (2, 1, 12, 3), (3, 2, 0, 1), (4, 2, 4, 1)];
        assert_eq!(layout(&inputs, 3), (wanted, vec![8, 24, 8]));
        let inputs = [input(2, 0, "mat3[2]"), input(0, 0, "vec4[2]")];
        let (locations, strides) = layout(&inputs, 1);
        assert_eq!((locations.len(), locations[2], strides), (8, (2, 0, 32, 3), vec![104]));
    }

    #[test]
    fn attributes_of_one_location_share_its_components() {
        let both = [input(0, 0, "vec2"), input(1, 1, "float"), input(1, 0, "float")];
        assert_eq!(layout(&both, 1), (vec![(0, 0, 0, 2), (1, 0, 8, 2)], vec![16]));
        assert_eq!(layout(&both, 2), (vec![(0, 0, 0, 2), (1, 1, 0, 2)], vec![8, 8]));
        let alone = [input(0, 2, "vec2")];
        assert_eq!(layout(&alone, 1), (vec![(0, 0, 0, 4)], vec![16]));
        let arrays = [input(0, 0, "vec3[2]"), input(0, 3, "float[3]")];
        assert_eq!(layout(&arrays, 1), (vec![(0, 0, 0, 4), (1, 0, 16, 4), (2, 0, 32, 4)], vec![48]));
    }

    #[test]
    fn what_no_buffer_holds_is_named() {
        let fault = |inputs: &[VertexInput], buffers| VertexLayout::of(inputs, buffers).expect_err("no layout").message;
        assert_eq!(
            fault(&[input(0, 0, "dvec2")], 1),
            "the vertex attribute `a00` is a dvec2, and vertices hold numbers of 32 bits"
        );
        let mixed = "the vertex attribute `a01` is a int, and another one at location 0 is of another type";
        assert_eq!(fault(&[input(0, 0, "float"), input(0, 1, "int")], 1), mixed);
        let wanted = "it has 2 vertex buffers for 1 vertex attributes: one buffer, or one for each";
        assert_eq!(fault(&[input(0, 0, "float"), input(0, 1, "float")], 2), wanted);
    }
}
