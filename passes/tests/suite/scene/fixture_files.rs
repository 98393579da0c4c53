//! The committed GLB files are what the code makes, and load as what they were made to be.

use crate::scene::fixtures;
use framewright_passes::scene::{AlphaMode, Scene, Wrap, gltf};
use glam::{DVec3, Vec3};

/// Set to write the files anew.
const ACCEPT: &str = "FRAMEWRIGHT_ACCEPT";

#[test]
fn the_committed_files_are_what_the_code_makes() {
    let accept = std::env::var_os(ACCEPT).is_some();
    for (name, made) in fixtures::all() {
        let path = fixtures::folder().join(name);
        if accept {
            std::fs::write(&path, &made).expect("tests/glb is writable");
        }
        let committed = std::fs::read(&path).unwrap_or_default();
        assert!(
            committed == made,
            "{} differs from what passes/tests/suite/scene/fixtures makes; to accept the new one:\n  \
             {ACCEPT}=1 cargo test -p framewright-passes --test suite scene",
            path.display()
        );
    }
}

fn fixture(name: &str) -> Scene {
    let bytes = fixtures::all().into_iter().find(|(known, _)| *known == name).expect("a known fixture").1;
    let scene = gltf::read_glb(&bytes, None).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(scene.notes, Vec::<String>::new(), "{name}");
    scene
}

fn object<'s>(scene: &'s Scene, name: &str) -> &'s framewright_passes::scene::Object {
    scene.objects.iter().find(|object| object.name == name).unwrap_or_else(|| panic!("no object {name}"))
}

#[test]
fn every_width_of_indices_gives_the_same_triangles() {
    let scene = fixture("indices.glb");
    let corners = |name: &str| {
        let mesh = &scene.meshes[object(&scene, name).mesh];
        mesh.indices.iter().map(|index| mesh.positions[*index as usize]).collect::<Vec<_>>()
    };
    assert_eq!(corners("u8").len(), 24);
    assert_eq!(corners("u16"), corners("u8"));
    assert_eq!(corners("u32"), corners("u8"));
    assert_eq!(corners("none"), corners("u8"));
}

#[test]
fn strips_and_fans_face_the_way_that_lists_do() {
    let scene = fixture("indices.glb");
    for name in ["strip", "fan"] {
        let mesh = &scene.meshes[object(&scene, name).mesh];
        assert_eq!(mesh.indices.len(), 6, "{name}");
        for triangle in mesh.indices.as_chunks::<3>().0 {
            let [a, b, c] = triangle.map(|index| Vec3::from(mesh.positions[index as usize]));
            assert!((b - a).cross(c - a).z > 0.9, "{name}");
        }
    }
}

#[test]
fn sparse_positions_replace_the_ones_below() {
    let scene = fixture("indices.glb");
    let bounds = scene.meshes[object(&scene, "sparse").mesh].bounds;
    assert_eq!((bounds.min, bounds.max), (DVec3::new(-0.5, -0.5, 0.0), DVec3::new(0.5, 1.0, 0.0)));
}

#[test]
fn missing_normals_are_those_of_the_triangles() {
    let scene = fixture("attributes.glb");
    let smooth = &scene.meshes[object(&scene, "smooth").mesh];
    let flat = &scene.meshes[object(&scene, "no normals").mesh];
    assert_eq!((smooth.positions.len(), flat.positions.len()), (6, 24));
    let share = 1.0 / 3.0f32.sqrt();
    for normal in &flat.normals {
        assert!(normal.iter().all(|part| (part.abs() - share).abs() < 1e-6), "{normal:?}");
    }
    for (position, normal) in flat.positions.iter().zip(&flat.normals) {
        assert!(Vec3::from(*position).dot(Vec3::from(*normal)) > 0.0, "outwards");
    }
}

