//! The shown picture, pixel by pixel.

use crate::drawn::image_quality::{DIRECT, Set, picture, shining, shining_behind_glass};
use std::error::Error;

/// IQ-4: by the area filter, and by the bilinear one, whose tap lies between the four.
#[test]
fn scale_two_is_the_mean_of_two_by_two_pixels() -> Result<(), Box<dyn Error>> {
    let scene = shining_behind_glass([0.3, 0.8, 0.05]);
    let Some(twice) = picture(&DIRECT, &scene, [80, 60])? else { return Ok(()) };
    for filter in ["area", "bilinear"] {
        let set = [&DIRECT[..], &[("render_scale", "2"), ("filter", filter)]].concat();
        let Some(scaled) = picture(&set, &scene, [40, 30])? else { return Ok(()) };
        let steps = scaled.steps_from(&twice.shrunk(2));
        assert!(steps <= 1.0, "{filter}: {steps} steps apart");
    }
    Ok(())
}

/// IQ-4: the order is a choice, and matters where light is brighter than white.
#[test]
fn light_is_averaged_before_tone_mapping_or_what_is_shown_after_it() -> Result<(), Box<dyn Error>> {
    let scene = shining([30.0; 3]);
    let common = [("render_scale", "2"), ("msaa", "1"), ("tone_mapping", "reinhard")];
    let one = [("msaa", "1"), ("tone_mapping", "reinhard")];
    let Some(twice) = picture(&one, &scene, [80, 60])? else { return Ok(()) };
    let with = |mapped: &'static str| [&common[..], &[("mapped", mapped)]].concat();
    let Some(texels) = picture(&with("texels"), &scene, [40, 30])? else { return Ok(()) };
    assert!(texels.steps_from(&twice.shrunk(2)) <= 1.0, "what is shown is averaged");
    let Some(pixels) = picture(&with("pixels"), &scene, [40, 30])? else { return Ok(()) };
    // Of an edge a quarter of which shines: 7.5 / 8.5 instead of a quarter of 30 / 31.
    assert!(pixels.steps_from(&texels) > 50.0);
    Ok(())
}

/// IQ-16.
#[test]
fn both_forms_of_the_stripes_draw_the_same_picture() -> Result<(), Box<dyn Error>> {
    let mut scene = shining_behind_glass([0.6, 0.8, 0.4]);
    // It recedes, so that there are stripes.
    scene.objects[0].transform *= glam::DMat4::from_rotation_y(1.0);
    let form = |form: &'static str| [("hdr", "false"), ("tone_mapping", "clip"), ("depth_stripes", form)];
    let [Some(blended), Some(copied), Some(none)] = [
        picture(&form("blended"), &scene, [64, 48])?,
        picture(&form("copied"), &scene, [64, 48])?,
        picture(&form("off"), &scene, [64, 48])?,
    ] else {
        return Ok(());
    };
    // Rounded to 8 bits once a sample, or once a sample and once a texel. A blend may round what it blends by to the 8 bits of
    // its target, and Vulkan's sine has an error of 2⁻¹¹, twice over since it is squared: both are shares of light that is 1 at most.
    let steps = blended.steps_beyond(&copied, 0.5 / 255.0 + 2.0 / 2048.0);
    assert!(steps <= 3.0, "{steps} steps apart");
    assert!(blended.steps_from(&none) > 100.0);
    Ok(())
}

/// The middle of the picture.
fn shown(set: Set<'_>, emissive: [f32; 3]) -> Result<Option<[f64; 3]>, Box<dyn Error>> {
    let scene = shining(emissive);
    Ok(picture(set, &scene, [33, 25])?.map(|picture| picture.pixels[12 * 33 + 16]))
}

fn demand(found: [f64; 3], expected: [f64; 3]) {
    let steps = [0, 1, 2].map(|channel| {
        (crate::drawn::image_quality::encoded(found[channel]) - crate::drawn::image_quality::encoded(expected[channel]))
            .abs()
    });
    assert!(steps.iter().all(|steps| *steps <= 1.0), "{found:?} instead of {expected:?}");
}

/// IQ-21.
#[test]
fn tone_mapping_without_hdr_makes_one_half_of_white() -> Result<(), Box<dyn Error>> {
    for hdr in ["false", "true"] {
        let set = [("hdr", hdr), ("tone_mapping", "reinhard")];
        let Some(found) = shown(&set, [1.0, 0.0, 1.0])? else { return Ok(()) };
        demand(found, [0.5, 0.0, 0.5]);
    }
    Ok(())
}

/// IQ-21: a white point of 1 is the identity on 0…1, and of 100 nearly Reinhard's curve.
#[test]
fn the_white_point_decides_how_much_is_compressed() -> Result<(), Box<dyn Error>> {
    for (white_point, light, expected) in [("1", 0.5, 0.5), ("4", 4.0, 1.0), ("100", 3.0, 3.0 * 1.0003 / 4.0)] {
        let Some(found) = shown(&[("white_point", white_point)], [light, 0.0, 0.0])? else { return Ok(()) };
        demand(found, [expected, 0.0, 0.0]);
    }
    Ok(())
}

/// IQ-23.
#[test]
fn the_over_bright_view_is_what_is_beyond_white() -> Result<(), Box<dyn Error>> {
    let Some(found) = shown(&[("tone_mapping", "over_bright")], [1.25, 0.75, 3.0])? else { return Ok(()) };
    demand(found, [0.25, 0.0, 1.0]);
    Ok(())
}
