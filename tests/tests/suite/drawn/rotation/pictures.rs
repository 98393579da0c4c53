//! Shipped pipelines, rotated by the rule that says what is shown on a screen.

use super::EXTENT;
use framewright_graph::compile::Options;
use framewright_graph::plan::{Plan, Resource};
use framewright_graph::vulkan::Rotation;
use framewright_passes::scene::load;
use framewright_tests::render::{Setup, device, draw_rotated, in_repository, silent};
use framewright_tests::sweep;
use framewright_vulkan::{Device, Texels};
use std::error::Error;

/// A shipped pipeline, settings, how many frames are drawn, and how many texels of 5,917 may be off: where objects are drawn
/// straight into the screen, edges fall on one side or the other of what a driver's coordinates can say, and textures are looked
/// up by squares of two by two pixels, which odd sizes cut otherwise from the other side.
type Case<'a> = (&'a str, &'a [(&'a str, &'a str)], u32, usize);

/// Cases beside those of every shipped pipeline with its default settings.
const FORWARD: Case<'_> = ("forward", &[], 1, 0);
const FORWARD_WITHOUT_TONE_MAPPING: Case<'_> =
    ("forward", &[("msaa", "4"), ("hdr", "false"), ("tone_mapping", "false")], 1, 350);
const CASES: [Case<'_>; 9] = [
    FORWARD_WITHOUT_TONE_MAPPING,
    ("forward", &[("msaa", "1"), ("hdr", "false"), ("tone_mapping", "false")], 1, 100),
    ("image_quality", &[("msaa", "4"), ("render_scale", "1.5")], 1, 0),
    ("image_quality", &[("msaa", "4"), ("render_scale", "0.5"), ("blur", "5")], 1, 0),
    ("image_quality", &[("msaa", "1"), ("hdr", "false"), ("tone_mapping", "clip")], 1, 100),
    ("image_quality", &[("depth_stripes", "blended"), ("overlay", "true")], 1, 0),
    ("deferred", &[("overlay", "true")], 1, 0),
    ("deferred_mobile", &[("scale", "1")], 1, 0),
    ("post", &[("overlay", "false")], 2, 0),
];

/// Every file in the folder of shipped pipelines, by its default settings.
fn all_shipped() -> Result<Vec<String>, Box<dyn Error>> {
    let mut names = Vec::new();
    for file in std::fs::read_dir(in_repository("examples/pipelines"))? {
        let name = file?.file_name().to_string_lossy().into_owned();
        names.extend(name.strip_suffix(".ron").map(str::to_owned));
    }
    names.sort();
    Ok(names)
}

/// Squares of two by two pixels lie in it whichever way it is turned.
const EVEN: [u32; 2] = [96, 60];

fn shown(
    device: &Device,
    case: Case<'_>,
    extent: [u32; 2],
    rotation: Rotation,
) -> Result<(Plan, Texels), Box<dyn Error>> {
    let (pipeline, set, frames, _) = case;
    let pipeline = format!("examples/pipelines/{pipeline}.ron");
    let mut scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    // No seam of the spheres runs through the middles of pixels, where it is anybody's choice which side is drawn.
    scene.camera.transform.w_axis.x += 0.013;
    let setup = Setup { pipeline: &pipeline, set, scene: &scene, extent };
    let (plan, mut executor) = draw_rotated(device, &setup, &Options::default(), frames, rotation)?;
    let texels = executor.read(0)?;
    silent(device)?;
    Ok((plan, texels))
}

/// How many texels differ by more than one step of eight bits in a channel; and how many by more than three where the upright
/// picture has no edge.
fn off(found: &Texels, upright: &Texels) -> [usize; 2] {
    let [width, height, _] = upright.extent.map(|side| side as usize);
    let differ = |at: usize, other: &[u8]| {
        let texel = &upright.bytes[4 * at..4 * at + 4];
        texel.iter().zip(other).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
    };
    let is_edge = |at: usize| {
        let [xs, ys] =
            [(at % width, width), (at / width, height)].map(|(at, of)| at.saturating_sub(1)..(at + 2).min(of));
        let around = ys.flat_map(|y| xs.clone().map(move |x| y * width + x));
        around.map(|near| differ(at, &upright.bytes[4 * near..4 * near + 4])).any(|step| step > 8)
    };
    let steps = found.bytes.chunks(4).enumerate().map(|(at, texel)| (at, differ(at, texel)));
    let off: Vec<_> = steps.filter(|(_, step)| *step > 1).collect();
    [off.len(), off.iter().filter(|(at, step)| *step > 3 && !is_edge(*at)).count()]
}

/// PR-1, PR-3, PR-5: one step of eight bits, but for a few texels at edges; drawn so, and read back upright.
#[test]
fn every_shipped_pipeline_shows_the_same_rotated() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut wrong = Vec::new();
    let shipped = all_shipped()?;
    // In three frames what is kept from frame to frame shows.
    let cases = shipped.iter().map(|name| (&**name, &[][..], 3, 0)).chain(CASES);
    let cases = cases.flat_map(|case| [EVEN, EXTENT].map(|extent| (case, extent)));
    for (case, extent) in sweep::of("rotated pictures", cases.collect(), 5) {
        let (upright, expected) = shown(device, case, extent, Rotation::Identity)?;
        assert!(
            expected.bytes.chunks(4).collect::<std::collections::BTreeSet<_>>().len() > 100,
            "{case:?}: a flat picture"
        );
        for rotation in [Rotation::Rotate90, Rotation::Rotate180, Rotation::Rotate270] {
            let (plan, texels) = shown(device, case, extent, rotation)?;
            let Resource::Image(screen) = plan.outputs[0].resource else { panic!("no image") };
            let screen = plan.image(screen);
            let [width, height] = rotation.extent(extent);
            assert_eq!((screen.rotation, screen.extent), (rotation, [width, height, 1]), "{case:?}");
            assert_eq!(texels.extent, expected.extent);
            let more = |plan: &Plan| plan.totals.passes + plan.totals.inserted_passes + plan.totals.copies;
            assert_eq!(more(&plan), more(&upright), "{case:?}: drawn without a pass or copy more");
            let [count, within] = off(&texels, &expected);
            if count > case.3 || within > 0 {
                wrong.push(format!("{case:?} {rotation:?}: {count} texels are off, {within} within surfaces"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    Ok(())
}

/// PR-2: the image of several samples, and its depth, have the size of the rotated screen; with tone mapping they don't.
#[test]
fn what_is_resolved_into_the_screen_is_rotated_with_it() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for (case, expected) in
        [(FORWARD_WITHOUT_TONE_MAPPING, ["color", "depth", "screen"].as_slice()), (FORWARD, &["screen"])]
    {
        let (plan, _) = shown(device, case, EXTENT, Rotation::Rotate90)?;
        let turned: Vec<_> =
            plan.images.iter().filter(|image| image.rotation.turns()).map(|image| &*image.name).collect();
        assert_eq!(turned, expected, "{}", plan.tree());
        assert!(plan.images.iter().all(|image| {
            let [width, height] = image.rotation.extent(EXTENT);
            image.extent == [width, height, 1]
        }));
    }
    Ok(())
}
