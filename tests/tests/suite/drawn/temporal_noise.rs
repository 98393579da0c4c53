//! The shader of temporal anti-aliasing is held against its twin, over noise (NU-5).

use framewright_passes::twin::temporal::{allowed_history, mixed};
use framewright_tests::render::{Setup, device, render, rgb};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const EXTENT: [i32; 2] = [64, 32];

type Picture = Vec<[f64; 3]>;

/// The picture that is drawn, history, and the mixture of both.
fn mixed_noise(set: &[(&str, &str)]) -> Result<Option<[Picture; 3]>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/temporal.ron", set, scene: &scene, extent: [8, 8] };
    let pictures = render(device, &setup)?.into_iter().map(|output| rgb(&output));
    let pictures: Vec<Picture> = pictures.collect();
    Ok(Some(pictures.try_into().map_err(|_| "not three outputs")?))
}

/// A texel; beyond the border that of the border.
fn texel(picture: &Picture, x: i32, y: i32) -> [f64; 3] {
    picture[(y.clamp(0, EXTENT[1] - 1) * EXTENT[0] + x.clamp(0, EXTENT[0] - 1)) as usize]
}

fn places() -> impl Iterator<Item = [i32; 2]> {
    (0..EXTENT[1]).flat_map(|y| (0..EXTENT[0]).map(move |x| [x, y]))
}

/// The 3 × 3 places around one, row by row.
fn around([x, y]: [i32; 2]) -> [[i32; 2]; 9] {
    std::array::from_fn(|at| [x + at as i32 % 3 - 1, y + at as i32 / 3 - 1])
}

#[test]
fn history_is_found_where_motion_leads_held_to_the_colours_around_and_mixed_in() -> Result<(), Box<dyn Error>> {
    let ways =
        [("0", "0", "0.25", "1.0"), ("3", "-2", "0.1", "0.5"), ("-7", "5", "0.6", "0.0"), ("1", "0", "0.1", "10.0")];
    let (mut kept, mut held) = (0, 0);
    for (across, down, share, deviations) in ways {
        let set = [("across", across), ("down", down), ("share", share), ("deviations", deviations)];
        let Some([now, before, found]) = mixed_noise(&set)? else { return Ok(()) };
        let (across, down): (i32, i32) = (across.parse()?, down.parse()?);
        let (share, deviations): (f64, f64) = (share.parse()?, deviations.parse()?);
        for [x, y] in places() {
            let drawn = texel(&now, x, y);
            let then = [x + across, y + down];
            let outside = then[0] < 0 || then[1] < 0 || then[0] >= EXTENT[0] || then[1] >= EXTENT[1];
            let found = texel(&found, x, y);
            if outside {
                assert_eq!(found, drawn, "({x}, {y}) has no history");
                continue;
            }
            let history = texel(&before, then[0], then[1]);
            let allowed = allowed_history(history, &around([x, y]).map(|[x, y]| texel(&now, x, y)), deviations);
            *(if allowed == history { &mut kept } else { &mut held }) += 1;
            let expected = mixed(drawn, allowed, share);
            for (found, expected) in found.into_iter().zip(expected) {
                // Bright texels are compared near 1, where 2⁻²⁴ stands for as much as their square.
                let close = (found - expected).abs() < 1e-5 * (1.0 + expected * expected);
                assert!(close, "({x}, {y}) with {set:?}: {found} instead of {expected}");
            }
        }
    }
    assert!(kept > 500 && held > 500, "{kept} were kept, {held} held back");
    Ok(())
}

#[test]
fn motion_is_that_of_the_nearest_texel_around() -> Result<(), Box<dyn Error>> {
    let Some([now, _, found]) = mixed_noise(&[("strewn", "true")])? else { return Ok(()) };
    let [width, height] = EXTENT.map(f64::from);
    let (mut inside, mut outside) = (0, 0);
    for [x, y] in places() {
        let texels = around([x, y]).map(|[x, y]| texel(&now, x, y));
        // Depth is the red channel, and reversed; motion is red and green.
        let [across, down, _] = texels.into_iter().max_by(|one, other| one[0].total_cmp(&other[0])).ok_or("nine")?;
        let then = [(f64::from(x) + 0.5) / width + across, (f64::from(y) + 0.5) / height + down];
        let unchanged = texel(&found, x, y) == texel(&now, x, y);
        let border = then.iter().any(|part| (part - 1.0).abs() < 1e-5);
        if then.iter().all(|part| *part <= 1.0) {
            inside += 1;
            assert!(border || !unchanged, "({x}, {y}) has history at {then:?}");
        } else {
            outside += 1;
            assert!(border || unchanged, "({x}, {y}) has none at {then:?}");
        }
    }
    assert!(inside > 100 && outside > 1000, "{inside} inside, {outside} outside");
    Ok(())
}
