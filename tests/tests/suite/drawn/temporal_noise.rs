//! The shader of temporal anti-aliasing is held against its twin, over noise (NU-5).

use framewright_passes::twin::scale::catmull_rom;
use framewright_passes::twin::temporal::{allowed_history, change_allowed, compared_luma, mixed, share_after};
use framewright_tests::render::{Setup, device, render, rgb};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

const EXTENT: [i32; 2] = [64, 32];

type Picture = Vec<[f64; 3]>;

/// The picture that is drawn, history, the mixture of both, and the record of it.
fn mixed_noise(set: &[(&str, &str)]) -> Result<Option<[Picture; 4]>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/temporal.ron", set, scene: &scene, extent: [8, 8] };
    let pictures = render(device, &setup)?.into_iter().map(|output| rgb(&output));
    let pictures: Vec<Picture> = pictures.collect();
    Ok(Some(pictures.try_into().map_err(|_| "not four outputs")?))
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
    // To the right, down, share, deviations, the last frame's share, and the change before.
    let ways = [
        ["0", "0", "0.25", "1.0", "0.125", "0.0"],
        ["3", "-2", "0.1", "0.5", "1.0", "0.1"],
        ["-7", "5", "0.6", "0.0", "0.125", "0.1"],
        ["1", "0", "0.1", "10.0", "0.5", "0.0"],
        ["0", "0", "0.1", "0.5", "0.3", "0.05"],
        ["0.125", "0", "0.01", "0.25", "0.02", "0.2"],
    ];
    let (mut kept, mut held) = (0, 0);
    for way in ways {
        let names = ["across", "down", "share", "deviations", "last_share", "change"];
        let set: Vec<(&str, &str)> = names.into_iter().zip(way).collect();
        let Some([now, before, found, record]) = mixed_noise(&set)? else { return Ok(()) };
        let mut numbers = [0.0; 6];
        for (number, text) in numbers.iter_mut().zip(way) {
            *number = text.parse::<f64>()?;
        }
        let [across, down, share, deviations, last_share, change] = numbers;
        let speed = across.hypot(down);
        let share = share_after(last_share, share, speed);
        for [x, y] in places() {
            let drawn = texel(&now, x, y);
            let (then_x, then_y) = (f64::from(x) + across, f64::from(y) + down);
            let center = [then_x + 0.5, then_y + 0.5];
            let outside = (0..2).any(|axis| center[axis] < 0.0 || center[axis] > f64::from(EXTENT[axis]));
            let (found, record) = (texel(&found, x, y), texel(&record, x, y));
            if outside {
                assert_eq!((found, record), (drawn, [1.0, 0.0, 0.0]), "({x}, {y}) has no history");
                continue;
            }
            let Some(history) = looked_up(&before, [then_x, then_y]) else { continue };
            let colors = around([x, y]).map(|[x, y]| texel(&now, x, y));
            let allowed = allowed_history(history, &colors, deviations, change_allowed(change, speed));
            *(if allowed == history { &mut kept } else { &mut held }) += 1;
            let expected = mixed(drawn, allowed, share);
            for (found, expected) in found.into_iter().zip(expected) {
                // Bright texels are compared near 1, where 2⁻²⁴ stands for as much as their square.
                let close = (found - expected).abs() < 1e-5 * (1.0 + expected * expected);
                assert!(close, "({x}, {y}) with {set:?}: {found} instead of {expected}");
            }
            let changed = (compared_luma(drawn) - compared_luma(allowed)).abs();
            let expected = [share, change + share * (changed - change)];
            let close = record.into_iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-5);
            assert!(close, "({x}, {y}) with {set:?}: record {record:?} instead of {expected:?}");
        }
    }
    assert!(kept > 500 && held > 500, "{kept} were kept, {held} held back");
    Ok(())
}

/// History at a place in texels; `None` where it lies between texels beside the border.
fn looked_up(before: &Picture, [x, y]: [f64; 2]) -> Option<[f64; 3]> {
    let inner = |at: f64, extent: i32| at.fract() == 0.0 || (2.0..f64::from(extent) - 3.0).contains(&at);
    if !inner(x, EXTENT[0]) || !inner(y, EXTENT[1]) {
        return None;
    }
    let mut sum = [0.0; 3];
    for down in -1..=2 {
        for across in -1..=2 {
            let weight =
                catmull_rom(f64::from(across) - (x - x.floor())) * catmull_rom(f64::from(down) - (y - y.floor()));
            let color = texel(before, x.floor() as i32 + across, y.floor() as i32 + down);
            (0..3).for_each(|channel| sum[channel] += weight * color[channel]);
        }
    }
    Some(sum.map(|channel| channel.max(0.0)))
}

/// A frame after one that has no record has no history.
#[test]
fn without_a_record_there_is_no_history() -> Result<(), Box<dyn Error>> {
    let Some([now, _, found, record]) = mixed_noise(&[("last_share", "0.0")])? else { return Ok(()) };
    assert_eq!(found, now);
    assert!(record.iter().all(|record| *record == [1.0, 0.0, 0.0]));
    Ok(())
}

#[test]
fn motion_is_that_of_the_nearest_texel_around() -> Result<(), Box<dyn Error>> {
    let Some([now, _, found, _]) = mixed_noise(&[("strewn", "true")])? else { return Ok(()) };
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
