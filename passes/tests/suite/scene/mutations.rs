//! Files with changed bytes: reading any of them ends in a scene or a sentence.

use crate::scene::fixtures;
use framewright_graph::base::{Sources, render};
use framewright_passes::scene::{Scene, gltf, text};
use proptest::prelude::*;

/// The promises of a scene to its draw source.
fn is_sound(scene: &Scene) {
    for mesh in &scene.meshes {
        let vertices = mesh.positions.len();
        assert!(vertices >= 3 && mesh.normals.len() == vertices && mesh.uvs.len() == vertices);
        assert!(mesh.indices.len().is_multiple_of(3) && mesh.indices.iter().all(|index| (*index as usize) < vertices));
        assert!(mesh.positions.as_flattened().iter().all(|part| part.is_finite()));
        assert!(mesh.normals.iter().all(|normal| (glam::Vec3::from(*normal).length() - 1.0).abs() < 1e-5));
        assert!(mesh.uvs.as_flattened().iter().all(|part| part.is_finite()));
    }
    for object in &scene.objects {
        assert!(object.mesh < scene.meshes.len() && object.material < scene.materials.len());
        assert!(object.transform.is_finite() && object.normal_matrix().is_finite());
    }
    for material in &scene.materials {
        assert!(material.base_color_texture.is_none_or(|texture| texture < scene.textures.len()));
        assert!(material.base_color.iter().all(|part| (0.0..=1.0).contains(part)));
        assert!(material.emissive.iter().all(|part| part.is_finite() && *part >= 0.0));
    }
    for texture in &scene.textures {
        assert_eq!(texture.rgba8.len(), 4 * texture.width as usize * texture.height as usize);
    }
    assert!(scene.mistakes.iter().all(|mistake| !mistake.is_empty()));
    let camera = scene.camera;
    assert!(camera.transform.is_finite() && camera.near > 0.0 && camera.view().is_finite());
    assert!(camera.projection(1.5).is_finite());
}

#[test]
fn what_the_fixtures_give_is_sound() {
    for (name, bytes) in fixtures::all() {
        is_sound(&gltf::read_glb(&bytes, None).unwrap_or_else(|error| panic!("{name}: {error}")));
    }
}

#[test]
fn every_file_cut_short_is_an_error() {
    for (name, bytes) in fixtures::all() {
        for length in (0..bytes.len()).step_by(7) {
            assert!(gltf::read_glb(&bytes[..length], None).is_err(), "{name} of {length} bytes loads");
        }
    }
}

/// Digits become other digits, so that the JSON stays JSON and its numbers lie.
fn relabel(byte: u8, by: u8) -> u8 {
    if byte.is_ascii_digit() { b'0' + (byte - b'0' + by) % 10 } else { byte }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn flipped_bytes_never_panic(
        file in 0usize..8,
        flips in prop::collection::vec((any::<prop::sample::Index>(), 1u8..), 1..6),
    ) {
        let mut bytes = fixtures::all().swap_remove(file).1;
        for (at, flip) in flips {
            let at = at.index(bytes.len());
            bytes[at] ^= flip;
        }
        if let Ok(scene) = gltf::read_glb(&bytes, None) {
            is_sound(&scene);
        }
    }

    #[test]
    fn lying_numbers_never_panic(
        file in 0usize..8,
        lies in prop::collection::vec((any::<prop::sample::Index>(), 1u8..10), 1..12),
    ) {
        let mut bytes = fixtures::all().swap_remove(file).1;
        let json = 20..20 + u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
        for (at, by) in lies {
            let digits: Vec<usize> = json.clone().filter(|at| bytes[*at].is_ascii_digit()).collect();
            let at = digits[at.index(digits.len())];
            bytes[at] = relabel(bytes[at], by);
        }
        if let Ok(scene) = gltf::read_glb(&bytes, None) {
            is_sound(&scene);
        }
    }

    #[test]
    fn text_with_parts_moved_about_never_panics(
        cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), 0usize..40), 1..4),
    ) {
        let mut characters: Vec<char> = SHIPPED.chars().collect();
        for (from, to, length) in cuts {
            let from = from.index(characters.len());
            let part: Vec<char> = characters.drain(from..(from + length).min(characters.len())).collect();
            let to = to.index(characters.len() + 1);
            characters.splice(to..to, part);
        }
        let mut sources = Sources::default();
        match text::read(&mut sources, "moved.ron", "moved.ron", characters.into_iter().collect()) {
            Ok(scene) => is_sound(&scene),
            Err(mistakes) => prop_assert!(render(&sources, &mistakes).starts_with("error: ")),
        }
    }
}

const SHIPPED: &str = include_str!("../../../../examples/scenes/spheres_and_cubes.ron");
