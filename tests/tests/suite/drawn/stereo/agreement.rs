//! Pictures that are drawn for both eyes at once, compared pixel by pixel with one eye after the other.

use super::{Case, EVEN, EXTENT, Pair, apart_within, at_once, drawn, form, shipped, upright};
use framewright_graph::frame::{EyeForm, Stereo};
use framewright_passes::draw::Eyes;
use framewright_passes::scene::load;
use framewright_tests::render::{device, in_repository};
use framewright_tests::shapes::empty_scene;
use framewright_tests::sweep;
use framewright_vulkan::Device;
use std::collections::BTreeSet;
use std::error::Error;

/// A pipeline, its settings, the scene, how many frames are drawn, and how many pixels of 5,917 may be off in a half. There the
/// right eye's picture begins elsewhere: edges fall on one side or the other of what a driver's coordinates can say, and textures
/// are looked up by squares of two by two pixels, which odd widths cut otherwise. What blurs spreads that. A driver may choose by a
/// pixel's place which samples alpha covers (lavapipe 25 does): the right eye of an odd width has other places.
type Shipped<'a> = (&'a str, &'a [(&'a str, &'a str)], &'a str, u32, usize);

/// Most pixels that are off where a driver chooses by a pixel's place. At even widths at most six are.
const BY_PLACE: usize = 140;

const LARGE: [u32; 2] = [641, 361];

/// Most pixels, of 231,401, that may be off in a large picture.
const MOST_OF_LARGE: usize = 500;

const SPHERES: &str = "spheres_and_cubes";
const CASES: [Shipped<'_>; 24] = [
    ("auto_exposure", &[], SPHERES, 3, 6),
    ("auto_exposure", &[("msaa", "1"), ("adaptation", "0")], SPHERES, 3, 4),
    ("deferred", &[("shadow_size", "512")], "courtyard", 1, 4),
    ("deferred", &[("shadow_size", "512"), ("overlay", "true"), ("anti_aliasing", "false")], SPHERES, 1, 4),
    ("deferred_mobile", &[], SPHERES, 1, 1),
    ("dynamic_resolution", &[], SPHERES, 1, 52),
    ("dynamic_resolution", &[("render_scale", "0.6"), ("msaa", "1")], SPHERES, 1, 46),
    ("forward", &[], SPHERES, 1, 6),
    ("forward", &[("msaa", "1")], SPHERES, 1, 4),
    ("forward", &[("hdr", "false"), ("tone_mapping", "false")], SPHERES, 1, 6),
    ("forward_overlay", &[], SPHERES, 1, 14),
    ("image_quality", &[("msaa", "1"), ("hdr", "false"), ("tone_mapping", "clip")], SPHERES, 1, 4),
    ("image_quality", &[("alpha_to_coverage", "true")], SPHERES, 1, BY_PLACE),
    ("image_quality", &[("depth_resolve", "DepthOnly"), ("depth_stripes", "blended")], SPHERES, 1, 8),
    ("image_quality", &[("render_scale", "0.77"), ("depth_stripes", "copied"), ("blur", "3")], SPHERES, 1, 48),
    ("post", &[("blur", "2")], SPHERES, 1, 22),
    ("post", &[("msaa", "1")], SPHERES, 1, 11),
    ("shadows", &[("shadow_size", "512")], "courtyard", 1, 4),
    ("shadows", &[("shadow_size", "512"), ("msaa", "1")], "courtyard", 1, 4),
    ("snow", &[], SPHERES, 3, 6),
    ("snow", &[("msaa", "1")], SPHERES, 3, 4),
    ("soft_focus", &[], SPHERES, 1, 6),
    ("soft_focus", &[("msaa", "1")], SPHERES, 1, 4),
    ("temporal", &[], "passing", 3, 8),
];

/// A way that draws for both eyes at once: where it puts them, and for each picture of each eye how many pixels are off, and how
/// many of those by more than three steps away from an edge.
struct Way {
    stereo: Stereo,
    form: Option<EyeForm>,
    off: Vec<[usize; 2]>,
}

