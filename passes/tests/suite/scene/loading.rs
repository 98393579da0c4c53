//! Files as a whole, the shipped scene, and the camera's matrices.

use framewright_passes::scene::{Camera, Scene, SceneError, load};
use framewright_passes::twin::distance::{depth_at, distance_at};
use glam::{DVec3, DVec4, Vec3};
use std::path::{Path, PathBuf};

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The sentence that loading a file of this name and contents gives, without the folder.
fn sentence(name: &str, contents: &[u8]) -> String {
    let folder = std::env::temp_dir().join(format!("framewright-scene-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let path = folder.join(name);
    std::fs::write(&path, contents).expect("a temporary file");
    let said = load(&path).expect_err("a mistake").to_string();
    std::fs::remove_file(&path).expect("removing what was written");
    said.replace(&format!("{}/", folder.display()), "")
}

fn shipped() -> Scene {
    load(&repository("examples/scenes/spheres_and_cubes.ron")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_shipped_scene_holds_what_the_document_asks_for() {
    let scene = shipped();
    let facts = scene.facts();
    assert!(facts.has_opaque && facts.has_alpha_clip && facts.has_transparent);
    // A cube has 12 triangles, a sphere 2208.
    let meshes = &scene.meshes;
    let of = |triangles: usize| {
        scene.objects.iter().filter(move |object| meshes[object.mesh].indices.len() == 3 * triangles)
    };
    let (cubes, mut spheres) = (of(12), of(2208));
    assert!(cubes.count() >= 24 && spheres.clone().count() >= 24);
    assert!(scene.point_lights.iter().any(|light| light.intensity == 100.0));
    let white = |emissive: [f32; 3]| emissive[0] > 1.0 && emissive.iter().all(|part| *part == emissive[0]);
    assert!(spheres.any(|sphere| white(scene.materials[sphere.material].emissive)));
}

#[test]
fn every_shipped_shape_faces_outwards() {
    for mesh in &shipped().meshes {
        for triangle in mesh.indices.as_chunks::<3>().0 {
            let corner = |index: u32| Vec3::from(mesh.positions[index as usize]);
            let [a, b, c] = triangle.map(corner);
            let plane = (b - a).cross(c - a);
            assert!(plane.length() > 0.0, "no triangle is without area");
            for index in triangle {
                let normal = Vec3::from(mesh.normals[*index as usize]);
                assert!(plane.normalize().dot(normal) > 0.9, "{triangle:?}");
                let position = corner(*index);
                assert!(position.dot(normal) >= 0.0 && position.abs().max_element() <= 0.5);
            }
        }
    }
}

#[test]
fn the_same_file_gives_the_same_scene() {
    assert_eq!(shipped(), shipped());
}

#[test]
fn files_that_are_no_scene() {
    assert_eq!(sentence("scene.obj", b""), "scene.obj: a scene is a .glb, .gltf or .ron file");
    assert_eq!(sentence("scene", b""), "scene: a scene is a .glb, .gltf or .ron file");
    assert_eq!(
        sentence("\u{1b}[31m.glb", b"x"),
        "\\u{1b}[31m.glb: this is not a GLB file: it doesn't begin with `glTF`"
    );
    assert_eq!(sentence("binary.ron", b"Scene(\xff"), "binary.ron: this is not text: byte 6 is not UTF-8");
    let long = vec![b' '; (4 << 20) + 1];
    let expected = "long.ron: a scene of this kind has at most 4194304 bytes; this has more";
    assert_eq!(sentence("long.ron", &long), expected);
    let missing = load(Path::new("/nowhere/scene.glb"));
    assert!(matches!(missing, Err(SceneError::Unreadable { .. })), "{missing:?}");
    let folder = load(&repository("examples/scenes/spheres_and_cubes.ron/scene.ron"));
    assert!(matches!(folder, Err(SceneError::Unreadable { .. })), "{folder:?}");
}

#[test]
fn mistakes_in_text_are_shown_at_their_place() {
    let said = sentence("scene.ron", b"Scene(\n    version: 1,\n    materials: [],\n    objects: [Sphere()],\n)");
    assert!(said.starts_with("error: "), "{said}");
    assert!(said.contains("scene.ron:4:21"), "{said}");
}

fn camera() -> Camera {
    let (position, target) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 2.0, -7.0));
    Camera::look_at(position, target, DVec3::Y, 1.0, 0.5).expect("a direction")
}

#[test]
fn depth_is_one_on_the_near_plane_and_falls_to_zero() {
    let to_clip = camera().projection(2.0).as_dmat4() * camera().view();
    let depth = |distance: f64| {
        let clip = to_clip * DVec4::new(1.0, 2.0, 3.0 - distance, 1.0);
        clip.z / clip.w
    };
    assert!((depth(0.5) - 1.0).abs() < 1e-6);
    assert!((depth(5.0) - 0.1).abs() < 1e-6);
    assert!(depth(1e9) > 0.0 && depth(1e9) < 1e-9);
}

#[test]
fn depth_is_zero_on_a_far_plane_and_between_what_the_twin_says() {
    for (near, far) in [(0.5_f32, 40.0_f32), (1e-4, 1e8), (1.0, 1.5)] {
        let camera = Camera { near, far: Some(far), ..camera() };
        let to_clip = camera.projection(2.0).as_dmat4() * camera.view();
        let (near, far) = (f64::from(near), f64::from(far));
        for share in [0.0, 0.25, 0.5, 0.9, 1.0] {
            let distance = near * (far / near).powf(share);
            let clip = to_clip * DVec4::new(1.0, 2.0, 3.0 - distance, 1.0);
            let expected = depth_at(distance, near, Some(far));
            // The projection's numbers have 24 bits.
            let close = (clip.z / clip.w - expected).abs() <= 2e-7 * near / distance;
            assert!(close, "{near} to {far}: {} at {distance}, not {expected}", clip.z / clip.w);
            let back = distance_at(expected, near, Some(far));
            assert!(share == 1.0 || (back - distance).abs() <= 1e-6 * distance, "{distance} is seen at {back}");
        }
        assert_eq!((depth_at(near, near, Some(far)), depth_at(far, near, Some(far))), (1.0, 0.0));
    }
}

#[test]
fn the_field_of_view_reaches_the_borders_with_y_down() {
    let to_clip = camera().projection(2.0).as_dmat4() * camera().view();
    let half = 0.5f64.tan();
    let at = |x: f64, y: f64| {
        let clip = to_clip * DVec4::new(1.0 + x, 2.0 + y, 2.0, 1.0);
        (clip.x / clip.w, clip.y / clip.w)
    };
    let near = |is: (f64, f64), was: (f64, f64)| (is.0 - was.0).abs() < 1e-5 && (is.1 - was.1).abs() < 1e-5;
    assert!(near(at(0.0, half), (0.0, -1.0)), "the upper border is −1");
    assert!(near(at(2.0 * half, 0.0), (1.0, 0.0)), "twice as wide as high");
}

#[test]
fn a_camera_without_a_direction_is_none() {
    let at = |target: DVec3, up: DVec3| Camera::look_at(DVec3::ZERO, target, up, 1.0, 0.1);
    assert_eq!(at(DVec3::ZERO, DVec3::Y), None);
    assert_eq!(at(DVec3::Y, DVec3::Y), None);
    assert_eq!(at(DVec3::X, DVec3::ZERO), None);
    assert_eq!(at(DVec3::NAN, DVec3::Y), None);
    assert!(at(DVec3::X, DVec3::Y).is_some());
}
