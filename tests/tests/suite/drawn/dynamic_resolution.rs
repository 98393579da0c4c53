//! Images that change their size from frame to frame are used in part, and show what images of that size would (IQ-1).

use framewright_graph::compile::Options;
use framewright_graph::frame::Stereo;
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw::{Eyes, SceneDrawSource};
use framewright_passes::scene::{AlphaMode, Material, Scene};
use framewright_tests::render::{Setup, Ways, device, draw, library, own_device, plan, plan_for, silent};
use framewright_tests::shapes::{empty_scene, material, scene, sphere, square};
use framewright_tests::sweep;
use framewright_vulkan::{Device, Error as Failed, Executor, ExecutorOptions, ShaderLibrary};
use glam::{Mat4, Vec3};
use std::error::Error;

const PIPELINE: &str = "tests/pipelines/dynamic_resolution.ron";
const EXTENT: [u32; 2] = [67, 45];
const SCALES: [&str; 7] = ["0.25", "1", "0.5", "0.9", "0.2", "0.71", "0.99"];

/// Edges before one another and before nothing, up to the right and the lower border, and something to see through.
fn yard() -> Scene {
    let floor = Mat4::from_rotation_x(-1.2) * Mat4::from_scale(Vec3::splat(6.0));
    let tilted = Mat4::from_translation(Vec3::new(0.4, 0.3, 1.0)) * Mat4::from_rotation_z(0.4);
    let objects = vec![(0, 0, floor), (0, 1, tilted), (1, 2, Mat4::from_translation(Vec3::new(-1.0, 0.5, 0.5)))];
    let clear = Material { alpha: AlphaMode::Blend, ..material([0.3, 0.2, 0.9, 0.5]) };
    scene(
        vec![square(), sphere(16)],
        vec![material([0.9, 0.7, 0.3, 1.0]), material([0.2, 0.9, 0.4, 1.0]), clear],
        objects,
    )
}

/// The picture and the counts of a frame.
type Shown = (Vec<u8>, Vec<u8>);

/// Transient images are full of conspicuous values before they are drawn into.
fn poisoned() -> Options {
    Options { poison: true, ..Options::default() }
}

fn shown(executor: &mut Executor) -> Result<Shown, Box<dyn Error>> {
    Ok((executor.read(0)?.bytes, executor.read_buffer("bins")?))
}

/// One frame, drawn by an executor of its own.
fn alone(device: &Device, yard: &Scene, set: &[(&str, &str)]) -> Result<Shown, Box<dyn Error>> {
    let setup = Setup { pipeline: PIPELINE, set, scene: yard, extent: EXTENT };
    let (_, mut executor) = draw(device, &setup, &poisoned(), 1)?;
    shown(&mut executor)
}

/// The picture of the shipped pipeline, whose bloom goes down to the least parts, and those of its images that are as small.
fn shipped(
    device: &Device,
    yard: &Scene,
    scale: &str,
    extent: [u32; 2],
    poison: bool,
) -> Result<(Vec<u8>, usize), Box<dyn Error>> {
    let set = [("render_scale", scale), ("bloom", "1"), ("filter", "bilinear")];
    let setup = Setup { pipeline: "examples/pipelines/dynamic_resolution.ron", set: &set, scene: yard, extent };
    let (plan, mut executor) = draw(device, &setup, &Options { poison, ..Options::default() }, 1)?;
    let parts = plan.images.iter().filter_map(|image| Some((image.extent, image.allocated?)));
    let sides = parts.flat_map(|(part, allocated)| [(part[0], allocated[0]), (part[1], allocated[1])]);
    let (least, less): (Vec<_>, Vec<_>) =
        sides.filter(|(part, allocated)| *part <= 2.min(*allocated)).partition(|side| side.0 == 2);
    assert!(
        less.iter().all(|(_, allocated)| *allocated == 1),
        "{scale} of {extent:?}: parts and rooms of {less:?} texels"
    );
    Ok((executor.read(0)?.bytes, least.len()))
}

/// The greatest difference of two pictures in 8-bit steps, and how many channels differ.
fn difference(one: &[u8], other: &[u8]) -> (u8, usize) {
    assert_eq!(one.len(), other.len());
    let steps = one.iter().zip(other).map(|(one, other)| one.abs_diff(*other));
    (steps.clone().max().unwrap_or(0), steps.filter(|step| *step > 0).count())
}

/// Filters that only fetch texels give the same bit for bit; a linear filter finds its weights at other places of the image,
/// which may round in another way.
#[test]
fn a_part_shows_what_an_image_of_its_size_would_and_nothing_of_what_lies_beyond() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let yard = yard();
    let filters = [("nearest", "false"), ("area", "false"), ("catmull_rom", "false"), ("bilinear", "true")];
    let cases = SCALES.iter().flat_map(|scale| filters.map(|filter| (*scale, filter)));
    for (scale, (filter, soft)) in sweep::of("parts of images", cases.collect(), 10) {
        let set = |largest| [("scale", scale), ("largest", largest), ("filter", filter), ("soft", soft)];
        let part = alone(device, &yard, &set("1.2"))?;
        let whole = alone(device, &yard, &set(scale))?;
        assert!(part.1 == whole.1, "{scale}: other texels were counted");
        let (most, channels) = difference(&part.0, &whole.0);
        let bound = if soft == "true" { 1 } else { 0 };
        assert!(most <= bound, "{scale}, {filter}: {channels} channels differ by up to {most}");
    }
    Ok(())
}

