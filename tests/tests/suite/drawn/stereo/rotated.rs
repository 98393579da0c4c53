//! Both eyes' pictures on a rotated screen.

use super::{Case, EVEN, EXTENT, apart, apart_within, at_once, cameras, drawn, form, shipped};
use framewright_graph::frame::{EyeForm, Stereo};
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw::Eyes;
use framewright_passes::scene::load;
use framewright_tests::render::{Ways, device, in_repository};
use framewright_tests::shapes::empty_scene;
use framewright_tests::sweep;
use std::error::Error;

const TURNED: [Rotation; 3] = [Rotation::Rotate90, Rotation::Rotate180, Rotation::Rotate270];

/// Settings of `image_quality`, how many pixels of 5,917 may be off from the upright picture, and how many from what is drawn
/// for one eye after the other on a screen turned alike. Drawn straight into the screen, edges and textures are a little other.
type Shipped<'a> = (&'a [(&'a str, &'a str)], usize, usize);

const CASES: [Shipped<'_>; 5] = [
    (&[("msaa", "4"), ("render_scale", "1.5")], 0, 8),
    (&[("msaa", "4"), ("render_scale", "0.77"), ("blur", "2"), ("filter", "bilinear")], 0, 15),
    (&[("msaa", "1"), ("render_scale", "0.5"), ("depth_stripes", "blended")], 0, 0),
    (&[("msaa", "4"), ("hdr", "false"), ("tone_mapping", "clip")], 350, 6),
    (&[("msaa", "1"), ("hdr", "false"), ("tone_mapping", "clip")], 100, 4),
];

/// ST-14 with PR-1, render scales and samples.
#[test]
fn at_every_scale_and_number_of_samples_each_eye_sees_the_same_turned() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    // No seam of the spheres runs through the middles of pixels, where it is anybody's choice which side is drawn.
    scene.camera.transform.w_axis.x += 0.013;
    let (mut found, mut wrong) = (Vec::new(), false);
    let extents = [EXTENT, EVEN, EXTENT, EXTENT, EVEN];
    for ((set, from_upright, from_alone), extent) in
        sweep::of("rotated eyes", CASES.into_iter().zip(extents).collect(), 1)
    {
        let case = Case { pipeline: &shipped("image_quality"), set, scene: &scene, extent, frames: 1 };
        let shown = |stereo, rotation| drawn(device, &case, Ways { stereo, rotation }, &Eyes::default());
        let turned: Vec<_> = TURNED.iter().map(|it| shown(Stereo::MultiPass, *it)).collect::<Result<_, _>>()?;
        for stereo in at_once(device) {
            let upright = shown(stereo, Rotation::Identity)?;
            for (rotation, alone) in TURNED.into_iter().zip(&turned) {
                let both = shown(stereo, rotation)?;
                let screens = both.plan.images.iter().filter(|it| it.eyes.is_some() && it.rotation == rotation);
                assert!(screens.count() > 0, "{}", both.plan.tree());
                let off = |others: &super::Drawn| {
                    let pairs = both.frames[0][0].iter().zip(&others.frames[0][0]);
                    pairs.map(|(one, other)| apart_within(one, other, extent)).collect::<Vec<_>>()
                };
                let (upright, alone) = (off(&upright), off(alone));
                let most = if form(&both.plan) == Some(EyeForm::Layers) { 0 } else { from_alone };
                wrong |= upright.iter().any(|[off, within]| *off > from_upright || *within > 0);
                wrong |= alone.iter().any(|[off, within]| *off > most || *within > 0);
                if [&upright, &alone].into_iter().flatten().any(|off| *off != [0, 0]) {
                    let how = stereo.name();
                    found.push(format!(
                        "{set:?} {extent:?} {how} {rotation:?}: {upright:?} from upright, {alone:?} from multi-pass"
                    ));
                }
            }
        }
    }
    println!("{}", found.join("\n"));
    assert!(!wrong, "pixels off, and pixels off where there is no edge:\n{}", found.join("\n"));
    Ok(())
}

/// ST-14 with PR-6: of each eye's own picture, in every mode and rotation.
#[test]
fn derivatives_and_places_are_those_of_the_upright_picture_of_each_eye() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    for extent in [EVEN, EXTENT] {
        let case = Case { pipeline: "tests/pipelines/eyes_ramp.ron", set: &[], scene: &scene, extent, frames: 1 };
        for stereo in [vec![Stereo::MultiPass], at_once(device)].concat() {
            for rotation in Rotation::ALL {
                let shown = drawn(device, &case, Ways { stereo, rotation }, &Eyes::default())?;
                for (eye, picture) in ["left", "right"].iter().zip(&shown.frames[0][0]) {
                    // Half of what 255 stands for, by the curve of sRGB.
                    let off = picture
                        .as_chunks::<4>()
                        .0
                        .iter()
                        .filter(|[dx, dy, there, _]| dx.abs_diff(188) > 1 || dy.abs_diff(188) > 1 || *there != 255);
                    assert_eq!(off.count(), 0, "the {eye} eye, {}, {rotation:?}: {:?}", stereo.name(), &picture[..4]);
                }
            }
        }
    }
    Ok(())
}

#[test]
fn one_eye_after_the_other_sees_the_same_turned() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    for (pipeline, set) in [("forward", &[][..]), ("image_quality", &[("render_scale", "0.7")][..])] {
        let file = shipped(pipeline);
        let shown = |rotation| {
            let ways = Ways { rotation, ..cameras::TWO };
            cameras::pictures(device, (&file, set), &scene, ways, &Eyes::default())
        };
        let (_, upright) = shown(Rotation::Identity)?;
        for rotation in TURNED {
            let (plan, turned) = shown(rotation)?;
            assert_eq!(plan.images.iter().filter(|image| image.rotation == rotation).count(), 2, "both eyes' screens");
            for (upright, turned) in upright.iter().zip(&turned) {
                let apart = apart(upright, turned);
                assert!(apart <= upright.len() / 4 / 1000, "{pipeline:?} turned by {rotation:?}: {apart} differ");
            }
        }
    }
    Ok(())
}
