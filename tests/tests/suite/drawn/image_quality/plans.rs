//! The draws, resolves and images that the file becomes.

use crate::drawn::image_quality::{DIRECT, PIPELINE, drawn_by, listing, plan, plan_of, shining, shining_behind_glass};
use framewright_graph::frame::{Blend, Draw};
use framewright_graph::plan::{Plan, Work};
use framewright_graph::vulkan::{Format, LoadOp, StoreOp};
use std::collections::BTreeMap;
use std::error::Error;

fn format_of(plan: &Plan, pass: &str) -> Option<Format> {
    drawn_by(plan, pass).map(|image| image.format)
}

/// IQ-1: the size of `color` follows the scale, rounded down; the screen's is the frame's.
#[test]
fn the_scene_is_drawn_at_the_scaled_size_and_one_draw_brings_it_to_the_screen() -> Result<(), Box<dyn Error>> {
    for (scale, extent) in
        [("0.25", [16, 11]), ("0.7", [45, 32]), ("1.5", [97, 70]), ("2", [130, 94]), ("4", [260, 188])]
    {
        for filter in ["nearest", "bilinear", "area", "catmull_rom"] {
            let set = [("render_scale", scale), ("filter", filter), ("tone_mapping", "clip"), ("mapped", "pixels")];
            let Some(plan) = plan(&set)? else { return Ok(()) };
            let size = |pass: &str| drawn_by(&plan, pass).map(|image| image.extent);
            let (draws, last) = (listing(&plan), format!("scale_light.{filter}"));
            assert_eq!(size("opaque"), Some([extent[0], extent[1], 1]), "{scale}");
            assert_eq!(size(&last), Some([65, 47, 1]), "{scale}");
            assert_eq!(draws.last(), Some(&last), "{draws:?}");
            assert_eq!(draws.iter().filter(|draw| draw.starts_with("scale")).count(), 1, "{draws:?}");
        }
    }
    Ok(())
}

/// IQ-2: no image in between.
#[test]
fn with_nothing_to_do_objects_are_drawn_straight_into_the_screen() -> Result<(), Box<dyn Error>> {
    let Some(plan) = plan(&DIRECT)? else { return Ok(()) };
    assert_eq!(listing(&plan), ["opaque", "sky", "transparent"]);
    let names: Vec<&str> = plan.images.iter().map(|image| &*image.name).collect();
    assert!(names.len() == 2 && names.contains(&"screen") && names.contains(&"depth"), "{names:?}");
    Ok(())
}

/// IQ-3: a preview without scale, samples and HDR, even if the user chose them.
#[test]
fn a_view_that_allows_nothing_takes_the_direct_path() -> Result<(), Box<dyn Error>> {
    let set = [("msaa", "4"), ("hdr", "true"), ("render_scale", "2"), ("tone_mapping", "clip")];
    let scene = shining_behind_glass([4.0; 3]);
    let Some(plan) = plan_of("tests/pipelines/image_quality_preview.ron", &set, &scene, true)? else { return Ok(()) };
    assert_eq!(listing(&plan), ["opaque", "sky", "transparent"]);
    assert_eq!(plan.images.len(), 2, "{}", plan.tree());
    let set = [("msaa", "4"), ("hdr", "true"), ("render_scale", "2")];
    let Some(plan) = plan_of("tests/pipelines/image_quality_preview.ron", &set, &scene, true)? else { return Ok(()) };
    assert!(plan.images.iter().all(|image| image.samples == 1 && image.extent == [65, 47, 1]), "{}", plan.tree());
    assert_eq!(format_of(&plan, "opaque"), Some(Format::R8G8B8A8_SRGB));
    Ok(())
}

/// IQ-3: for every choice of the user's, or for one alone.
#[test]
fn a_view_brings_effects_of_its_own_or_takes_the_users() -> Result<(), Box<dyn Error>> {
    let (set, scene) = ([("blur", "5"), ("depth_stripes", "blended")], shining_behind_glass([4.0; 3]));
    for (pipeline, blurs, stripes) in [("image_quality_effects", 2, 0), ("image_quality_preview", 5, 1)] {
        let pipeline = format!("tests/pipelines/{pipeline}.ron");
        let Some(plan) = plan_of(&pipeline, &set, &scene, true)? else { return Ok(()) };
        let draws = listing(&plan);
        let count = |start: &str| draws.iter().filter(|draw| draw.starts_with(start)).count();
        assert_eq!((count("soften.blur"), count("stripes.stripes")), (blurs, stripes), "{pipeline}: {draws:?}");
    }
    Ok(())
}

