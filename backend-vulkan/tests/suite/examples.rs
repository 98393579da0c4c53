//! The examples of this crate draw what they say (EM-2, EM-12), and an example of the page on embedding that is unsafe (EM-1).

use crate::testing;
use framewright_passes::scene;
use framewright_tests::drivers::{CURRENT_LAYER, DISTRIBUTION_LAYERS, Driver};
use framewright_tests::render::{self, Setup, in_repository};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The file of an example that was built beside these tests.
fn built(example: &str) -> PathBuf {
    let tests = std::env::current_exe().expect("a path");
    let built = tests.parent().and_then(|deps| deps.parent()).expect("a folder").join("examples").join(example);
    assert!(built.exists(), "{} isn't built: cargo build --examples -p framewright-vulkan", built.display());
    built
}

/// Colours of a picture.
fn shades(picture: &Path) -> Vec<[u8; 3]> {
    let picture = image::open(picture).expect("a picture").into_rgb8();
    assert_eq!(picture.dimensions(), (320, 180));
    let mut shades: Vec<_> = picture.pixels().map(|pixel| pixel.0).collect();
    shades.sort_unstable();
    shades.dedup();
    shades
}

/// The picture has as many colours as the scene, and not those of a clear alone. The command's tests compare pictures of shipped
/// pipelines.
#[test]
fn the_example_with_a_device_of_its_own_draws_the_scene() {
    if testing::open().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let out = Command::new(built("embed_own_device")).current_dir(folder.path()).output().expect("it runs");
    let said = String::from_utf8_lossy(&out.stdout);
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    assert!(said.contains("with the program's own device; out/own_device.png"), "{said}");
    let shades = shades(&folder.path().join("out/own_device.png"));
    assert!(shades.len() > 2000, "{} colours: a sky, spheres and cubes have more", shades.len());
}

/// DO-5, DO-8: bindless materials in HLSL, a compute pipeline of the engine's own, two threads, own images and command buffers. A
/// driver that has no arrays of textures by number refuses the pipeline, by the shader's line.
#[test]
fn the_engine_draws_or_names_what_the_driver_lacks() {
    for driver in Driver::SOFTWARE.into_iter().filter(|driver| driver.is_tested()) {
        let Some(manifest) = driver.manifest() else { continue };
        let layers = Path::new(CURRENT_LAYER).exists().then(|| in_repository("tests/layer"));
        let folder = tempfile::tempdir().expect("a folder");
        let mut engine = Command::new(built("engine"));
        engine.current_dir(folder.path()).env("VK_DRIVER_FILES", manifest).env("VK_ICD_FILENAMES", manifest);
        engine.env("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation");
        engine.env("VK_LAYER_PATH", layers.unwrap_or_else(|| DISTRIBUTION_LAYERS.into()));
        let out = engine.output().expect("it runs");
        let (said, errors) = (String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
        assert!(!said.contains("VUID") && !errors.contains("VUID"), "{driver:?}: {said}{errors}");
        if out.status.success() {
            let shades = shades(&folder.path().join("out/engine_frame.png"));
            assert!(shades.len() > 500, "{driver:?}: {} colours", shades.len());
        } else {
            assert!(errors.contains("shaderSampledImageArrayDynamicIndexing"), "{driver:?}: {errors}");
            assert!(errors.contains("material.hlsl"), "{driver:?}: {errors}");
            assert_eq!(driver, Driver::Lavapipe, "{errors}");
        }
    }
}

#[path = "../../../examples/engine/interface.rs"]
mod own_engine;

/// `check` knows of the engine what the engine tells the library.
#[test]
fn the_engines_interface_file_is_its_own() {
    let file = std::fs::read_to_string(in_repository("examples/engine/interface.ron")).expect("a text");
    assert_eq!(file, own_engine::interfaces().to_ron());
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
    let (instance, physical) = device.raw_physical();
    let drawn = exact_device::draw(instance, physical, &scene).expect("drawn");
    let setup = Setup { pipeline: "examples/pipelines/forward.ron", set: &[], scene: &scene, extent: [64, 36] };
    assert_eq!(drawn, render::render(&device, &setup).expect("drawn")[0]);
    drop(device);
    assert_eq!(testing::findings(&messages), []);
}

#[path = "../../../examples/embedding/threads.rs"]
mod threads;

/// DO-8.
#[test]
fn do_8_the_example_of_threads_draws_a_bar_for_each() {
    let Some(device) = render::device() else { return };
    let picture = threads::draw(device).expect("drawn");
    for (number, texel) in picture.bytes.as_chunks::<4>().0.iter().enumerate() {
        let in_bar = number % 64 % 16 < 8;
        assert_eq!(*texel, if in_bar { [255; 4] } else { [0, 0, 255, 255] }, "{number}");
    }
    render::silent(device).expect("silent");
}
