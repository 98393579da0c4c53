//! Colour grading is held against its twin (NU-5).

use framewright_passes::twin::grading::graded;
use framewright_tests::render::{Setup, device, render, rgb};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// A hundredth of an 8-bit step: the curve of sRGB there and back, and a mean of eight.
const BOUND: f64 = 4e-5;

#[test]
fn every_colour_is_what_the_table_says_of_it() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for (size, strength) in [(8_usize, 1.0), (8, 0.25), (2, 1.0), (1, 1.0), (8, 0.0)] {
        let set = [("size", &*size.to_string()), ("strength", &*strength.to_string())];
        let scene = empty_scene();
        let setup = Setup { pipeline: "tests/pipelines/color_grading.ron", set: &set, scene: &scene, extent: [8, 8] };
        let outputs = render(device, &setup)?;
        let [shown, table, found] = [0, 1, 2].map(|output| rgb(&outputs[output]));
        let entry = |[red, green, blue]: [usize; 3]| table[green * size * size + blue * size + red];
        let mut changed = 0;
        for (shown, found) in shown.iter().zip(found) {
            let expected = graded(*shown, size, entry, strength);
            let near = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= BOUND);
            assert!(near, "{size} shades, strength {strength}: {shown:?} became {found:?} instead of {expected:?}");
            changed += usize::from(shown.iter().zip(found).any(|(shown, found)| (shown - found).abs() > 0.05));
        }
        assert_eq!(changed > 1000, strength > 0.0, "{size} shades, strength {strength}: {changed} changed");
    }
    Ok(())
}
