//! Typed data out of buffers. Every range is checked before a byte is read.

use super::document::{Document, SparsePart, follow};
use super::external::External;
use super::problem::{GltfError, Problem, at_most};
use crate::scene::limits;
use framewright_graph::base::Root;
use std::cell::{Cell, OnceCell};

/// The document with its data.
pub(super) struct Data<'a> {
    pub(super) document: &'a Document,
    pub(super) external: External<'a>,
    binary: Option<&'a [u8]>,
    /// The bytes behind the URI of each buffer, read on first use.
    read: Vec<OnceCell<Vec<u8>>>,
    /// Bytes of elements that were read so far.
    taken: Cell<u64>,
}

/// The type of an accessor's elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Element {
    component: Component,
    components: u64,
    normalized: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn from_code(code: u32) -> Option<Component> {
        Some(match code {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => return None,
        })
    }

    fn bytes(self) -> u64 {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 => 4,
        }
    }
}

impl<'a> Data<'a> {
    /// A document with the file's binary chunk, if it has one, and the folder that it lies in.
    pub(super) fn new(document: &'a Document, binary: Option<&'a [u8]>, beside: Option<&'a Root>) -> Data<'a> {
        let read = document.buffers.iter().map(|_| OnceCell::new()).collect();
        Data { document, external: External::new(beside), binary, read, taken: Cell::new(0) }
    }

    /// Bytes of elements that were read so far.
    pub(super) fn taken(&self) -> u64 {
        self.taken.get()
    }

    /// Makes sure that the elements of an accessor aren't all 0.
    pub(super) fn holds_values(&self, index: u64, user: &str) -> Result<(), GltfError> {
        let accessor = follow(&self.document.accessors, index, "accessor", user)?;
        let holds = accessor.buffer_view.is_some() || accessor.sparse.is_some();
        if holds { Ok(()) } else { Err(Problem::NoValues.at(&format!("accessor {index}"))) }
    }

    /// Vectors of 32-bit floats; coordinates of textures may be normalised integers too.
    pub(super) fn vectors<const N: usize>(
        &self,
        index: u64,
        role: &'static str,
        user: &str,
    ) -> Result<Vec<[f32; N]>, GltfError> {
        let (element, bytes) = self.elements(index, user)?;
        let texture = role == TEXTURE_COORDINATES;
        let scale = match element {
            Element { component: Component::F32, .. } => None,
            Element { component: Component::U8, normalized: true, .. } if texture => Some(255.0),
            Element { component: Component::U16, normalized: true, .. } if texture => Some(65535.0),
            _ => Some(0.0),
        };
        if element.components != N as u64 || scale == Some(0.0) {
            let expected = match N {
                2 => "VEC2 of 32-bit floats, or normalised 8-bit or 16-bit unsigned integers",
                _ => "VEC3 of 32-bit floats",
            };
            return Err(self.wrong_type(index, role, expected));
        }
        let value = |part: &[u8]| match (part, scale) {
            ([a, b, c, d], _) => f32::from_le_bytes([*a, *b, *c, *d]),
            ([a, b], Some(scale)) => f32::from(u16::from_le_bytes([*a, *b])) / scale,
            ([a], Some(scale)) => f32::from(*a) / scale,
            _ => 0.0,
        };
        let values: Vec<f32> = bytes.chunks_exact(element.component.bytes() as usize).map(value).collect();
        if values.iter().any(|value| !value.is_finite()) {
            return Err(Problem::NotFinite(role).at(&format!("accessor {index}")));
        }
        Ok(values.as_chunks::<N>().0.to_vec())
    }

    /// Indices of 8, 16 or 32 bits.
    pub(super) fn indices(&self, index: u64, user: &str) -> Result<Vec<u32>, GltfError> {
        let (element, bytes) = self.elements(index, user)?;
        let unsigned = matches!(element.component, Component::U8 | Component::U16 | Component::U32);
        if element.components != 1 || !unsigned {
            return Err(self.wrong_type(index, "indices", "SCALAR of 8, 16 or 32-bit unsigned integers"));
        }
        Ok(integers(&bytes, element.component))
    }

    /// The bytes of a buffer view, with its stride.
    pub(super) fn view(&self, index: u64, user: &str) -> Result<(&[u8], Option<u64>), GltfError> {
        let view = follow(&self.document.buffer_views, index, "buffer view", user)?;
        let at = format!("buffer view {index}");
        let buffer = self.buffer(view.buffer, &at)?;
        let bytes = range(buffer, view.byte_offset, view.byte_length, &at, || format!("buffer {}", view.buffer))?;
        Ok((bytes, view.byte_stride))
    }

    /// The bytes of a buffer: behind its URI, or of the first without one the binary chunk.
    fn buffer(&self, index: u64, user: &str) -> Result<&[u8], GltfError> {
        let buffer = follow(&self.document.buffers, index, "buffer", user)?;
        let at = format!("buffer {index}");
        let (bytes, holder) = match (&buffer.uri, self.binary) {
            (Some(uri), _) => {
                let read = &self.read[index as usize];
                if read.get().is_none() {
                    // Without its data the file is not whole.
                    let bytes = self.external.bytes(uri, &at).map_err(GltfError::of_whole)?;
                    read.get_or_init(|| bytes);
                }
                (read.get().map_or(&[][..], Vec::as_slice), "its data")
            }
            (None, Some(binary)) if index == 0 => (binary, "the binary chunk"),
            (None, _) => return Err(Problem::NoData.at(&at)),
        };
        range(bytes, 0, buffer.byte_length, &at, || holder.into()).map_err(GltfError::of_whole)
    }

    /// All elements of an accessor without gaps, sparse ones put in place.
    fn elements(&self, index: u64, user: &str) -> Result<(Element, Vec<u8>), GltfError> {
        let accessor = follow(&self.document.accessors, index, "accessor", user)?;
        let at = format!("accessor {index}");
        let component = Component::from_code(accessor.component_type).ok_or_else(|| {
            let is = accessor.component_type.to_string();
            Problem::Word { what: "component type", is, expected: "5120, 5121, 5122, 5123, 5125 or 5126" }.at(&at)
        })?;
        let components = match accessor.kind.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" | "MAT2" => 4,
            "MAT3" => 9,
            "MAT4" => 16,
            other => {
                let is = other.escape_debug().to_string();
                let expected = "SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4";
                return Err(Problem::Word { what: "type", is, expected }.at(&at));
            }
        };
        let element = Element { component, components, normalized: accessor.normalized };
        let size = component.bytes() * components;
        if accessor.count == 0 {
            return Err(Problem::NoElements.at(&at));
        }
        // Elements without a view are zeros that the file needn't hold.
        let is = accessor.count.saturating_mul(size);
        at_most("bytes", is, limits::FILE_BYTES, &at)?;
        self.taken.set(self.taken.get() + is);
        let mut bytes = match accessor.buffer_view {
            Some(view) => self.packed(view, accessor.byte_offset, accessor.count, size, &at)?,
            None => vec![0; is as usize],
        };
        if let Some(sparse) = &accessor.sparse {
            let places = self.sparse_indices(&sparse.indices, sparse.count, accessor.count, &at)?;
            let values = self.packed(sparse.values.buffer_view, sparse.values.byte_offset, sparse.count, size, &at)?;
            let size = size as usize;
            for (place, value) in places.iter().zip(values.chunks_exact(size)) {
                let start = *place as usize * size;
                bytes[start..start + size].copy_from_slice(value);
            }
        }
        Ok((element, bytes))
    }

