//! A primitive becomes a list of triangles.

use super::accessor::{Data, TEXTURE_COORDINATES};
use super::document::{Document, Primitive};
use super::notes::Notes;
use super::problem::{GltfError, Problem, at_most_in_all};
use crate::scene::limits;
use crate::scene::model::{Bounds, Mesh};
use glam::Vec3;

/// Vertices and indices of all primitives so far.
#[derive(Debug, Default)]
pub(super) struct Budget {
    vertices: usize,
    indices: usize,
}

impl Budget {
    fn take(&mut self, vertices: usize, indices: usize, at: &str) -> Result<(), GltfError> {
        self.vertices = self.vertices.saturating_add(vertices);
        self.indices = self.indices.saturating_add(indices);
        let fits = |what, is: usize, limit: usize| at_most_in_all(what, is as u64, limit as u64, at);
        fits("vertices of all meshes up to here", self.vertices, limits::VERTICES)?;
        fits("indices of all meshes up to here", self.indices, limits::INDICES)
    }
}

/// Reads a primitive; `None` if it has no triangles (points and lines aren't drawn).
pub(super) fn read(
    data: &Data<'_>,
    primitive: &Primitive,
    at: &str,
    budget: &mut Budget,
    notes: &mut Notes,
) -> Result<Option<Mesh>, GltfError> {
    let mode = Mode::of(primitive, at)?;
    let Some(mode) = mode else {
        notes.add(format!("{at}: points and lines are not drawn"));
        return Ok(None);
    };
    if !primitive.targets.is_empty() {
        notes.add(format!("{at}: morph targets are ignored"));
    }
    if primitive.attributes.keys().any(|name| name.starts_with("COLOR_")) {
        notes.add(format!("{at}: vertex colours are ignored"));
    }
    let positions = *primitive.attributes.get("POSITION").ok_or_else(|| Problem::NoPositions.at(at))?;
    // Without values of their own all corners are one.
    for accessor in [Some(positions), primitive.indices].into_iter().flatten() {
        data.holds_values(accessor, at)?;
    }
    let positions = data.vectors::<3>(positions, "positions", at)?;
    let vertices = positions.len();
    let corners = match primitive.indices {
        Some(indices) => data.indices(indices, at)?,
        None => (0..vertices as u32).collect(),
    };
    if let Some((number, index)) = corners.iter().enumerate().find(|(_, index)| **index as usize >= vertices) {
        let at = primitive.indices.map_or_else(String::new, |accessor| format!("accessor {accessor}"));
        return Err(Problem::Index { at: number, index: *index, vertices }.at(&at));
    }
    let indices = mode.triangles(&corners).ok_or_else(|| Problem::Corners(corners.len()).at(at))?;
    let normals = match primitive.attributes.get("NORMAL") {
        Some(accessor) => unit(per_vertex(data.vectors::<3>(*accessor, "normals", at)?, vertices, *accessor)?),
        None => None,
    };
    if normals.is_none() && primitive.attributes.contains_key("NORMAL") {
        notes.add(format!("{at}: some normals have no length, so all are computed"));
    }
    let uvs = match texture_coordinates(data.document, primitive).and_then(|name| primitive.attributes.get(&name)) {
        Some(accessor) => per_vertex(data.vectors::<2>(*accessor, TEXTURE_COORDINATES, at)?, vertices, *accessor)?,
        None => vec![[0.0; 2]; vertices],
    };
    let bounds = Bounds::of(&positions).ok_or_else(|| Problem::NoPositions.at(at))?;
    let taken = if normals.is_some() { vertices } else { indices.len() };
    budget.take(taken, indices.len(), at)?;
    Ok(Some(match normals {
        Some(normals) => Mesh { positions, normals, uvs, indices, bounds },
        None => flat_shaded(&positions, &uvs, &indices, bounds),
    }))
}

/// A mesh whose triangles share no vertices, each with the normal of its plane: how glTF wants meshes without normals
/// (glTF 2.0, section 3.7.2.1). A triangle without area has no plane and gets the normal +y; it can't be seen.
fn flat_shaded(positions: &[[f32; 3]], uvs: &[[f32; 2]], indices: &[u32], bounds: Bounds) -> Mesh {
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

/// How corners make triangles.
#[derive(Debug, Clone, Copy)]
enum Mode {
    Triangles,
    Strip,
    Fan,
}

impl Mode {
    /// The primitive's mode; `None` for points and lines.
    fn of(primitive: &Primitive, at: &str) -> Result<Option<Mode>, GltfError> {
        match primitive.mode.unwrap_or(4) {
            0..=3 => Ok(None),
            4 => Ok(Some(Mode::Triangles)),
            5 => Ok(Some(Mode::Strip)),
            6 => Ok(Some(Mode::Fan)),
            other => Err(Problem::Word { what: "mode", is: other.to_string(), expected: "0 to 6" }.at(at)),
        }
    }

    /// Three indices a triangle (glTF 2.0, section 3.7.2.1); `None` where the corners don't make whole triangles.
    fn triangles(self, corners: &[u32]) -> Option<Vec<u32>> {
        let count = corners.len();
        if count < 3 || matches!(self, Mode::Triangles) && !count.is_multiple_of(3) {
            return None;
        }
        Some(match self {
            Mode::Triangles => corners.to_vec(),
            Mode::Strip => {
                (0..count - 2).flat_map(|i| [corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]]).collect()
            }
            Mode::Fan => (1..count - 1).flat_map(|i| [corners[i], corners[i + 1], corners[0]]).collect(),
        })
    }
}

/// The attribute that the material's texture asks for.
fn texture_coordinates(document: &Document, primitive: &Primitive) -> Option<String> {
    let material = document.materials.get(usize::try_from(primitive.material?).ok()?)?.as_ref()?;
    let texture = material.pbr_metallic_roughness.base_color_texture.as_ref()?;
    Some(format!("TEXCOORD_{}", texture.tex_coord))
}

fn per_vertex<T>(values: Vec<T>, vertices: usize, accessor: u64) -> Result<Vec<T>, GltfError> {
    if values.len() == vertices {
        return Ok(values);
    }
    Err(Problem::Count { count: values.len(), vertices }.at(&format!("accessor {accessor}")))
}

/// Normals at length 1; `None` if one has no direction.
fn unit(normals: Vec<[f32; 3]>) -> Option<Vec<[f32; 3]>> {
    let normalize = |normal| glam::Vec3::from_array(normal).as_dvec3().try_normalize();
    normals.into_iter().map(|normal| normalize(normal).map(|unit| unit.as_vec3().to_array())).collect()
}