/// IQ-7.
#[test]
fn multisampled_colour_is_resolved_before_what_samples_it() -> Result<(), Box<dyn Error>> {
    let mapped = ("mapped", "pixels");
    let Some(plan) = plan(&[mapped])? else { return Ok(()) };
    assert_eq!(listing(&plan), ["opaque", "sky", "transparent", "(resolve)", "map.curve.tone_map"]);
    let Some(plan) = crate::drawn::image_quality::plan(&[mapped, ("msaa", "1")])? else { return Ok(()) };
    assert_eq!(listing(&plan), ["opaque", "sky", "transparent", "map.curve.tone_map"]);
    Ok(())
}

/// IQ-8: bloom reads colour several times, and so does the overlay; nothing is drawn into it in between.
#[test]
fn a_resolve_serves_every_reader_until_the_next_write() -> Result<(), Box<dyn Error>> {
    let scene = shining_behind_glass([4.0; 3]);
    let Some(plan) = plan_of("examples/pipelines/post.ron", &[], &scene, true)? else { return Ok(()) };
    let Some(resolved) = plan.images.iter().find(|image| &*image.name == "color (resolved)") else {
        return Err(plan.tree().into());
    };
    let reads = |work: &Work| match work {
        Work::Render(scope) => {
            scope.passes.iter().filter(|pass| pass.accesses.iter().any(|it| it.image == resolved.id)).count()
        }
        _ => 0,
    };
    assert!(plan.steps.iter().map(|step| reads(&step.work)).sum::<usize>() >= 3, "{}", plan.tree());
    assert_eq!(plan.totals.resolves, 1, "{}", plan.tree());
    Ok(())
}

/// IQ-9: both Plans can be had.
#[test]
fn a_blur_of_five_draws_takes_one_resolve_where_the_file_asks_for_three() -> Result<(), Box<dyn Error>> {
    let set = [("hdr", "false"), ("tone_mapping", "clip"), ("blur", "5")];
    let scene = shining_behind_glass([4.0; 3]);
    for (demote, resolves) in [(true, 1), (false, 3)] {
        let Some(plan) = plan_of(PIPELINE, &set, &scene, demote)? else { return Ok(()) };
        assert_eq!(plan.totals.resolves, resolves, "{}", plan.tree());
    }
    Ok(())
}

/// IQ-16: transparent objects keep their samples in either form.
#[test]
fn stripes_take_one_resolve_as_a_blend_and_two_as_a_copy() -> Result<(), Box<dyn Error>> {
    for (form, resolves) in [("blended", 1), ("copied", 2)] {
        let Some(plan) = plan(&[("mapped", "pixels"), ("depth_stripes", form)])? else { return Ok(()) };
        assert_eq!(plan.totals.resolves, resolves, "{}", plan.tree());
        let glass = plan.steps.iter().find_map(|step| match &step.work {
            Work::Render(scope) => {
                scope.passes.iter().any(|pass| &*pass.name == "transparent").then_some(scope.samples)
            }
            _ => None,
        });
        assert_eq!(glass, Some(4));
    }
    Ok(())
}

/// IQ-17: after what is transparent, on what is shown.
#[test]
fn a_blur_takes_as_many_draws_as_its_strength_and_works_on_8_bits() -> Result<(), Box<dyn Error>> {
    for strength in 0..=5 {
        let Some(plan) = plan(&[("blur", &strength.to_string())])? else { return Ok(()) };
        let draws = listing(&plan);
        let blurs: Vec<usize> = (0..draws.len()).filter(|at| draws[*at].starts_with("soften.blur")).collect();
        assert_eq!(blurs.len(), strength, "{draws:?}");
        let glass = draws.iter().position(|draw| draw == "transparent");
        assert!(blurs.iter().all(|at| Some(*at) > glass), "{draws:?}");
        for draw in blurs.iter().map(|at| &draws[*at]) {
            assert_eq!(format_of(&plan, draw), Some(Format::R8G8B8A8_SRGB), "{}", plan.tree());
        }
    }
    Ok(())
}

