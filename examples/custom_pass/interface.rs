use framewright::graph::frame::Draw;
use framewright::graph::shader::{
    Attribute, DrawInterface, DrawInterfaces, DrawKind, SuppliedKind, SuppliedResource, VertexBuffer,
};

/// Everything that the engine's draws bring along, what compute passes see, and the custom passes that the engine records.
pub(crate) fn interfaces() -> DrawInterfaces {
    let camera = || SuppliedResource::new(1, 0, "camera", SuppliedKind::UniformBlock);
    let only_camera = || DrawInterface { supplied: vec![camera()], ..DrawInterface::default() };
    let interfaces = DrawInterfaces::from(|draw| match draw {
        Draw::Objects(_) => DrawInterface {
            vertex_buffers: vec![VertexBuffer::of_vertices(20)],
            attributes: vec![Attribute::new("place", 2, 0), Attribute::new("tint", 3, 8)],
            supplied: vec![camera(), SuppliedResource::new(2, 0, "materials", SuppliedKind::StorageBlock)],
            ..DrawInterface::default()
        },
        Draw::Custom => only_camera(),
        _ => DrawInterface::default(),
    });
    interfaces.with(DrawKind::Compute, only_camera()).with_custom_passes(["grass", "upload"])
}
