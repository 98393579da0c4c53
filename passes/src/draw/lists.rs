//! The objects of each draw list, and their order.

use crate::scene::{Camera, Scene};
use framewright_graph::frame::DrawList;
use glam::DMat4;

/// Indices into [`Scene::objects`] of the objects in `list`, in the order of drawing for the scene's default camera.
///
/// Transparent objects run from back to front by the depth of their box's centre; the others run so that texture, mesh and
/// raster state change seldom. Equals keep the scene's order, so the same scene gives the same order everywhere.
#[must_use]
pub fn draw_order(scene: &Scene, list: DrawList) -> Vec<u32> {
    draw_order_from(scene, &scene.camera, list)
}

/// [`draw_order`] for another camera.
#[must_use]
pub fn draw_order_from(scene: &Scene, camera: &Camera, list: DrawList) -> Vec<u32> {
    let mut order: Vec<u32> = (0..)
        .zip(&scene.objects)
        .filter(|(_, object)| scene.draw_list(object) == list)
        .map(|(index, _)| index)
        .collect();
    let object = |index: u32| &scene.objects[index as usize];
    match list {
        DrawList::Opaque | DrawList::Masked => order.sort_by_key(|&index| {
            let (object, material) = (object(index), &scene.materials[object(index).material]);
            (material.base_color_texture, object.mesh, material.double_sided, object.mirrored())
        }),
        DrawList::Transparent => {
            let world_to_view = camera.transform.inverse();
            order.sort_by(|&a, &b| depth(scene, world_to_view, b).total_cmp(&depth(scene, world_to_view, a)));
        }
    }
    order
}

/// How far in front of the camera the centre of an object's box lies, metres.
fn depth(scene: &Scene, world_to_view: DMat4, index: u32) -> f64 {
    let object = &scene.objects[index as usize];
    let centre = scene.meshes[object.mesh].bounds.transformed(object.transform).center();
    -world_to_view.transform_point3(centre).z
}
