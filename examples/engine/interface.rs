use framewright::graph::frame::Draw;
use framewright::graph::shader::{Attribute, DrawInterface, DrawInterfaces, Supplied, SuppliedKind};

/// Everything that the engine's draws bring along, and the custom passes that it records.
pub(crate) fn interfaces() -> DrawInterfaces {
    let camera = || Supplied::new(1, 0, "camera", SuppliedKind::UniformBlock);
    let interfaces = DrawInterfaces::from(|draw| match draw {
        Draw::Objects(_) => DrawInterface {
            vertex_stride: 20,
            attributes: vec![Attribute::new("place", 2, 0), Attribute::new("tint", 3, 8)],
            supplied: vec![camera(), Supplied::new(2, 0, "materials", SuppliedKind::StorageBlock)],
        },
        Draw::Custom => DrawInterface { supplied: vec![camera()], ..DrawInterface::default() },
        _ => DrawInterface::default(),
    });
    interfaces.with_custom_passes(["grass", "upload"])
}
