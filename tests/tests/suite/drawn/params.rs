//! Shaders read what a pipeline file gives as parameters, of every type (EM-5).

use framewright_graph::compile::Options;
use framewright_tests::render::{Setup, device, draw, silent};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

fn told(set: &[(&str, &str)]) -> Result<Option<Vec<f32>>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/params_of_every_type.ron", set, scene: &scene, extent: [8, 8] };
    let (_, mut executor) = draw(device, &setup, &Options::default(), 1)?;
    let bytes = executor.read_buffer("values")?;
    silent(device)?;
    Ok(Some(bytes.as_chunks().0.iter().map(|word| f32::from_ne_bytes(*word)).collect()))
}

#[test]
fn scalars_vectors_and_matrices_arrive_as_the_file_gives_them() -> Result<(), Box<dyn Error>> {
    let Some(values) = told(&[])? else { return Ok(()) };
    let mut expected: Vec<f32> = (1_u8..=51).map(f32::from).collect();
    // `on`, `cell`, `sides` and `last`.
    expected[4] = 1.0;
    expected[5] = -6.0;
    (expected[10], expected[11]) = (1.0, 0.0);
    expected.splice(12..50, (13_u8..=50).map(f32::from));
    expected[50] = -51.0;
    assert_eq!(values, expected);
    Ok(())
}

#[test]
fn settings_change_components() -> Result<(), Box<dyn Error>> {
    let Some(values) = told(&[("red", "0.5"), ("count", "100"), ("left", "false")])? else { return Ok(()) };
    assert_eq!(values[..3], [0.5, 2.0, 2.5]);
    assert_eq!(values[7..10], [100.0, 9.0, 102.0]);
    assert_eq!(values[10], 0.0);
    Ok(())
}