/// Of parts down to the least, two texels wide and high: a filter reads two in each direction, one perhaps with weight 0, and 0
/// times what isn't a number is none. Between both ends of a part of one texel there is no room for a filter, and which of them
/// counts is up to the driver, so that the picture alone doesn't tell.
#[test]
fn what_lies_beyond_makes_no_difference_however_small_the_part() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let (yard, mut smallest) = (yard(), 0);
    for (scale, extent) in
        [("0.37", [61, 43]), ("0.3333", [63, 37]), ("0.25", [64, 64]), ("0.37", [64, 160]), ("0.75", EXTENT)]
    {
        let [one, other] = [false, true].map(|poison| shipped(device, &yard, scale, extent, poison));
        let ((one, least), (other, _)) = (one?, other?);
        assert_eq!(difference(&one, &other), (0, 0), "{scale} of {extent:?}");
        smallest += least;
    }
    assert!(smallest > 0, "some parts are as small as that");
    silent(device)
}

#[test]
fn the_scale_changes_in_every_frame_and_nothing_is_made_anew_for_it() -> Result<(), Box<dyn Error>> {
    let Some(device) = own_device() else { return Ok(()) };
    let device = &device;
    let yard = yard();
    let mut shaders = library();
    let planned = |scale, shaders: &mut ShaderLibrary| {
        let setup = Setup { pipeline: PIPELINE, set: &[("scale", scale)], scene: &yard, extent: EXTENT };
        plan(device, &setup, shaders, &poisoned())
    };
    let first = planned(SCALES[0], &mut shaders)?;
    let mut draws = SceneDrawSource::for_plan(device, &yard, EXTENT, &first)?;
    let how = ExecutorOptions { poison: true, frames_in_flight: 2, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &first, &mut shaders, &how)?;
    executor.frame(&mut draws)?;
    executor.submit(&mut draws)?;
    let before = device.memory_in_use();
    let mut areas = Vec::new();
    for scale in SCALES {
        let plan = planned(scale, &mut shaders)?;
        assert_eq!(first.differs_beyond_values(&plan), None, "{scale}");
        executor.change(&plan)?;
        executor.submit(&mut draws)?;
        executor.submit(&mut draws)?;
        assert_eq!(device.memory_in_use(), before, "{scale}");
        let (picture, bins) = shown(&mut executor)?;
        let expected = alone(device, &yard, &[("scale", scale)])?;
        assert!(bins == expected.1, "{scale}: other texels were counted");
        assert_eq!(difference(&picture, &expected.0), (0, 0), "{scale}");
        let counted = bins.as_chunks::<4>().0.iter().map(|count| u32::from_ne_bytes(*count));
        areas.push(counted.sum::<u32>());
    }
    assert_eq!(areas, [16 * 11, 67 * 45, 33 * 22, 60 * 40, 13 * 9, 47 * 31, 66 * 44]);
    silent(device)
}

#[test]
fn parameters_change_between_frames_in_flight_and_more_than_values_is_refused() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let yard = yard();
    let mut shaders = library();
    let planned = |set: &[(&str, &str)], shaders: &mut ShaderLibrary| {
        plan(device, &Setup { pipeline: PIPELINE, set, scene: &yard, extent: EXTENT }, shaders, &poisoned())
    };
    let first = planned(&[], &mut shaders)?;
    let mut draws = SceneDrawSource::for_plan(device, &yard, EXTENT, &first)?;
    let how = ExecutorOptions { poison: true, frames_in_flight: 3, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &first, &mut shaders, &how)?;
    for white_point in ["8", "1", "40"] {
        executor.change(&planned(&[("white_point", white_point)], &mut shaders)?)?;
        executor.submit(&mut draws)?;
        executor.submit(&mut draws)?;
        let expected = alone(device, &yard, &[("white_point", white_point)])?;
        assert!(shown(&mut executor)? == expected, "{white_point}");
    }
    for (more, what) in [(("msaa", "1"), "images"), (("largest", "1.5"), "images"), (("soft", "false"), "")] {
        let Err(Failed::BadPlan { what: said }) = executor.change(&planned(&[more], &mut shaders)?) else {
            return Err(format!("{more:?} was taken").into());
        };
        assert!(said.starts_with("an executor must be made anew for it: ") && said.contains(what), "{said}");
    }
    executor.frame(&mut draws)?;
    assert!(shown(&mut executor)? == alone(device, &yard, &[("white_point", "40")])?, "it stays with what it had");
    silent(device)
}

/// The right eye's half begins at another texel for each scale, which shaders are told by constants of their pipelines.
#[test]
fn places_in_an_eyes_half_follow_the_scale() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let (scene, mut shaders) = (empty_scene(), library());
    let ways = Ways { stereo: Stereo::DoubleWide, rotation: Rotation::Identity };
    let planned = |scale| {
        let set = &[("scale", scale)];
        let setup = Setup { pipeline: "tests/pipelines/eyes_dynamic.ron", set, scene: &scene, extent: EXTENT };
        plan_for(device, &setup, ways, &mut shaders, &poisoned())
    };
    let plans = SCALES.map(planned);
    let plans = plans.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut draws = SceneDrawSource::for_eyes(device, &scene, EXTENT, &plans[0], &Eyes::default())?;
    let how = ExecutorOptions { poison: true, frames_in_flight: 2, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plans[0], &mut shaders, &how)?;
    for (plan, scale) in plans.iter().zip(SCALES) {
        executor.change(plan)?;
        executor.submit(&mut draws)?;
        executor.submit(&mut draws)?;
        let mut anew = Executor::new(device, plan, &mut shaders, &how)?;
        anew.frame(&mut draws)?;
        assert!(executor.read(0)?.bytes == anew.read(0)?.bytes, "{scale}: other places");
    }
    silent(device)
}
