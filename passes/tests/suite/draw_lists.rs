//! Claims about which objects are drawn by which list, and in which order.

use framewright_graph::frame::DrawList;
use framewright_passes::draw::draw_order;
use framewright_passes::scene::{AlphaMode, Bounds, Camera, Material, Mesh, Movement, Object, Scene, Sky, Sun};
use glam::{DMat4, DVec3, Vec3};

const BLACK: [f32; 3] = [0.0; 3];
const OPAQUE: usize = 0;
const TEXTURED: usize = 1;
const MASKED: usize = 2;
const TRANSPARENT: usize = 3;

/// A scene of (mesh, material, place), seen from (0, 0, 10) towards −z.
fn scene(objects: &[(usize, usize, Vec3)]) -> Scene {
    let material = |alpha, base_color_texture| Material {
        name: String::new(),
        base_color: [1.0; 4],
        base_color_texture,
        emissive: BLACK,
        alpha,
        double_sided: false,
    };
    let mesh = Mesh {
        positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        uvs: vec![[0.0, 0.0]; 3],
        indices: vec![0, 1, 2],
        bounds: Bounds { min: DVec3::ZERO, max: DVec3::new(1.0, 1.0, 0.0) },
    };
    let object = |&(mesh, material, at): &(usize, usize, Vec3)| {
        let transform = DMat4::from_translation(at.as_dvec3());
        Object { name: String::new(), mesh, material, transform, cross_fade: 1.0, movement: Movement::default() }
    };
    let camera = Camera::look_at(DVec3::Z * 10.0, DVec3::ZERO, DVec3::Y, 1.0, 0.1);
    Scene {
        meshes: vec![mesh.clone(), mesh],
        materials: vec![
            material(AlphaMode::Opaque, None),
            material(AlphaMode::Opaque, Some(0)),
            material(AlphaMode::Mask { cutoff: 0.5 }, None),
            material(AlphaMode::Blend, None),
        ],
        textures: Vec::new(),
        objects: objects.iter().map(object).collect(),
        sun: Sun { direction: [0.0, -1.0, 0.0], color: BLACK, shadows: false },
        ambient: BLACK,
        point_lights: Vec::new(),
        exposure: 1.0,
        sky: Sky { zenith: BLACK, horizon: BLACK, ground: BLACK },
        camera: camera.unwrap_or_else(|| Camera::framing(Bounds { min: DVec3::ZERO, max: DVec3::ONE })),
        cameras: Vec::new(),
        notes: Vec::new(),
        mistakes: Vec::new(),
    }
}

#[test]
fn every_object_is_in_the_list_of_its_alpha_mode_and_no_other() {
    let scene = scene(&[(0, MASKED, Vec3::ZERO), (0, TRANSPARENT, Vec3::ZERO), (0, TEXTURED, Vec3::ZERO)]);
    assert_eq!(draw_order(&scene, DrawList::Opaque), [2]);
    assert_eq!(draw_order(&scene, DrawList::Masked), [0]);
    assert_eq!(draw_order(&scene, DrawList::Transparent), [1]);
}

#[test]
fn transparent_objects_run_from_back_to_front() {
    let at = |z| (0, TRANSPARENT, Vec3::new(0.0, 0.0, z));
    let scene = scene(&[at(1.0), at(-5.0), at(3.0), at(-2.0)]);
    assert_eq!(draw_order(&scene, DrawList::Transparent), [1, 3, 0, 2]);
}

#[test]
fn depth_counts_along_the_view_and_not_along_the_ray() {
    let far_aside = (0, TRANSPARENT, Vec3::new(50.0, 0.0, 1.0));
    let straight_ahead = (0, TRANSPARENT, Vec3::new(0.0, 0.0, 0.0));
    assert_eq!(draw_order(&scene(&[far_aside, straight_ahead]), DrawList::Transparent), [1, 0]);
}

#[test]
fn equally_deep_transparent_objects_keep_the_scenes_order() {
    let at = |x| (0, TRANSPARENT, Vec3::new(x, 0.0, 0.0));
    assert_eq!(draw_order(&scene(&[at(3.0), at(-1.0), at(0.0)]), DrawList::Transparent), [0, 1, 2]);
}

#[test]
fn opaque_objects_of_one_texture_and_mesh_stand_together() {
    let objects = [(1, TEXTURED), (0, OPAQUE), (0, TEXTURED), (1, OPAQUE), (1, TEXTURED), (0, OPAQUE)];
    let objects = objects.map(|(mesh, material)| (mesh, material, Vec3::ZERO));
    assert_eq!(draw_order(&scene(&objects), DrawList::Opaque), [1, 5, 3, 2, 0, 4]);
}
