//! Images whose size changes from frame to frame have histories, mip levels and layers, are stored into, and leave the frame: row DO-10.

use framewright_graph::compile::Options;
use framewright_graph::frame::Stereo;
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::{Aspects, Rotation};
use framewright_passes::draw::{Eyes, SceneDrawSource};
use framewright_passes::scene::Scene;
use framewright_tests::render::{Setup, Ways, device, draw, library, own_device, plan, plan_for, rgba, silent};
use framewright_tests::shapes::{empty_scene, material, scene, sphere, square};
use framewright_vulkan::{Device, Executor, ExecutorOptions, ShaderLibrary, Texels};
use glam::{Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [67, 45];
const SCALES: [&str; 8] = ["0.5", "1", "0.25", "0.9", "0.9", "0.2", "0.71", "0.99"];

/// What images hold before they are written is conspicuous.
fn poisoned() -> Options {
    Options { poison: true, ..Options::default() }
}

fn poisons(frames_in_flight: u32) -> ExecutorOptions {
    ExecutorOptions { poison: true, frames_in_flight, ..ExecutorOptions::default() }
}

fn yard() -> Scene {
    let floor = Mat4::from_rotation_x(-1.2) * Mat4::from_scale(Vec3::splat(6.0));
    let objects = vec![(0, 0, floor), (1, 1, Mat4::from_translation(Vec3::new(-1.0, 0.5, 0.5)))];
    scene(vec![square(), sphere(16)], vec![material([0.9, 0.7, 0.3, 1.0]), material([0.2, 0.9, 0.4, 1.0])], objects)
}

/// Plans of a pipeline in which one setting differs. All but values is the same.
fn plans(
    device: &Device,
    pipeline: &str,
    scene: &Scene,
    shaders: &mut ShaderLibrary,
) -> Result<Vec<Plan>, Box<dyn Error>> {
    let planned = |scale: &&str| {
        plan(device, &Setup { pipeline, set: &[("scale", scale)], scene, extent: EXTENT }, shaders, &poisoned())
    };
    let plans = SCALES.iter().map(planned).collect::<Result<Vec<_>, _>>()?;
    for plan in &plans {
        assert_eq!(plans[0].differs_beyond_values(plan), None);
        assert_eq!(plans[0].heaps, plan.heaps);
    }
    Ok(plans)
}

/// Width and height of a part of the output.
fn part(scale: &str) -> [u32; 2] {
    let factor: f64 = scale.parse().expect("a number");
    EXTENT.map(|side| (f64::from(side) * factor + 1e-6) as u32)
}

/// A picture of numbers.
type Numbers = ([u32; 2], Vec<u32>);

fn numbers(texels: &Texels) -> Numbers {
    let all = texels.bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word));
    ([texels.extent[0], texels.extent[1]], all.collect())
}

/// What `trail.frag` draws at this size where the frames before left `before` and `older`.
fn trail([width, height]: [u32; 2], before: &Numbers, older: &Numbers) -> Numbers {
    let found = |(extent, all): &Numbers, [x, y]: [u32; 2]| {
        all[((y * extent[1] / height) * extent[0] + x * extent[0] / width) as usize]
    };
    let texels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let drawn = texels.map(|at| 1000 + at[0] + 100 * at[1] + found(before, at) / 2 + found(older, at) / 4);
    ([width, height], drawn.collect())
}

#[test]
fn a_shader_is_told_how_large_each_earlier_frame_was_do_10() -> Result<(), Box<dyn Error>> {
    let Some(device) = own_device() else { return Ok(()) };
    let (scene, mut shaders) = (empty_scene(), library());
    let plans = plans(&device, "tests/pipelines/dynamic_trail.ron", &scene, &mut shaders)?;
    let mut draws = SceneDrawSource::for_plan(&device, &scene, EXTENT, &plans[0])?;
    let mut executor = Executor::new(&device, &plans[0], &mut shaders, &poisons(2))?;
    let nothing = || ([1, 1], vec![0]);
    let (mut before, mut older) = (nothing(), nothing());
    for (round, times) in [1, 2, 3].into_iter().enumerate() {
        for (plan, scale) in plans.iter().zip(SCALES) {
            executor.change(plan)?;
            for _ in 0..times {
                executor.submit(&mut draws)?;
                let drawn = trail(part(scale), &before, &older);
                (before, older) = (drawn, before);
            }
            assert!(numbers(&executor.read(0)?) == before, "round {round}, {scale}");
        }
    }
    // What a Plan that isn't changed to finds is as large as it was, too.
    let set = [("scale", "0.4"), ("share", "1")];
    let setup = Setup { pipeline: "tests/pipelines/dynamic_trail.ron", set: &set, scene: &scene, extent: EXTENT };
    let other = plan(&device, &setup, &mut shaders, &poisoned())?;
    assert!(executor.change(&other).is_err(), "another image has another size");
    let mut next = Executor::new(&device, &other, &mut shaders, &poisons(1))?;
    assert_eq!(next.migrate_from(executor)?.len(), 3);
    for _ in 0..3 {
        next.submit(&mut draws)?;
        let drawn = trail(part("0.4"), &before, &older);
        (before, older) = (drawn, before);
        assert!(numbers(&next.read(0)?) == before, "after migration");
    }
    silent(&device)
}