fn ways(device: &Device, case: Shipped<'_>, extent: [u32; 2]) -> Result<Vec<Way>, Box<dyn Error>> {
    let (pipeline, set, scene, frames, _) = case;
    let (file, scene) = (shipped(pipeline), load(&in_repository(&format!("examples/scenes/{scene}.ron")))?);
    let case = Case { pipeline: &file, set, scene: &scene, extent, frames };
    let alone = drawn(device, &case, upright(Stereo::MultiPass), &Eyes::default())?;
    let mut ways = Vec::new();
    for stereo in at_once(device) {
        let both = drawn(device, &case, upright(stereo), &Eyes::default())?;
        let form = form(&both.plan);
        // How many flakes are drawn stands in a buffer, which only views don't count.
        let by_buffer = pipeline == "snow" && stereo != Stereo::Multiview;
        assert_eq!(form.is_none(), by_buffer, "{pipeline}, {}: {}", stereo.name(), both.plan.tree());
        let frames = both.frames.iter().zip(&alone.frames);
        let pictures = frames.flat_map(|(both, alone)| both.iter().flatten().zip(alone.iter().flatten()));
        let off = pictures.map(|(one, other)| apart_within(one, other, extent)).collect();
        ways.push(Way { stereo, form, off });
    }
    Ok(ways)
}

/// Fails if more than `most` pixels of an eye are off in halves, or more than `away` away from edges; or one in layers.
fn agree<'a>(device: &Device, cases: Vec<(Shipped<'a>, [u32; 2], usize)>, away: usize) -> Result<(), Box<dyn Error>> {
    let (mut found, mut wrong) = (Vec::new(), false);
    for (case, extent, most) in cases {
        for Way { stereo, form, off } in ways(device, case, extent)? {
            let [most, away] = if form == Some(EyeForm::Halves) { [most, away] } else { [0; 2] };
            wrong |= off.iter().any(|[off, within]| *off > most || *within > away);
            if off.iter().any(|off| *off != [0, 0]) {
                let (pipeline, set, ..) = case;
                let how = stereo.name();
                found.push(format!("{pipeline} {set:?} {extent:?} {how} ({form:?}), at most {most}: {off:?}"));
            }
        }
    }
    println!("{}", found.join("\n"));
    assert!(!wrong, "pixels off, and pixels off where there is no edge:\n{}", found.join("\n"));
    Ok(())
}

/// ST-14, ST-4, ST-16.
#[test]
fn every_shipped_pipeline_shows_each_eye_what_it_sees_alone() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    // Cases that differ by settings do so at odd widths, but for what a driver chooses by a pixel's place.
    let even = CASES.iter().enumerate();
    let even = even.filter(|(at, case)| *at == 0 || CASES[at - 1].0 != case.0 || case.4 == BY_PLACE);
    let even = even.map(|(_, case)| (*case, EVEN, if case.4 == BY_PLACE { 6 } else { case.4 }));
    let cases = CASES.iter().map(|case| (*case, EXTENT, case.4)).chain(even);
    agree(device, sweep::of("each eye alone", cases.collect(), 4), 0)
}

/// ST-14: of pictures with 39 times as many pixels, by the settings that differ most. docs/stereo.md has the numbers of all.
#[test]
fn larger_pictures_agree_too() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let blurred = |case: &&Shipped<'_>| case.1.contains(&("blur", "3"));
    agree(device, CASES.iter().filter(blurred).map(|case| (*case, LARGE, MOST_OF_LARGE)).collect(), 0)
}

/// Prints what docs/stereo.md says of larger pictures. Only with `FRAMEWRIGHT_LONG`: it takes several minutes.
#[test]
fn all_larger_pictures_agree_too() -> Result<(), Box<dyn Error>> {
    if !sweep::is_long() {
        return Ok(());
    }
    let Some(device) = device() else { return Ok(()) };
    let most = |case: &Shipped<'_>| if case.4 == BY_PLACE { 39 * BY_PLACE } else { MOST_OF_LARGE };
    agree(device, CASES.iter().map(|case| (*case, LARGE, most(case))).collect(), 3)
}

#[test]
fn no_shipped_pipeline_is_left_out() -> Result<(), Box<dyn Error>> {
    let mut shipped = BTreeSet::new();
    for file in std::fs::read_dir(in_repository("examples/pipelines"))? {
        let name = file?.file_name().to_string_lossy().into_owned();
        shipped.extend(name.strip_suffix(".ron").map(str::to_owned));
    }
    assert_eq!(shipped, CASES.iter().map(|case| case.0.to_owned()).collect());
    Ok(())
}

