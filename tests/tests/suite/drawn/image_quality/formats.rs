//! The effect of the precision of colour and depth on the picture, and on memory.

use crate::drawn::image_quality::{PIPELINE, Set, picture, plan, plan_of, shining_behind_glass};
use framewright_graph::plan::{Note, Plan};
use framewright_graph::vulkan::Format::{self, *};
use std::error::Error;

/// As the twin of nothing but the arithmetic: what a store of 5 or 6 bits of mantissa loses of a value, at most, over three
/// stores: what is opaque, the glass before it, and the mean of the samples.
const SMALLEST: [f64; 3] = [3.0 / 64.0, 3.0 / 64.0, 3.0 / 32.0];
/// The loss by stores of ten bits of mantissa.
const HALF: [f64; 3] = [3.0 / 1024.0; 3];
/// Two roundings of 8 bits.
const STEP: f64 = 2.0;

/// That each pixel of a picture lies within a share of another's, and within some 8-bit steps.
fn demand_alike(set: Set<'_>, share: [f64; 3]) -> Result<(), Box<dyn Error>> {
    let scene = shining_behind_glass([3.0, 0.7, 5.0]);
    let [Some(usual), Some(found)] = [picture(&[], &scene, [65, 47])?, picture(set, &scene, [65, 47])?] else {
        return Ok(());
    };
    for (found, usual) in found.pixels.iter().zip(&usual.pixels) {
        for ((found, usual), share) in found.iter().zip(usual).zip(share) {
            // Tone mapping makes no share of light a larger one.
            let [least, most] =
                [usual * (1.0 - share), usual * (1.0 + share)].map(crate::drawn::image_quality::encoded);
            let found = crate::drawn::image_quality::encoded(*found);
            assert!(least - STEP <= found && found <= most + STEP, "{set:?}: {found}, not {least} to {most}");
        }
    }
    Ok(())
}

#[test]
fn every_precision_of_colour_draws_the_same_picture_as_closely_as_its_bits_allow() -> Result<(), Box<dyn Error>> {
    demand_alike(&[("color_precision", "Smallest")], SMALLEST)?;
    demand_alike(&[("color_precision", "Exact")], HALF)
}

/// Light of 8 bits against light of 16, both clamped at white.
#[test]
fn without_hdr_too() -> Result<(), Box<dyn Error>> {
    let scene = shining_behind_glass([0.6, 0.2, 5.0]);
    let set = [("hdr", "false"), ("color_precision", "Balanced")];
    let exact = [("hdr", "false"), ("color_precision", "Exact")];
    let [Some(usual), Some(found)] = [picture(&set, &scene, [65, 47])?, picture(&exact, &scene, [65, 47])?] else {
        return Ok(());
    };
    // Three roundings to 8 bits, and what tone mapping makes of a step at its steepest.
    assert!(found.steps_from(&usual) <= 6.0, "{} steps", found.steps_from(&usual));
    assert!(found.steps_from(&usual) > 0.0, "it is not the same format");
    Ok(())
}

/// The same surfaces are hidden: they lie further apart than the steps of 16 bits.
#[test]
fn every_precision_of_depth_draws_the_same_picture() -> Result<(), Box<dyn Error>> {
    for word in ["Smallest", "Balanced"] {
        demand_alike(&[("depth_precision", word)], [0.0; 3])?;
    }
    Ok(())
}

/// With a near plane of a tenth of a millimetre 16 and 24 bits lose what is a few metres away; the Plan says what it takes instead.
#[test]
fn coarse_depth_loses_nothing_however_near_the_near_plane_is() -> Result<(), Box<dyn Error>> {
    let mut scene = shining_behind_glass([3.0, 0.7, 5.0]);
    scene.camera.near = 1e-4;
    let [usual, smallest] = [&[][..], &[("depth_precision", "Smallest")]].map(|set| picture(set, &scene, [65, 47]));
    let (Some(usual), Some(smallest)) = (usual?, smallest?) else { return Ok(()) };
    assert_eq!(smallest.steps_from(&usual), 0.0);
    scene.camera.near = 1e-6;
    let set = [("depth_precision", "Smallest")];
    let Some(found) = picture(&set, &scene, [65, 47])? else { return Ok(()) };
    assert!(found.steps_from(&usual) <= STEP, "{} steps", found.steps_from(&usual));
    let Some(plan) = plan_of(PIPELINE, &set, &scene, true)? else { return Ok(()) };
    let depths: Vec<Format> = plan.images.iter().map(|image| image.format).filter(|it| it.is_depth()).collect();
    assert!(!depths.is_empty() && depths.iter().all(|format| *format == D32_SFLOAT), "{depths:?}");
    let says = |note: &Note| note.text.contains("D32_SFLOAT is taken") && note.text.contains("too coarse");
    assert!(plan.notes.iter().any(says), "{:?}", plan.notes);
    Ok(())
}

fn all_bytes(plan: &Plan) -> i64 {
    (plan.totals.transient_bytes + plan.totals.kept_bytes).cast_signed()
}

/// The device's own needs, not those of a model.
#[test]
fn bytes_are_as_the_plan_states() -> Result<(), Box<dyn Error>> {
    let Some(usual) = plan(&[])? else { return Ok(()) };
    let choices: [(&str, &str, &[Format]); 5] = [
        ("color_precision", "Smallest", &[B10G11R11_UFLOAT_PACK32]),
        ("color_precision", "Exact", &[R32G32B32A32_SFLOAT]),
        ("depth_precision", "Smallest", &[D16_UNORM]),
        // One driver lacks 24 bits, and the Plan says so.
        ("depth_precision", "Balanced", &[X8_D24_UNORM_PACK32, D32_SFLOAT]),
        ("color_precision", "Balanced", &[R16G16B16A16_SFLOAT]),
    ];
    for (name, word, formats) in choices {
        let Some(plan) = plan(&[(name, word)])? else { return Ok(()) };
        assert!(plan.device.exact_memory);
        let chosen = plan.images.iter().filter_map(|image| image.chosen.as_ref());
        let more: i64 = chosen.map(|chosen| chosen.more_bytes).sum();
        assert_eq!(all_bytes(&plan) - all_bytes(&usual), more, "{name}={word}");
        assert!(plan.images.iter().any(|image| formats.contains(&image.format)), "{name}={word}");
        let gone = plan.images.iter().all(|image| {
            !formats.contains(&D32_SFLOAT) || image.chosen.is_some() == (image.format == X8_D24_UNORM_PACK32)
        });
        assert!(gone, "{name}={word}");
    }
    Ok(())
}