/// Each frame, against one whose images all have a fixed size and whose history the host wrote.
#[test]
fn taa_shows_what_images_of_the_size_of_each_frame_would_do_10() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let (yard, mut shaders) = (yard(), library());
    let plans = plans(device, "tests/pipelines/dynamic_taa.ron", &yard, &mut shaders)?;
    let mut draws = SceneDrawSource::for_plan(device, &yard, EXTENT, &plans[0])?;
    let mut executor = Executor::new(device, &plans[0], &mut shaders, &poisons(2))?;
    let mut before: Option<(&str, [Texels; 2])> = None;
    for (plan, scale) in plans.iter().zip(SCALES) {
        executor.change(plan)?;
        executor.submit(&mut draws)?;
        let [screen, steady, record] = [executor.read(0)?, executor.read(1)?, executor.read(2)?];
        let size = before.as_ref().map_or(scale, |(scale, _)| scale);
        let set = [("scale", scale), ("before", size)];
        let still = Setup { pipeline: "tests/pipelines/still_taa.ron", set: &set, scene: &yard, extent: EXTENT };
        let still = self::plan(device, &still, &mut shaders, &poisoned())?;
        let mut judge = Executor::new(device, &still, &mut shaders, &poisons(1))?;
        if let Some((_, [steady, record])) = &before {
            judge.write_image("steady_before", Aspects::COLOR, 0, &steady.bytes)?;
            judge.write_image("record_before", Aspects::COLOR, 0, &record.bytes)?;
        }
        let mut still = SceneDrawSource::for_plan(device, &yard, EXTENT, &still)?;
        judge.frame(&mut still)?;
        assert_eq!(steady.extent[..2], part(scale), "{scale}");
        assert!(judge.read(1)? == steady, "{scale}: other light");
        assert!(judge.read(2)? == record, "{scale}: another record");
        assert!(judge.read(0)? == screen, "{scale}: another picture");
        before = Some((scale, [steady, record]));
    }
    silent(device)
}

/// In each way to draw two eyes, and with the picture turned: a history that was drawn by one factor serves the next as if all were made anew
/// for each, since it holds the very same.
#[test]
fn histories_of_both_eyes_follow_the_size_do_10() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let yard = yard();
    let modes = [Stereo::Off, Stereo::MultiPass, Stereo::DoubleWide, Stereo::Multiview, Stereo::Instanced];
    let ways = modes.map(|stereo| Ways { stereo, rotation: Rotation::Identity });
    let turned = Ways { stereo: Stereo::Off, rotation: Rotation::Rotate90 };
    for ways in ways.into_iter().chain([turned]).filter(|ways| ways.stereo.lacks(&device.profile()).is_none()) {
        let mut shaders = library();
        let mut pictures = |largest: &str| -> Result<Vec<Texels>, Box<dyn Error>> {
            let mut planned = |scale| {
                let set = &[("scale", scale), ("largest", largest)];
                let setup = Setup { pipeline: "tests/pipelines/dynamic_taa.ron", set, scene: &yard, extent: EXTENT };
                plan_for(device, &setup, ways, &mut shaders, &poisoned())
            };
            let plans = [planned("0.6")?, planned("0.3")?];
            let mut draws = SceneDrawSource::for_eyes(device, &yard, EXTENT, &plans[0], &Eyes::default())?;
            let mut executor = Executor::new(device, &plans[0], &mut shaders, &poisons(2))?;
            let mut shown = Vec::new();
            for plan in [&plans[0], &plans[0], &plans[1], &plans[0]] {
                executor.change(plan)?;
                executor.frame(&mut draws)?;
                for output in 0..plan.outputs.len() {
                    shown.push(executor.read(output)?);
                }
            }
            Ok(shown)
        };
        let [one, other] = [pictures("0.6")?, pictures("1")?];
        for (at, (one, other)) in one.iter().zip(&other).enumerate() {
            assert!(one == other, "{ways:?}: picture {at}, {:?} and {:?}", one.extent, other.extent);
        }
    }
    silent(device)
}

/// The greatest difference of two pictures.
fn apart(one: &Texels, other: &Texels) -> f64 {
    let (one, other) = (rgba(one), rgba(other));
    assert_eq!(one.len(), other.len());
    let steps = one.iter().flatten().zip(other.iter().flatten()).map(|(one, other)| (one - other).abs());
    steps.fold(0.0, |most, step| if step.is_nan() { f64::INFINITY } else { f64::max(most, step) })
}

