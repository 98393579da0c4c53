//! The examples of this crate draw what they say (EM-2, EM-12), and an example of the page on embedding that is unsafe (EM-1).

use crate::testing;
use framewright_passes::scene;
use framewright_tests::render::{self, Setup, in_repository};
use std::process::Command;

/// The picture has as many colours as the scene, and not those of a clear alone. The command's tests compare pictures of shipped
/// pipelines.
#[test]
fn the_example_with_a_device_of_its_own_draws_the_scene() {
    if testing::open().is_none() {
        return;
    }
    let tests = std::env::current_exe().expect("a path");
    let built = tests.parent().and_then(|deps| deps.parent()).expect("a folder").join("examples/embed_own_device");
    assert!(built.exists(), "{} isn't built: cargo build --examples -p framewright-vulkan", built.display());
    let folder = tempfile::tempdir().expect("a folder");
    let out = Command::new(built).current_dir(folder.path()).output().expect("it runs");
    let said = String::from_utf8_lossy(&out.stdout);
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    assert!(said.contains("with the program's own device; out/own_device.png"), "{said}");
    let picture = image::open(folder.path().join("out/own_device.png")).expect("a picture").into_rgb8();
    assert_eq!(picture.dimensions(), (320, 180));
    let mut shades: Vec<_> = picture.pixels().map(|pixel| pixel.0).collect();
    shades.sort_unstable();
    shades.dedup();
    assert!(shades.len() > 2000, "{} colours: a sky, spheres and cubes have more", shades.len());
}

#[path = "../../../examples/embedding/imports.rs"]
mod imports;

#[test]
fn the_example_of_imports_draws_into_an_image_of_its_own() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let scene = scene::load(&in_repository("examples/scenes/spheres_and_cubes.ron")).expect("a scene");
    let drawn = imports::draw(&device, &scene).expect("drawn");
    let setup = Setup { pipeline: "examples/pipelines/forward.ron", set: &[], scene: &scene, extent: [64, 36] };
    assert_eq!(drawn, render::render(&device, &setup).expect("drawn")[0]);
    drop(device);
    assert_eq!(testing::findings(&messages), []);
}

#[path = "../../../examples/embedding/exact_device.rs"]
mod exact_device;

#[test]
fn pf_8_the_example_of_an_exact_device_draws_the_same() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let scene = scene::load(&in_repository("examples/scenes/spheres_and_cubes.ron")).expect("a scene");
    let drawn = exact_device::draw(&device, &scene).expect("drawn");
    let setup = Setup { pipeline: "examples/pipelines/forward.ron", set: &[], scene: &scene, extent: [64, 36] };
    assert_eq!(drawn, render::render(&device, &setup).expect("drawn")[0]);
    drop(device);
    assert_eq!(testing::findings(&messages), []);
}