/// IQ-18: the first pass that writes an image finds nothing in it; a pass that loads finds what was stored, and shows some of it.
#[test]
fn nothing_is_loaded_that_was_not_kept_or_is_drawn_over() -> Result<(), Box<dyn Error>> {
    let choices: [&[(&str, &str)]; 5] = [
        &[],
        &[("blur", "5")],
        &[("depth_stripes", "copied")],
        &[("depth_stripes", "blended"), ("overlay", "true")],
        &[("render_scale", "2"), ("mapped", "samples")],
    ];
    let (mut loads, mut drawn_over) = (0, 0);
    for set in choices {
        let Some(plan) = plan(set)? else { return Ok(()) };
        let mut stored = BTreeMap::new();
        for step in &plan.steps {
            let Work::Render(scope) = &step.work else { continue };
            let [first, ..] = &scope.passes[..] else { continue };
            for (attachment, blend) in scope.color().iter().zip(&first.blend) {
                let covers = first.draw == Some(Draw::FullScreen) && *blend == Blend::Replace && !first.discards;
                let wanted = if covers { LoadOp::DontCare } else { attachment.load };
                assert_eq!(attachment.load, wanted, "{set:?}: `{}` covers all: {}", first.name, plan.tree());
                drawn_over += usize::from(covers && stored.contains_key(&attachment.image));
            }
            for attachment in scope.attachments.iter() {
                let before = stored.insert(attachment.image, attachment.store);
                let loaded = attachment.load == LoadOp::Load;
                assert!(!loaded || before == Some(StoreOp::Store), "{set:?}: {}", plan.tree());
                loads += usize::from(loaded);
            }
        }
    }
    assert!(loads > 0, "some are drawn into twice");
    assert!(drawn_over > 0, "some are drawn over");
    Ok(())
}

/// IQ-19: as the user and the view allow, the scene is, and what follows needs.
#[test]
fn colour_is_floating_point_only_where_something_makes_use_of_it() -> Result<(), Box<dyn Error>> {
    let (bright, dim) = (shining_behind_glass([4.0; 3]), shining([0.5; 3]));
    let cases = [
        (&bright, "true", "reinhard", Format::R16G16B16A16_SFLOAT),
        (&bright, "true", "over_bright", Format::R16G16B16A16_SFLOAT),
        (&bright, "false", "reinhard", Format::R8G8B8A8_SRGB),
        (&bright, "true", "clip", Format::R8G8B8A8_SRGB),
        (&dim, "true", "reinhard", Format::R8G8B8A8_SRGB),
    ];
    for (scene, hdr, tone_mapping, format) in cases {
        let set =
            [("hdr", hdr), ("tone_mapping", tone_mapping), ("depth_stripes", "copied"), ("light_resolve", "Weighted")];
        let Some(plan) = plan_of(PIPELINE, &set, scene, true)? else { return Ok(()) };
        assert_eq!(format_of(&plan, "opaque"), Some(format), "{hdr}, {tone_mapping}");
        // The image in between keeps the format.
        assert_eq!(format_of(&plan, "copied_stripes.stripes"), Some(format), "{hdr}, {tone_mapping}");
    }
    Ok(())
}

/// IQ-22.
#[test]
fn tone_mapping_is_the_resolving_draw_if_samples_are_mapped() -> Result<(), Box<dyn Error>> {
    for blur in ["0", "3"] {
        let Some(plan) = plan(&[("mapped", "samples"), ("blur", blur)])? else { return Ok(()) };
        assert_eq!(plan.totals.resolves, 0, "{}", plan.tree());
        assert_eq!(listing(&plan)[..4], ["opaque", "sky", "transparent", "map_samples.tone_map"]);
    }
    Ok(())
}

/// IQ-24: as a frame debugger would list it.
#[test]
fn the_listing_shows_resolves_in_their_place() -> Result<(), Box<dyn Error>> {
    let Some(stripes) = plan(&[("mapped", "pixels"), ("depth_stripes", "copied")])? else { return Ok(()) };
    let expected = [
        "opaque",
        "sky",
        "(resolve)",
        "opaque (depth only)",
        "copied_stripes.stripes",
        "stripes_back",
        "transparent",
        "(resolve)",
        "map.curve.tone_map",
    ];
    assert_eq!(listing(&stripes), expected);
    let set = [("hdr", "false"), ("tone_mapping", "clip"), ("blur", "5")];
    let blurs = |numbers: &[usize]| numbers.iter().map(|number| format!("soften.blur[{number}]")).collect::<Vec<_>>();
    let scene = shining_behind_glass([4.0; 3]);
    let Some(naive) = plan_of(PIPELINE, &set, &scene, false)? else { return Ok(()) };
    let resolve = || vec!["(resolve)".to_owned()];
    let drawn = ["opaque", "sky", "transparent"].map(str::to_owned).to_vec();
    let three = [drawn.clone(), resolve(), blurs(&[0, 1]), resolve(), blurs(&[2, 3]), resolve(), blurs(&[4])].concat();
    assert_eq!(listing(&naive), three);
    let Some(ours) = plan_of(PIPELINE, &set, &scene, true)? else { return Ok(()) };
    assert_eq!(listing(&ours), [drawn, resolve(), blurs(&[0, 1, 2, 3, 4])].concat());
    Ok(())
}