#[test]
fn texture_coordinates_are_the_same_in_every_form_and_zero_where_missing() {
    let scene = fixture("attributes.glb");
    let uvs = |name: &str| scene.meshes[object(&scene, name).mesh].uvs.clone();
    assert_eq!(uvs("f32 uvs"), vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
    assert_eq!(uvs("u8 uvs"), uvs("f32 uvs"));
    assert_eq!(uvs("u16 uvs"), uvs("f32 uvs"));
    assert_eq!(uvs("no uvs, textured"), vec![[0.0; 2]; 4]);
}

#[test]
fn each_primitive_is_an_object_and_one_without_material_is_white() {
    let scene = fixture("attributes.glb");
    assert_eq!(scene.objects.len(), 10);
    let second = object(&scene, "two primitives, primitive 1");
    assert_eq!(scene.materials[second.material].base_color, [1.0; 4]);
    assert_eq!(second.transform, object(&scene, "two primitives").transform);
}

#[test]
fn textures_keep_their_texels_and_their_borders() {
    let scene = fixture("textures.glb");
    let texture = |name: &str| {
        let material = &scene.materials[object(&scene, name).material];
        &scene.textures[material.base_color_texture.expect("a texture")]
    };
    assert_eq!(texture("png").rgba8[..8], [220, 40, 40, 255, 40, 180, 60, 255]);
    let wraps = |name: &str| (texture(name).sampler.wrap_u, texture(name).sampler.wrap_v);
    assert_eq!(wraps("repeat"), (Wrap::Repeat, Wrap::Repeat));
    assert_eq!(wraps("mirror"), (Wrap::MirroredRepeat, Wrap::MirroredRepeat));
    assert_eq!(wraps("clamp"), (Wrap::ClampToEdge, Wrap::ClampToEdge));
    assert_eq!(wraps("mixed"), (Wrap::ClampToEdge, Wrap::MirroredRepeat));
    let jpeg = texture("jpeg");
    assert_eq!((jpeg.width, jpeg.height), (16, 16));
    for (is, was) in jpeg.rgba8.iter().zip([220, 40, 40, 255]) {
        assert!(is.abs_diff(was) <= 4, "{is} is not near {was}");
    }
    assert_eq!(scene.materials[object(&scene, "tinted").material].base_color, [1.0, 0.5, 0.25, 1.0]);
    assert_eq!(scene.meshes[object(&scene, "second set").mesh].uvs[0], [0.0, 1.0], "the set that the material names");
}

#[test]
fn alpha_modes_come_with_their_cut_offs() {
    let scene = fixture("alpha.glb");
    let alpha = |name: &str| scene.materials[object(&scene, name).material].alpha;
    assert_eq!(alpha("opaque ignores alpha"), AlphaMode::Opaque);
    assert_eq!(alpha("default is opaque"), AlphaMode::Opaque);
    assert_eq!(alpha("masked away"), AlphaMode::Mask { cutoff: 0.5 });
    assert_eq!(alpha("mask keeps at the cut-off"), AlphaMode::Mask { cutoff: 0.25 });
    assert_eq!(alpha("blend"), AlphaMode::Blend);
    let facts = scene.facts();
    assert!(facts.has_opaque && facts.has_alpha_clip && facts.has_transparent);
}

#[test]
fn facts_say_what_is_not_there() {
    let facts = fixture("transforms.glb").facts();
    assert!(facts.has_opaque && !facts.has_alpha_clip && !facts.has_transparent);
}

#[test]
fn emissive_strength_is_multiplied_in() {
    let scene = fixture("emissive.glb");
    let emissive = |name: &str| scene.materials[object(&scene, name).material].emissive;
    assert_eq!(emissive("dark"), [0.0; 3]);
    assert_eq!(emissive("white"), [1.0; 3]);
    assert_eq!(emissive("white times 8"), [8.0; 3]);
    assert_eq!(emissive("blue times 0.5"), [0.05, 0.1, 0.5]);
    assert_eq!(emissive("strength alone"), [0.0; 3]);
}

#[test]
fn nested_transforms_multiply_from_the_top() {
    let scene = fixture("transforms.glb");
    // 0.75 · (the leaf's corner, a quarter turn about y, half a metre up), then the top's translation.
    let leaf = object(&scene, "leaf").transform.transform_point3(DVec3::new(0.5, -0.5, -0.5));
    assert!(leaf.abs_diff_eq(DVec3::new(6.0 - 0.375, -6.0, -0.375), 1e-6), "{leaf}");
    let twin = object(&scene, "mirrored twin").transform.transform_point3(DVec3::new(0.5, -0.5, -0.5));
    assert!(twin.abs_diff_eq(DVec3::new(6.0 - 0.375, -6.0 + 0.75 * 2.5, -0.375), 1e-6), "{twin}");
    let sheared = object(&scene, "sheared by a matrix").transform.transform_point3(DVec3::new(0.5, 0.5, 0.0));
    assert!(sheared.abs_diff_eq(DVec3::new(4.0 + 0.6 + 0.2, -2.0 + 0.5, 0.0), 1e-6), "{sheared}");
    assert_eq!(object(&scene, "leaf").mesh, object(&scene, "mirrored twin").mesh, "one mesh, two places");
}

#[test]
fn an_odd_number_of_negative_scales_mirrors() {
    let scene = fixture("transforms.glb");
    let mirrored: Vec<&str> =
        scene.objects.iter().filter(|object| object.mirrored()).map(|object| object.name.as_str()).collect();
    assert_eq!(mirrored, ["mirrored in x", "mirrored in all", "mirrored twin"]);
}

#[test]
fn normals_point_outwards_under_every_transform() {
    let scene = fixture("transforms.glb");
    for object in &scene.objects {
        let mesh = &scene.meshes[object.mesh];
        let middle = object.transform.transform_point3(DVec3::splat(-0.05));
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let outwards = object.transform.transform_point3(Vec3::from(*position).as_dvec3()) - middle;
            let normal = object.normal_matrix() * Vec3::from(*normal);
            assert!(outwards.dot(normal.as_dvec3()) > 0.0, "{}: {position:?}", object.name);
        }
    }
}

