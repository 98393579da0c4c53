//! Triangles without area, normals without direction, and transforms that leave nothing of a thing.

use framewright_passes::scene::{Bounds, Mesh, Movement, Object, Scene, load};
use framewright_passes::twin::lighting::{lit_surface, reflect_light};
use framewright_tests::raycast::RayCaster;
use framewright_tests::render::{Setup, device, in_repository, render, rgba};
use framewright_tests::shapes::{material, scene, square};
use glam::{DMat4, DVec2, DVec3, Mat4};
use std::error::Error;

const EXTENT: [u32; 2] = [72, 48];

/// A mesh of one triangle that lights up whatever it covers.
fn triangle(corners: [[f32; 3]; 3]) -> Mesh {
    let bounds = Bounds::of(&corners).unwrap_or_else(|| square().bounds);
    Mesh {
        bounds,
        positions: corners.to_vec(),
        normals: vec![[0.0; 3]; 3],
        uvs: vec![[0.0; 2]; 3],
        indices: vec![0, 1, 2],
    }
}

fn with_glowing(mut scene: Scene, meshes: Vec<Mesh>, transforms: &[DMat4]) -> Scene {
    let mut glow = material([1.0; 4]);
    glow.emissive = [30.0, 0.0, 30.0];
    glow.double_sided = true;
    scene.materials.push(glow);
    for (mesh, transform) in meshes.into_iter().flat_map(|mesh| transforms.iter().map(move |it| (mesh.clone(), *it))) {
        let object = Object {
            name: String::new(),
            mesh: scene.meshes.len(),
            material: scene.materials.len() - 1,
            transform,
            cross_fade: 1.0,
            movement: Movement::default(),
        };
        scene.meshes.push(mesh);
        scene.objects.push(object);
    }
    scene
}

/// NU-4: triangles without area and things that a scale of 0 flattens to a line or a point leave no trace, also in shadow maps,
/// the G-buffer and ambient occlusion.
#[test]
fn what_has_no_area_leaves_no_trace() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let courtyard = load(&in_repository("examples/scenes/courtyard.ron"))?;
    let degenerate = [
        [[0.0, 1.0, 2.0]; 3],
        [[-3.0, 1.0, 0.0], [3.0, 1.0, 0.0], [-3.0, 1.0, 0.0]],
        [[-3.0, 0.5, 1.0], [0.0, 1.0, 1.0], [3.0, 1.5, 1.0]],
    ];
    let scale = |x, y, z| DMat4::from_translation(DVec3::new(0.0, 1.5, 3.0)) * DMat4::from_scale(DVec3::new(x, y, z));
    let flat = with_glowing(courtyard.clone(), degenerate.map(triangle).to_vec(), &[DMat4::IDENTITY]);
    let all = with_glowing(flat, vec![square()], &[scale(0.0, 0.0, 0.0), scale(0.0, 1.5, 1.0), scale(3.0, 0.0, 0.0)]);
    for pipeline in ["forward", "deferred", "shadows", "temporal"] {
        let pipeline = format!("examples/pipelines/{pipeline}.ron");
        let picture = |scene: &Scene| render(device, &Setup { pipeline: &pipeline, set: &[], scene, extent: EXTENT });
        // Both have the facts of the scene with all: light that could be seen decides formats. Both have the scene's bounds, from
        // which shadow maps follow.
        let visible = with_glowing(courtyard.clone(), vec![square()], &[scale(1e-9, 1e-9, 1.0)]);
        let (expected, found) = (picture(&visible)?, picture(&all)?);
        assert!(expected[0].bytes == found[0].bytes, "{pipeline}: what has no area changes the picture");
        let facts = all.facts();
        assert!(facts.peak_radiance.is_finite() && facts.depth_range.is_some_and(f64::is_finite), "{facts:?}");
    }
    Ok(())
}

/// NU-4: a needle of a hundred metres by a tenth of a millimetre shows its own light or nothing in each pixel.
#[test]
fn a_needle_shows_its_own_light_or_nothing() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let needle = triangle([[-50.0, 0.3, 0.0], [50.0, 0.3, 0.0], [50.0, 0.3001, 0.0]]);
    let wide = triangle([[-50.0, -0.5, 0.0], [50.0, -0.5, 0.0], [50.0, -0.3, 0.0]]);
    let drawn = with_glowing(scene(Vec::new(), Vec::new(), Vec::new()), vec![needle, wide], &[DMat4::IDENTITY]);
    let setup = Setup { pipeline: "tests/pipelines/lit.ron", set: &[], scene: &drawn, extent: EXTENT };
    let texels = rgba(&render(device, &setup)?[0]);
    let lit = texels.iter().filter(|texel| **texel == [30.0, 0.0, 30.0, 1.0]).count();
    let empty = texels.iter().filter(|texel| **texel == [0.0; 4]).count();
    assert_eq!(lit + empty, texels.len(), "a pixel holds something else");
    // The wide one is 0.1 m high in the middle: about one row of 0.12 m.
    assert!((20..160).contains(&lit), "{lit} of {} pixels are lit", texels.len());
    Ok(())
}

/// NU-4: a surface whose normals have no length, or whose transform leaves them none, shows ambient and emitted light alone.
#[test]
fn surfaces_without_a_normal_show_ambient_and_emitted_light() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for tiny in [0.0_f32, 1e-30, f32::MIN_POSITIVE * 0.5] {
        let mut wall = square();
        wall.normals = vec![[0.0, 0.0, tiny]; 4];
        let mut scene = scene(
            vec![wall],
            vec![material([0.5, 0.6, 0.7, 1.0])],
            vec![(0, 0, Mat4::from_scale(glam::Vec3::splat(9.0)))],
        );
        scene.ambient = [0.5, 0.25, 1.0];
        scene.sun.direction = [0.0, 0.0, -1.0];
        scene.sun.color = [7.0; 3];
        scene.materials[0].emissive = [0.0, 2.0, 0.0];
        let setup = Setup { pipeline: "tests/pipelines/lit.ron", set: &[], scene: &scene, extent: EXTENT };
        let texels = rgba(&render(device, &setup)?[0]);
        let caster = RayCaster::new(&scene);
        let hit =
            caster.cast(&caster.camera_ray(DVec2::new(36.0, 24.0), EXTENT)).ok_or("the wall fills the picture")?;
        let lit = reflect_light(&scene, DVec3::ZERO, DVec3::ZERO, 1.0);
        let expected = lit_surface(&scene.materials[0], hit.base_color, &lit);
        for texel in texels {
            let close = texel.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= 1e-6 * expected);
            assert!(close, "normals of length {tiny:e}: {texel:?}, not {expected:?}");
        }
    }
    Ok(())
}
