//! What transfers and draws leave as it was, and that nothing is taken from where nothing was written.

use framewright_graph::compile::Options;
use framewright_tests::render::{Setup, device, draw, floats, silent};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const EXTENT: [u32; 2] = [16, 8];

/// The outputs of `tests/pipelines/left_alone.ron`.
struct Left {
    marked: Vec<u8>,
    /// Of depth that was filled, cleared by a stand-in, and drawn onto a fill.
    depths: [Vec<f64>; 3],
    volume: Vec<u8>,
    whole: Vec<u8>,
    of_texel: Vec<u8>,
    of_rows: Vec<u8>,
    plan: String,
}

fn left(set: &[(&str, &str)], poison: bool) -> Result<Option<Left>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/left_alone.ron", set, scene: &scene, extent: EXTENT };
    let (plan, mut executor) = draw(device, &setup, &Options { poison, ..Options::default() }, 2)?;
    let mut read = |output| executor.read(output);
    let depths = [floats(&read(1)?), floats(&read(2)?), floats(&read(3)?)];
    let [marked, volume, whole] = [read(0)?.bytes, read(4)?.bytes, read(5)?.bytes];
    let (of_texel, of_rows) = (executor.read_buffer("of_texel")?, executor.read_buffer("of_rows")?);
    silent(device)?;
    Ok(Some(Left { marked, depths, volume, whole, of_texel, of_rows, plan: plan.tree() }))
}

fn columns<T>(texels: &[T]) -> impl Iterator<Item = (usize, &T)> {
    texels.iter().enumerate().map(|(at, texel)| (at % EXTENT[0] as usize, texel))
}

#[test]
fn bytes_behind_the_last_texel_of_a_copy_stay_as_they_were_or_are_zero() -> Result<(), Box<dyn Error>> {
    for poison in [false, true] {
        for (filled, [third, fourth]) in [("false", [0, 0]), ("true", [0xFF, 0xFF])] {
            let Some(left) = left(&[("filled", filled)], poison)? else { return Ok(()) };
            assert_eq!(left.of_texel, [0, 0x38, third, fourth], "{}", left.plan);
            assert_eq!(left.of_rows[..15], [9; 15]);
            assert_eq!(left.of_rows[15], fourth);
        }
    }
    Ok(())
}

#[test]
fn stencil_is_marked_and_tested_beside_depth_that_nobody_wrote() -> Result<(), Box<dyn Error>> {
    for poison in [false, true] {
        let Some(Left { marked, .. }) = left(&[], poison)? else { return Ok(()) };
        for (column, texel) in columns(marked.as_chunks::<4>().0) {
            assert_eq!(*texel, if column < 8 { [128, 64, 255, 255] } else { [0, 0, 0, 255] }, "column {column}");
        }
    }
    Ok(())
}

#[test]
fn filled_depth_of_several_samples_is_sampled_as_one_value() -> Result<(), Box<dyn Error>> {
    for poison in [false, true] {
        let Some(Left { depths: [even, cleared, drawn], .. }) = left(&[], poison)? else { return Ok(()) };
        assert!(even.iter().all(|depth| *depth == 0.25), "{even:?}");
        assert!(cleared.iter().all(|depth| *depth == 0.75), "{cleared:?}");
        for (column, depth) in columns(&drawn) {
            assert_eq!(*depth, if column < 8 { 0.5 } else { 0.25 }, "column {column}");
        }
    }
    Ok(())
}

#[test]
fn the_last_level_of_a_volume_is_made_of_the_one_before() -> Result<(), Box<dyn Error>> {
    for poison in [false, true] {
        let Some(Left { volume, .. }) = left(&[], poison)? else { return Ok(()) };
        assert!(volume.iter().all(|byte| *byte == 51), "{volume:?}");
    }
    Ok(())
}

#[test]
fn a_blit_takes_nothing_from_beyond_the_part_of_an_image_that_a_frame_uses() -> Result<(), Box<dyn Error>> {
    let even: Vec<u8> = [0x00, 0x38, 0x00, 0x34, 0x00, 0x3C, 0x00, 0x3C].repeat((EXTENT[0] * EXTENT[1]) as usize);
    for poison in [false, true] {
        for scale in ["0.5", "0.75", "0.3", "1"] {
            let Some(Left { whole, plan, .. }) = left(&[("scale", scale)], poison)? else { return Ok(()) };
            assert!(whole == even, "{scale}\n{plan}");
        }
    }
    Ok(())
}
