//! The coverage of pixels by masked materials: compared with its twin, and drawn (NU-5, IQ-6).

use framewright_passes::twin::alpha_coverage::covered_by;
use framewright_tests::render::{Setup, device, render, rgba};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

/// Alpha over its 256 steps, the cutoff from 0 to 1, and widths from 1 down to less than the least.
#[test]
fn what_is_covered_is_that_of_the_twin_over_the_whole_range() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/coverage.ron", set: &[], scene: &scene, extent: [8, 8] };
    let output = render(device, &setup)?.swap_remove(0);
    let mut between = 0;
    for [found, alpha, cutoff, width] in &rgba(&output) {
        let expected = covered_by(*alpha, *cutoff, *width);
        // Two roundings of a quotient of up to 10⁴, and Vulkan's division, which may be 2.5 units off.
        assert!(
            (found - expected).abs() <= 1e-6 + 4e-7 / width.max(1e-4),
            "{alpha}, {cutoff}, {width}: {found}, not {expected}"
        );
        between += usize::from(expected > 0.0 && expected < 1.0);
    }
    assert!(between > 1000, "{between} pixels are covered in part");
    Ok(())
}

#[test]
fn the_cutoff_is_covered_by_half_and_a_pixel_away_by_nothing_or_all() {
    for (cutoff, width) in [(0.5, 0.1), (0.25, 1e-3), (0.9, 0.05), (0.5, 0.0)] {
        assert_eq!(covered_by(cutoff, cutoff, width), 0.5);
        let pixel = width.max(1e-4);
        assert!(covered_by(cutoff - pixel, cutoff, width) == 0.0 && covered_by(cutoff + pixel, cutoff, width) == 1.0);
    }
}
