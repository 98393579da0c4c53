//! The blocks of `shaders/include/scene.glsl`, which hold for a whole frame.
//!
//! The shaders' world space has its origin at the camera. The shift is taken here in 64 bits, so that a scene far from its
//! own origin doesn't shake.

use super::block::Block;
use super::clusters::Clusters;
use crate::scene::{AlphaMode, Camera, Scene};
use glam::{DMat3, DMat4, DVec3, Mat4, Vec3};

/// Clip space from the shaders' world space. `aspect` is width over height.
///
/// Depth is reversed: 1 on the near plane, 0 on the far plane, or infinitely far if there is none. Clip space is Vulkan's: y
/// down.
pub(super) fn world_to_clip(camera: &Camera, aspect: f64) -> DMat4 {
    let rotation = DMat4::from_mat3(DMat3::from_mat4(camera.transform).inverse());
    camera.projection(aspect).as_dmat4() * rotation
}

/// The transform for a picture that is shifted to the right and down by shares of its width and height.
pub(super) fn shifted(world_to_clip: DMat4, [right, down]: [f64; 2]) -> DMat4 {
    // Clip space is two wide and two high; before the division by w everything in it is w times as large.
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| world_to_clip.row(row));
    DMat4::from_cols(x + w * (2.0 * right), y + w * (2.0 * down), z, w).transpose()
}

/// The transform of an eye, a camera or the sun.
#[derive(Debug, Clone, Copy)]
pub(super) struct ViewTransform {
    /// Clip space from the shaders' world space, whose origin is at the camera.
    pub(super) world_to_clip: DMat4,
    /// The eye's place in world space.
    pub(super) eye: DVec3,
}

/// The block `view`: the transforms of the left and the right eye.
pub(super) fn view_block(camera: &Camera, transforms: [ViewTransform; 2]) -> Vec<u8> {
    let mut block = Block::default();
    for ViewTransform { world_to_clip, eye } in transforms {
        block.mat4(world_to_clip.as_mat4());
        block.mat4(world_to_clip.inverse().as_mat4());
        block.vec3(camera.position().as_vec3().to_array());
        block.vec3(eye.as_vec3().to_array());
        block.align();
    }
    block.bytes()
}

/// Sun, ambient light, sky and point lights, these in the order of `clusters`.
pub(super) fn lights_block(scene: &Scene, camera: &Camera, clusters: &Clusters) -> Vec<u8> {
    let mut block = Block::default();
    block.vec3((-Vec3::from(scene.sun.direction)).to_array());
    block.uint(u32::try_from(scene.point_lights.len()).unwrap_or(u32::MAX));
    block.vec3(scene.sun.color);
    block.vec3(scene.ambient);
    block.float(if scene.point_lights.is_empty() { 0.0 } else { scene.nearest_to_light() as f32 });
    block.vec3(scene.sky.zenith);
    block.vec3(scene.sky.horizon);
    block.vec3(scene.sky.ground);
    block.uint(clusters.everywhere);
    for light in clusters.order.iter().map(|number| &scene.point_lights[*number as usize]) {
        block.vec3(from_camera(camera, DVec3::from(light.position)).as_vec3().to_array());
        block.float(light.range.map_or(0.0, f32::recip));
        block.vec3(light.color.map(|channel| channel * light.intensity));
        block.align();
    }
    block.bytes()
}

/// Matrices and material factors of every object, in the scene's order.
pub(super) fn objects_block(scene: &Scene, camera: &Camera) -> Vec<u8> {
    let mut block = Block::default();
    for object in &scene.objects {
        let material = &scene.materials[object.material];
        let (alpha_cutoff, transparent) = match material.alpha {
            AlphaMode::Opaque => (0.0, 0),
            AlphaMode::Mask { cutoff } => (cutoff, 0),
            AlphaMode::Blend => (0.0, 1),
        };
        block.mat4(object_to_world(camera, object.transform));
        block.mat3(object.normal_matrix());
        let [red, green, blue, alpha] = material.base_color;
        // Transparent objects fade by their opacity.
        let seen = if transparent == 1 { object.shown_share() as f32 } else { 1.0 };
        block.vec4([red, green, blue, alpha * seen]);
        block.vec3(material.emissive);
        block.float(alpha_cutoff);
        block.uint(transparent);
        block.float(object.cross_fade);
        block.align();
    }
    block.bytes()
}

/// The block `motion` of `shaders/include/motion.glsl`, which holds the transforms of the frame before: for both eyes from world
/// space to clip space now and then, neither shifted, and where every object was, with the camera of then as origin.
pub(super) fn motion_block(
    scene: &Scene,
    now: [DMat4; 2],
    (before, camera_before): ([DMat4; 2], &Camera),
    frame_before: u64,
) -> Vec<u8> {
    let mut block = Block::default();
    now.into_iter().chain(before).for_each(|matrix| block.mat4(matrix.as_mat4()));
    for object in &scene.objects {
        block.mat4(object_to_world(camera_before, object.transform_at(frame_before)));
    }
    block.bytes()
}

/// A place as seen from where the camera stands, axes unturned.
fn from_camera(camera: &Camera, place: DVec3) -> DVec3 {
    place - camera.position()
}

/// An object's transform into the shaders' world space.
fn object_to_world(camera: &Camera, transform: DMat4) -> Mat4 {
    let mut shifted = transform;
    shifted.w_axis = from_camera(camera, shifted.w_axis.truncate()).extend(1.0);
    shifted.as_mat4()
}
