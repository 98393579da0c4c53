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

/// A mesh whose triangles share no vertices, each with the normal of its plane: how glTF wants meshes without normals
/// (glTF 2.0, section 3.7.2.1). A triangle without area has no plane and gets the normal +y; it can't be seen.
pub(crate) fn flat_shaded(positions: &[[f32; 3]], uvs: &[[f32; 2]], indices: &[u32], bounds: Bounds) -> Mesh {
    let corner = |index: u32| positions[index as usize];
    let normals = indices.as_chunks::<3>().0.iter().flat_map(|triangle| {
        let [a, b, c] = triangle.map(|index| Vec3::from(corner(index)).as_dvec3());
        let normal = (b - a).cross(c - a).try_normalize().map_or(Vec3::Y, |normal| normal.as_vec3());
        [normal.to_array(); 3]
    });
    Mesh {
        normals: normals.collect(),
        positions: indices.iter().map(|index| corner(*index)).collect(),
        uvs: indices.iter().map(|index| uvs[*index as usize]).collect(),
        indices: (0..indices.len() as u32).collect(),
        bounds,
    }
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