/// Where the texels of a level are as many. A linear filter may round its weights in another way at other places of an image.
#[test]
fn mip_levels_and_layers_show_what_an_image_of_their_size_would_do_10() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    let shown = |scale: &str, largest: &str, poison: bool| -> Result<[Texels; 2], Box<dyn Error>> {
        let set = [("scale", scale), ("largest", largest)];
        let setup = Setup { pipeline: "tests/pipelines/dynamic_levels.ron", set: &set, scene: &scene, extent: EXTENT };
        let (_, mut executor) = draw(device, &setup, &Options { poison, ..Options::default() }, 1)?;
        Ok([executor.read(0)?, executor.read(1)?])
    };
    for scale in ["0.5", "0.36", "0.71", "0.9", "1"] {
        let (part, whole) = (shown(scale, "1", true)?, shown(scale, scale, true)?);
        assert_eq!(apart(&part[0], &whole[0]), 0.0, "{scale}");
        assert!(apart(&part[1], &whole[1]) <= 0.5, "{scale}: {}", apart(&part[1], &whole[1]));
    }
    // Down to the least parts, nothing of what lies beyond is seen.
    for scale in ["0.25", "0.1", "0.05", "0.02"] {
        let [clean, spoilt] = [shown(scale, "1", false)?, shown(scale, "1", true)?];
        assert!(clean == spoilt, "{scale}");
        assert!(spoilt.iter().all(|it| rgba(it).iter().flatten().all(|number| number.is_finite())), "{scale}");
    }
    silent(device)
}

#[test]
fn mip_levels_follow_the_size_and_nothing_is_made_anew_do_10() -> Result<(), Box<dyn Error>> {
    let Some(device) = own_device() else { return Ok(()) };
    let (scene, mut shaders) = (empty_scene(), library());
    let plans = plans(&device, "tests/pipelines/dynamic_levels.ron", &scene, &mut shaders)?;
    let mut draws = SceneDrawSource::for_plan(&device, &scene, EXTENT, &plans[0])?;
    let mut executor = Executor::new(&device, &plans[0], &mut shaders, &poisons(2))?;
    executor.frame(&mut draws)?;
    executor.submit(&mut draws)?;
    let before = device.memory_in_use();
    for (plan, scale) in plans.iter().zip(SCALES) {
        executor.change(plan)?;
        executor.submit(&mut draws)?;
        executor.submit(&mut draws)?;
        assert_eq!(device.memory_in_use(), before, "{scale}");
        let mut anew = Executor::new(&device, plan, &mut shaders, &poisons(1))?;
        anew.frame(&mut draws)?;
        assert!([executor.read(0)?, executor.read(1)?] == [anew.read(0)?, anew.read(1)?], "{scale}");
    }
    silent(&device)
}

#[test]
fn storage_images_are_covered_and_read_as_far_as_they_are_used_do_10() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let (scene, mut shaders) = (empty_scene(), library());
    let plans = plans(device, "tests/pipelines/dynamic_storage.ron", &scene, &mut shaders)?;
    let mut draws = SceneDrawSource::for_plan(device, &scene, EXTENT, &plans[0])?;
    let how = ExecutorOptions { readback: true, ..poisons(2) };
    let mut executor = Executor::new(device, &plans[0], &mut shaders, &how)?;
    for (plan, scale) in plans.iter().zip(SCALES) {
        executor.change(plan)?;
        let frame = executor.frame(&mut draws)?;
        let [width, height] = part(scale);
        let sum = |[x, y]: [u32; 2]| -> u32 {
            let near = |at: u32, side: u32| [at.saturating_sub(1), at, (at + 1).min(side - 1)];
            near(y, height).into_iter().flat_map(|y| near(x, width).map(move |x| 1000 * y + x)).sum()
        };
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let expected = ([width, height], texels.map(sum).collect());
        assert!(numbers(&executor.read(0)?) == expected, "{scale}");
        assert!(numbers(&executor.read_back_image(frame, 0)?) == expected, "{scale}: what a frame left");
    }
    silent(device)
}

/// Sums may be contracted in another way.
#[test]
fn hlsl_is_told_of_parts_as_glsl_is_do_10() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let (scene, mut shaders) = (empty_scene(), library());
    let plans = plans(device, "tests/pipelines/dynamic_hlsl.ron", &scene, &mut shaders)?;
    let mut draws = SceneDrawSource::for_plan(device, &scene, EXTENT, &plans[0])?;
    let mut executor = Executor::new(device, &plans[0], &mut shaders, &poisons(2))?;
    let mut before = EXTENT.map(|side| side / 2);
    for (plan, scale) in plans.iter().zip(SCALES) {
        executor.change(plan)?;
        executor.submit(&mut draws)?;
        let sizes = [0, 1].map(|axis| f64::from(part(scale)[axis] + 100 * before[axis]));
        // By what `include/part.hlsl` has, and by the calls of `include/texture.hlsl`.
        for [glsl, hlsl] in [[0, 1], [2, 3]] {
            let [glsl, hlsl] = [executor.read(glsl)?, executor.read(hlsl)?];
            assert!(apart(&glsl, &hlsl) <= 1e-4, "{scale}: {}", apart(&glsl, &hlsl));
            assert_eq!(rgba(&hlsl)[0][2..], sizes, "{scale}");
        }
        before = part(scale);
    }
    silent(device)
}
