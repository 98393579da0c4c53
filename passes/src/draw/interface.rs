//! The interface of every kind of draw: vertex attributes, and the resources of `shaders/include/scene.glsl`,
//! `shaders/include/motion.glsl` and `shaders/include/material.glsl`.

use framewright_graph::frame::Draw;
use framewright_graph::shader::{
    Attribute, DrawInterface, DrawInterfaces, DrawKind, SuppliedKind, SuppliedResource, VertexBuffer,
};

/// The set with the resources of a frame.
pub const FRAME_SET: u32 = 1;
/// The set with the resources of a material.
pub const MATERIAL_SET: u32 = 2;
/// Binding of the camera, in [`FRAME_SET`].
pub const VIEW_BINDING: u32 = 0;
/// Binding of sun, sky and point lights, in [`FRAME_SET`].
pub const LIGHTS_BINDING: u32 = 1;
/// Binding of matrices and material factors by object, in [`FRAME_SET`].
pub const OBJECTS_BINDING: u32 = 2;
/// Binding of the cascaded shadow maps' transforms, in [`FRAME_SET`].
pub const CASCADES_BINDING: u32 = 3;
/// Binding of the light clusters, in [`FRAME_SET`].
pub const CLUSTERS_BINDING: u32 = 4;
/// Binding of the transforms of the frame before, in [`FRAME_SET`].
pub const MOTION_BINDING: u32 = 5;
/// Binding of the base colour's texture, in [`MATERIAL_SET`].
pub const BASE_COLOR_TEXTURE_BINDING: u32 = 0;

/// Everything that the shipped draw source binds for each kind of draw, and for compute passes: those see the set of the frame.
/// It is known without a device, so `check` can compare shaders with it.
#[must_use]
pub fn interfaces() -> DrawInterfaces {
    let compute = DrawInterface { supplied: of_frame(), ..DrawInterface::default() };
    DrawInterfaces::from(interface).with(DrawKind::Compute, compute)
}

/// Everything that the shipped draw source binds for a kind of draw.
///
/// The sky, full-screen draws and draws of a pass's own vertices are given the same frame set as objects, so that one bind group serves
/// all; custom draws are given only the resources of their pass.
#[must_use]
pub fn interface(draw: Draw) -> DrawInterface {
    let mut supplied = of_frame();
    match draw {
        Draw::Objects(_) | Draw::Casters(_) => {
            let texture = SuppliedKind::SampledImage;
            supplied.push(SuppliedResource::new(
                MATERIAL_SET,
                BASE_COLOR_TEXTURE_BINDING,
                "base_color_texture",
                texture,
            ));
            DrawInterface {
                vertex_buffers: vec![VertexBuffer::of_vertices(32)],
                attributes: vec![
                    Attribute::new("position", 3, 0),
                    Attribute::new("normal", 3, 12),
                    Attribute::new("uv", 2, 24),
                ],
                supplied,
                ..DrawInterface::default()
            }
        }
        Draw::Sky | Draw::FullScreen | Draw::Vertices { .. } | Draw::Indirect | Draw::Indirects(_) => {
            DrawInterface { supplied, ..DrawInterface::default() }
        }
        Draw::Custom => DrawInterface::default(),
    }
}

/// The resources of [`FRAME_SET`].
fn of_frame() -> Vec<SuppliedResource> {
    let frame = |binding, name, kind| SuppliedResource::new(FRAME_SET, binding, name, kind);
    vec![
        frame(VIEW_BINDING, "view", SuppliedKind::UniformBlock),
        frame(LIGHTS_BINDING, "lights", SuppliedKind::StorageBlock),
        frame(OBJECTS_BINDING, "objects", SuppliedKind::StorageBlock),
        frame(CASCADES_BINDING, "cascades", SuppliedKind::UniformBlock),
        frame(CLUSTERS_BINDING, "clusters", SuppliedKind::StorageBlock),
        frame(MOTION_BINDING, "motion", SuppliedKind::StorageBlock),
    ]
}