#[test]
fn sides_are_told_apart() {
    let scene = fixture("sides.glb");
    let facts: Vec<(bool, bool)> =
        scene.objects.iter().map(|object| (scene.materials[object.material].double_sided, object.mirrored())).collect();
    let (one, two) = (false, true);
    assert_eq!(facts, [(one, false), (one, false), (two, false), (two, false), (one, true), (one, true)]);
}

#[test]
fn a_camera_in_the_file_is_used_without_its_scale() {
    let scene = fixture("camera_and_lights.glb");
    let camera = scene.camera;
    assert_eq!(scene.camera_named(Some("eye")), Some(&camera));
    assert_eq!((camera.vertical_fov, camera.near, camera.far), (0.8, 0.05, Some(100.0)));
    let (sin, cos) = 0.4f64.sin_cos();
    assert!(camera.position().abs_diff_eq(DVec3::new(1.0 + 5.0 * sin, 0.25, 5.0 * cos), 1e-5), "{}", camera.position());
    let forward = camera.transform.transform_vector3(DVec3::NEG_Z);
    assert!(forward.abs_diff_eq(DVec3::new(-sin, 0.0, -cos), 1e-6), "{forward}");
}

#[test]
fn lights_in_the_file_replace_the_default_sun() {
    let scene = fixture("camera_and_lights.glb");
    assert!(Vec3::from(scene.sun.direction).abs_diff_eq(Vec3::NEG_Y, 1e-6), "{:?}", scene.sun);
    let near = |is: f32, was: f64| (f64::from(is) - was).abs() < 1e-6 * was;
    // All light of the file by one factor.
    let as_in_file = |light: f64| light / std::f64::consts::PI * scene.exposure;
    assert!(near(scene.sun.color[0], as_in_file(3.0)));
    let [lamp] = scene.point_lights[..] else { panic!("one lamp") };
    assert_eq!((lamp.position, lamp.color, lamp.range), ([1.0, 2.0, 2.0], [0.5, 0.7, 1.0], Some(8.0)));
    assert!(near(lamp.intensity, as_in_file(40.0)));
}

#[test]
fn a_file_without_camera_is_framed_whole() {
    for (name, bytes) in fixtures::all().into_iter().filter(|(name, _)| *name != "camera_and_lights.glb") {
        let scene = gltf::read_glb(&bytes, None).expect("loads");
        let to_clip = scene.camera.projection(1.0).as_dmat4() * scene.camera.view();
        for object in &scene.objects {
            for position in &scene.meshes[object.mesh].positions {
                let clip = to_clip * (object.transform * Vec3::from(*position).as_dvec3().extend(1.0));
                let inside = clip.x.abs() < clip.w && clip.y.abs() < clip.w && clip.z > 0.0 && clip.z < clip.w;
                assert!(inside, "{name}: {} sticks out at {clip}", object.name);
            }
        }
    }
}

#[test]
fn the_khronos_sample_models_load() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/models");
    if !folder.is_dir() {
        return eprintln!("skipped: {} is not there", folder.display());
    }
    let expected = [
        ("Duck.glb", 1, 4212, (true, false)),
        ("BoxTextured.glb", 1, 12, (true, false)),
        ("CesiumMilkTruck.glb", 5, 0, (true, false)),
        ("AlphaBlendModeTest.glb", 9, 0, (true, true)),
    ];
    for (name, objects, triangles, (opaque, clipped)) in expected {
        let scene = framewright_passes::scene::load(&folder.join(name)).unwrap_or_else(|error| panic!("{error}"));
        let facts = scene.facts();
        assert_eq!((scene.objects.len(), facts.has_opaque, facts.has_alpha_clip), (objects, opaque, clipped), "{name}");
        if triangles > 0 {
            assert_eq!(scene.meshes[0].indices.len() / 3, triangles, "{name}");
        }
    }
}