    /// The places of sparse values: ascending, each less than `count`.
    fn sparse_indices(&self, part: &SparsePart, len: u64, count: u64, at: &str) -> Result<Vec<u32>, GltfError> {
        if len == 0 {
            return Err(Problem::NoElements.at(at));
        }
        at_most("sparse elements", len, count, at)?;
        let code = part.component_type.unwrap_or_default();
        let component = Component::from_code(code)
            .filter(|component| matches!(component, Component::U8 | Component::U16 | Component::U32))
            .ok_or_else(|| {
                let expected = "5121, 5123 or 5125";
                Problem::Word { what: "component type of sparse indices", is: code.to_string(), expected }.at(at)
            })?;
        let places = integers(&self.packed(part.buffer_view, part.byte_offset, len, component.bytes(), at)?, component);
        let count = count as usize;
        let ascends = |at: usize| at == 0 || places[at] > places[at - 1];
        match (0..places.len()).find(|number| !ascends(*number) || places[*number] as usize >= count) {
            Some(number) => Err(Problem::SparseIndex { at: number, index: places[number], count }.at(at)),
            None => Ok(places),
        }
    }

    /// `count` elements of `size` bytes from `offset` in a view, copied without gaps.
    fn packed(&self, view: u64, offset: u64, count: u64, size: u64, at: &str) -> Result<Vec<u8>, GltfError> {
        let (bytes, stride) = self.view(view, at)?;
        let stride = match stride {
            Some(stride) if stride < size || !(4..=252).contains(&stride) => {
                return Err(Problem::Stride { stride, size }.at(&format!("buffer view {view}")));
            }
            Some(stride) => stride,
            None => size,
        };
        let length = (count - 1).saturating_mul(stride).saturating_add(size);
        let bytes = range(bytes, offset, length, at, || format!("buffer view {view}"))?;
        Ok(bytes.chunks(stride as usize).flat_map(|element| &element[..size as usize]).copied().collect())
    }

    fn wrong_type(&self, index: u64, role: &'static str, expected: &'static str) -> GltfError {
        let found = follow(&self.document.accessors, index, "accessor", "").map_or_else(
            |_| String::new(),
            |accessor| {
                let normalized = if accessor.normalized { "normalised " } else { "" };
                format!("{} of {normalized}component type {}", accessor.kind.escape_debug(), accessor.component_type)
            },
        );
        Problem::ElementType { role, found, expected }.at(&format!("accessor {index}"))
    }
}

/// The role of texture coordinates, the only vectors that may be integers.
pub(super) const TEXTURE_COORDINATES: &str = "texture coordinates";

fn integers(bytes: &[u8], component: Component) -> Vec<u32> {
    let integer = |part: &[u8]| part.iter().rev().fold(0, |value, byte| value << 8 | u32::from(*byte));
    bytes.chunks_exact(component.bytes() as usize).map(integer).collect()
}

/// `length` bytes from `start`; or a mistake that names the holder which they are outside of.
fn range<'b>(
    bytes: &'b [u8],
    start: u64,
    length: u64,
    at: &str,
    holder: impl FnOnce() -> String,
) -> Result<&'b [u8], GltfError> {
    let end = start.saturating_add(length);
    let inside =
        usize::try_from(start).ok().zip(usize::try_from(end).ok()).and_then(|(start, end)| bytes.get(start..end));
    inside.ok_or_else(|| Problem::Range { start, end, holder: holder(), has: bytes.len() as u64 }.at(at))
}
