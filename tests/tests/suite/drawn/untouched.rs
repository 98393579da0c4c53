//! What a pass doesn't set stays as it was, by whatever means it leaves it: sample masks, vertex stages, stores in some places.

use framewright_graph::compile::Options;
use framewright_tests::render::{Setup, device, draw};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// 8×8 texels of each output of `tests/pipelines/untouched.ron`, in its order, after three frames.
fn outputs(options: &Options) -> Result<Option<Vec<Vec<u8>>>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/untouched.ron", set: &[], scene: &scene, extent: [8, 8] };
    let (plan, mut executor) = draw(device, &setup, options, 3)?;
    let read = |output| Ok(executor.read(output)?.bytes);
    (0..plan.outputs.len()).map(read).collect::<Result<_, Box<dyn Error>>>().map(Some)
}

/// What is expected of each output, by column: red, green and blue.
fn expected(output: &str, column: u32) -> [u8; 3] {
    let (red, green) = ([255, 0, 0], [0, 255, 0]);
    match output {
        "promised" => green,
        "steps" => {
            // One sample of four, two, three, and all.
            let share = 255.0 * f64::from(column / 2 + 1) / 4.0;
            [share.round() as u8, (255.0 - share).round() as u8, 0]
        }
        "covered" => red,
        "edge" if column == 4 => [128, 128, 0],
        "redrawn" if column < 4 => [255, 0, 255],
        "painted" if column >= 4 => [0, 0, 255],
        _ if column < 4 => red,
        _ => green,
    }
}

const OUTPUTS: [&str; 10] =
    ["mask", "vertices", "promised", "steps", "edge", "covered", "redrawn", "stored", "painted", "words"];

#[test]
fn what_a_pass_leaves_stays_as_it_was_by_every_means_and_in_every_mode() -> Result<(), Box<dyn Error>> {
    let plain = Options::default();
    let poisoned = Options { poison: true, ..plain };
    for options in [plain, poisoned, Options { demote: false, ..poisoned }, Options { alias: false, ..poisoned }] {
        let Some(pictures) = outputs(&options)? else { return Ok(()) };
        assert_eq!(pictures.len(), OUTPUTS.len());
        for (name, picture) in OUTPUTS.iter().zip(pictures) {
            for (at, texel) in (0_u32..).zip(picture.as_chunks::<4>().0) {
                let wanted = expected(name, at % 8);
                let near = texel.iter().zip(wanted).all(|(found, wanted)| found.abs_diff(wanted) <= 1);
                assert!(near, "`{name}` with {options:?}: {texel:?} in column {}, not {wanted:?}", at % 8);
            }
        }
    }
    Ok(())
}
