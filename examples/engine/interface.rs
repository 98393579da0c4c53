//! All that passes see of the engine. `to_ron()` writes it to interface.ron, for `framewright check`.

use framewright::graph::frame::Draw;
use framewright::graph::shader::{
    BindingFlags, DescriptorType, DrawInterface, DrawInterfaces, ProgramBinding, ProgramSet, SuppliedKind,
    SuppliedResource,
};
use framewright::graph::vulkan::Stages;

/// The set of all textures, and as many as it has room for.
pub(crate) const TABLE: u32 = 1;
pub(crate) const ROOM: u32 = 64;
/// The set of the camera and the objects.
pub(crate) const OBJECTS: u32 = 2;

pub(crate) fn interfaces() -> DrawInterfaces {
    let supplied = [
        SuppliedResource::new(OBJECTS, 0, "Camera", SuppliedKind::UniformBlock),
        SuppliedResource::new(OBJECTS, 1, "objects", SuppliedKind::StorageBlock),
    ];
    let interfaces = DrawInterfaces::from(|draw| match draw {
        Draw::Objects(_) => DrawInterface { supplied: supplied.to_vec(), ..DrawInterface::default() },
        _ => DrawInterface::default(),
    });
    interfaces.with_set(table()).with_custom_passes(["sparks"])
}

fn table() -> ProgramSet {
    let flags = BindingFlags { partially_bound: true, ..BindingFlags::default() };
    let textures = ProgramBinding::new(0, DescriptorType::SampledImage).with_count(ROOM).with_flags(flags);
    let sampler = ProgramBinding::new(1, DescriptorType::Sampler);
    ProgramSet::new(TABLE, [textures, sampler].map(|binding| binding.with_stages(Stages::FRAGMENT_SHADER)))
}
