//! The meshes of a scene in one vertex and one index buffer, so that drawing object after object rebinds nothing.

use crate::scene::Scene;
use framewright_vulkan::{Buffer, BufferUsage, Device, Error, IndexType, Recorder};
use std::ops::Range;

/// All meshes, uploaded.
pub(super) struct Geometry {
    vertices: Buffer,
    indices: Buffer,
    meshes: Vec<Part>,
}

/// The place of a mesh in the buffers.
struct Part {
    indices: Range<u32>,
    base_vertex: i32,
}

impl Geometry {
    /// Uploads the meshes of a scene.
    ///
    /// # Errors
    /// Too little memory, or more vertices or indices than 32 bits can count.
    pub(super) fn new(device: &Device, scene: &Scene) -> Result<Geometry, Error> {
        let too_many =
            || Error::BadResource { what: "the scene has more vertices or indices than 32 bits can count".to_owned() };
        let (mut vertices, mut indices, mut meshes) = (Vec::new(), Vec::new(), Vec::new());
        let (mut vertex_count, mut index_count) = (0_usize, 0_u32);
        for mesh in &scene.meshes {
            let base_vertex = i32::try_from(vertex_count).map_err(|_| too_many())?;
            let count = u32::try_from(mesh.indices.len()).map_err(|_| too_many())?;
            let end = index_count.checked_add(count).ok_or_else(too_many)?;
            meshes.push(Part { indices: index_count..end, base_vertex });
            index_count = end;
            vertex_count += mesh.positions.len();
            for ((position, normal), uv) in mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs) {
                let components = position.iter().chain(normal).chain(uv);
                vertices.extend(components.flat_map(|component| component.to_ne_bytes()));
            }
            indices.extend(mesh.indices.iter().flat_map(|index| index.to_ne_bytes()));
        }
        Ok(Geometry {
            vertices: device.buffer(BufferUsage::Vertex, &vertices)?,
            indices: device.buffer(BufferUsage::Index, &indices)?,
            meshes,
        })
    }

    /// Binds both buffers.
    pub(super) fn bind(&self, recorder: &mut Recorder<'_>) {
        recorder.bind_vertex_buffer(&self.vertices);
        recorder.bind_index_buffer(&self.indices, IndexType::U32);
    }

    /// Draws a mesh for one object. The buffers are bound.
    pub(super) fn draw(&self, mesh: usize, object: u32, recorder: &mut Recorder<'_>) {
        let Part { indices, base_vertex } = &self.meshes[mesh];
        recorder.draw_indexed(indices.clone(), *base_vertex, object..object + 1);
    }
}
