//! A pipeline file gives lists of images to arrays of its shaders, and each element is the image at its place (EM-5).

use framewright_tests::render::{Setup, device, floats, render};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const EXTENT: [u32; 2] = [12, 5];

/// Holds every texel of all outputs against the value of the image that its column and the setting choose.
fn demand(turn: usize, msaa: &str) -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    let set = [("turn", &*turn.to_string()), ("msaa", msaa)];
    let setup = Setup { pipeline: "tests/pipelines/arrays_of_images.ron", set: &set, scene: &scene, extent: EXTENT };
    let columns = 0..EXTENT[0] as usize;
    let row: Vec<f64> = columns.map(|x| [0.25, 0.5, 0.75][(x + turn) % 3]).collect();
    let outputs = render(device, &setup)?;
    for (output, factor) in outputs.iter().zip([1.0, 2.0, 3.0]) {
        let expected: Vec<f64> = row.iter().map(|value| factor * value).collect();
        assert_eq!(floats(output), expected.repeat(EXTENT[1] as usize), "times {factor}");
    }
    assert_eq!(outputs.len(), 3);
    Ok(())
}

#[test]
fn each_column_shows_the_image_that_it_chooses() -> Result<(), Box<dyn Error>> {
    demand(0, "4")
}

#[test]
fn a_setting_turns_which_image_that_is() -> Result<(), Box<dyn Error>> {
    demand(1, "1")?;
    demand(2, "4")
}