/// ST-14, ST-9: bit by bit, of all samples, copied, and of the left eye's where both see it.
#[test]
fn texels_are_fetched_exactly() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    for (set, extent) in [
        (&[][..], EXTENT),
        (&[("msaa", "1")], EVEN),
        (&[("scale", "0.77")], EXTENT),
        (&[("scale", "2"), ("msaa", "1")], EXTENT),
        (&[], [3, 2]),
    ] {
        let case = Case { pipeline: "tests/pipelines/eyes_fetched.ron", set, scene: &scene, extent, frames: 1 };
        let alone = drawn(device, &case, upright(Stereo::MultiPass), &Eyes::default())?;
        let [numbers, around, of_samples, _, left] = &alone.frames[0][..] else { return Err("no five outputs".into()) };
        for [one, other] in [numbers, around, of_samples] {
            assert!(one != other, "both eyes see the same");
        }
        assert!(left[0] == left[1] && left[0] == around[0], "not what the left eye sees");
        for stereo in at_once(device) {
            let both = drawn(device, &case, upright(stereo), &Eyes::default())?;
            assert_eq!(both.plan.images.iter().filter(|image| image.eyes.is_none()).count(), 0, "{}", both.plan.tree());
            for (at, (both, alone)) in both.frames[0].iter().zip(&alone.frames[0]).enumerate() {
                assert!(both == alone, "output {at}, {set:?}, {extent:?}, {}", stereo.name());
            }
        }
    }
    Ok(())
}

/// ST-6, ST-7, ST-9: what looks around itself sees nothing of the other eye's picture, not one bit.
#[test]
fn nothing_bleeds_from_one_eye_into_the_other() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    let looks = [
        ("0.5", "bilinear", "false", EXTENT),
        ("2", "bilinear", "false", EVEN),
        ("0.5", "area", "true", EVEN),
        ("2", "nearest", "true", EXTENT),
        ("0.77", "catmull_rom", "true", EXTENT),
        ("1", "bilinear", "false", [1, 7]),
    ];
    let modes = [at_once(device), vec![Stereo::MultiPass]].concat();
    let cases = modes.into_iter().flat_map(|stereo| looks.map(|look| (stereo, look)));
    for (stereo, (scale, filter, dynamic, extent)) in sweep::of("blurs of both eyes", cases.collect(), 8) {
        let set = &[("scale", scale), ("filter", filter), ("dynamic", dynamic)];
        let case = Case { pipeline: "tests/pipelines/eyes_blurred.ron", set, scene: &scene, extent, frames: 1 };
        let found = drawn(device, &case, upright(stereo), &Eyes::default())?;
        assert_eq!(found.frames[0].len(), 5);
        for (at, pair) in found.frames[0].iter().enumerate() {
            bleeds_nowhere(pair).map_err(|why| format!("output {at}, {set:?}, {}: {why}", stereo.name()))?;
        }
    }
    Ok(())
}

/// Of 16-bit floats the left picture is red alone, the right one green alone.
fn bleeds_nowhere(pair: &Pair) -> Result<(), String> {
    for (eye, picture) in pair.iter().enumerate() {
        let texels = picture.as_chunks::<8>().0;
        let channel = |of: &[u8; 8], at: usize| u16::from_ne_bytes([of[2 * at], of[2 * at + 1]]);
        let other = texels.iter().filter(|texel| channel(texel, 1 - eye) != 0).count();
        // 0.9 as 16 bits.
        let own = texels.iter().filter(|texel| channel(texel, eye) > 0x3b33).count();
        if other > 0 || own < texels.len() {
            return Err(format!("{other} texels of {} have the other eye's colour, {own} their own", texels.len()));
        }
    }
    Ok(())
}

/// ST-7: half a texel of the level inside of the half, as calculated here.
#[test]
fn places_are_clamped_within_the_half_of_each_mip_level() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    let case =
        Case { pipeline: "tests/pipelines/eyes_clamped.ron", set: &[], scene: &scene, extent: EXTENT, frames: 1 };
    for stereo in [vec![Stereo::MultiPass], at_once(device)].concat() {
        let found = drawn(device, &case, upright(stereo), &Eyes::default())?;
        for (level, pair) in found.frames[0].iter().enumerate() {
            for (eye, picture) in pair.iter().enumerate() {
                for (at, texel) in super::floats(picture).into_iter().enumerate() {
                    let place = [(at % 97) as f32 + 0.5, (at / 97) as f32 + 0.5];
                    let [red, green, x, y] = texel;
                    assert_eq!([red, green], if eye == 0 { [1.0, 0.0] } else { [0.0, 1.0] }, "level {level}, at {at}");
                    let asked = [1.6 * place[0] / 97.0 - 0.3, 1.6 * place[1] / 61.0 - 0.3];
                    let margin = (0.5 + 1.0 / 512.0) / (64 >> level) as f32;
                    let begin = 0.5 * eye as f32;
                    let clamped = [
                        (0.5 * asked[0] + begin).clamp(begin + margin, begin + 0.5 - margin),
                        // All of the height is seen: nothing lies beyond.
                        asked[1],
                    ];
                    let off = (x - clamped[0]).abs().max((y - clamped[1]).abs());
                    assert!(off < 1e-5, "level {level}, {} at {at}: {x}, {y} for {clamped:?}", stereo.name());
                }
            }
        }
    }
    Ok(())
}
