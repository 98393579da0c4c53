//! Triangle meshes.

use super::bounds::Bounds;
use glam::{DMat4, DVec3, Vec3};

/// A list of triangles. `positions`, `normals` and `uvs` have the same length, at least 3.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Positions in the mesh's own space, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, `(0, 0)` the top left corner of the texture; zeros where the file has none.
    pub uvs: Vec<[f32; 2]>,
    /// Three a triangle, counter-clockwise seen from the front; each less than the number of positions.
    pub indices: Vec<u32>,
    /// The box around the positions.
    pub bounds: Bounds,
}

impl Mesh {
    /// Whether any triangle has an area where the mesh stands.
    pub(crate) fn has_area(&self, transform: DMat4) -> bool {
        self.indices.as_chunks::<3>().0.iter().any(|triangle| {
            let corner = |index: u32| transform.transform_point3(Vec3::from(self.positions[index as usize]).as_dvec3());
            let [a, b, c] = triangle.map(corner);
            (b - a).cross(c - a) != DVec3::ZERO
        })
    }
}
