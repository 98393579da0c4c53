//! Temporal anti-aliasing is held against pictures of many samples: it converges where nothing moves, and leaves no ghosts where
//! something does.

use framewright_graph::compile::Options;
use framewright_passes::scene::{Movement, Scene, load};
use framewright_passes::twin::weighted_resolve::{compressed, weighted_mean};
use framewright_tests::render::{Setup, device, in_repository, ready, rgb, silent};
use framewright_tests::shapes::{material, scene, sphere, square};
use framewright_vulkan::{Device, ExecutorOptions};
use glam::{DVec3, Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [96, 64];
/// How many shifted frames make a reference.
const SAMPLES: u32 = 128;

type Picture = Vec<[f64; 3]>;

/// A frame: what was drawn, and what became of it.
struct Frame {
    drawn: Picture,
    steady: Picture,
}

/// A number of frames, of which the last `kept` are kept.
fn frames(
    device: &Device,
    scene: &Scene,
    set: &[(&str, &str)],
    count: u32,
    kept: u32,
) -> Result<Vec<Frame>, Box<dyn Error>> {
    let setup = Setup { pipeline: "tests/pipelines/taa.ron", set, scene, extent: EXTENT };
    let (_, mut executor, mut source) = ready(device, &setup, &Options::default(), &ExecutorOptions::default())?;
    let mut frames = Vec::new();
    for number in 0..count {
        executor.frame(&mut source)?;
        if number + kept >= count {
            let [drawn, steady] = [executor.read(0)?, executor.read(1)?].map(|texels| rgb(&texels));
            frames.push(Frame { drawn, steady });
        }
    }
    silent(device)?;
    Ok(frames)
}

/// The mean of many shifted pictures of a scene in which nothing moves, in which bright samples weigh less.
fn reference(device: &Device, still: &Scene) -> Result<Picture, Box<dyn Error>> {
    let frames = frames(device, still, &[("jitter", &SAMPLES.to_string())], SAMPLES, SAMPLES)?;
    let mean = |at: usize| weighted_mean(&frames.iter().map(|frame| frame.drawn[at]).collect::<Vec<_>>());
    Ok((0..frames[0].drawn.len()).map(mean).collect())
}

/// How far apart pixels are, as they are shown, from the least to the greatest distance.
fn apart(one: &Picture, other: &Picture) -> Vec<f64> {
    let difference = |(one, other): (&[f64; 3], &[f64; 3])| {
        let (one, other) = (compressed(*one), compressed(*other));
        (0..3).map(|channel| (one[channel] - other[channel]).abs()).fold(0.0, f64::max)
    };
    let mut all: Vec<f64> = one.iter().zip(other).map(difference).collect();
    all.sort_by(f64::total_cmp);
    all
}

fn root_mean_square(all: &[f64]) -> f64 {
    (all.iter().map(|one| one * one).sum::<f64>() / all.len() as f64).sqrt()
}

/// The scene at a frame, at rest.
fn at_rest(scene: &Scene, frame: u64) -> Scene {
    let mut still = scene.at(frame);
    still.camera.movement = Movement::default();
    still.objects.iter_mut().for_each(|object| object.movement = Movement::default());
    still
}

/// A shipped scene of thin bars, textures with holes, a lamp and glass, seen from a camera that passes by.
fn passing() -> Result<Scene, Box<dyn Error>> {
    Ok(load(&in_repository("examples/scenes/passing.ron"))?)
}

/// A bright ball and dark bars before a wall of stripes: edges everywhere.
fn bars() -> Scene {
    let mut bright = material([0.9, 0.8, 0.2, 1.0]);
    bright.emissive = [6.0, 5.0, 3.0];
    let materials = vec![material([0.9, 0.9, 0.9, 1.0]), bright, material([0.05, 0.1, 0.2, 1.0])];
    let bar = |x: f32, turn: f32| {
        Mat4::from_translation(Vec3::new(x, 0.0, 1.0))
            * Mat4::from_rotation_z(turn)
            * Mat4::from_scale(Vec3::new(0.12, 1.6, 1.0))
    };
    let mut objects =
        vec![(0, 0, Mat4::from_translation(Vec3::new(0.0, 0.0, -2.0)) * Mat4::from_scale(Vec3::splat(2.5)))];
    objects.push((1, 1, Mat4::from_translation(Vec3::new(0.6, 0.4, 0.0)) * Mat4::from_scale(Vec3::splat(0.6))));
    objects.extend((0..5).map(|number| (0, 2, bar(0.8 * number as f32 - 1.7, 0.1 + 0.05 * number as f32))));
    let mut scene = scene(vec![square(), sphere(24)], materials, objects);
    scene.ambient = [0.4, 0.45, 0.5];
    scene.sun.color = [0.8; 3];
    scene.sun.direction = [0.3, -0.6, -0.74];
    scene
}

#[test]
fn a_still_scene_converges_to_a_picture_of_many_samples() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let bars = bars();
    let reference = reference(device, &bars)?;
    let plain = frames(device, &bars, &[("jitter", "1"), ("share", "1.0")], 1, 1)?;
    let one = root_mean_square(&apart(&plain[0].drawn, &reference));
    let settled = frames(device, &bars, &[], 40, 8)?;
    for (number, frame) in settled.iter().enumerate() {
        let found = root_mean_square(&apart(&frame.steady, &reference));
        assert!(found < 0.4 * one, "frame {}: {found} beside {one} without", 32 + number);
    }
    Ok(())
}

/// Bars that are narrower than a texel are missed by some frames, and by all texels around: what other frames saw of them stays.
#[test]
fn bars_narrower_than_a_texel_stay_whole() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let still = at_rest(&passing()?, 0);
    let reference = reference(device, &still)?;
    let plain = frames(device, &still, &[("jitter", "1"), ("share", "1.0")], 1, 1)?;
    let one = root_mean_square(&apart(&plain[0].drawn, &reference));
    for (number, frame) in frames(device, &still, &[], 32, 8)?.iter().enumerate() {
        let found = root_mean_square(&apart(&frame.steady, &reference));
        assert!(found < 0.45 * one, "frame {}: {found} beside {one} without", 24 + number);
    }
    Ok(())
}

#[test]
fn a_camera_that_passes_by_sees_smoother_edges() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let passing = passing()?;
    let number = 23;
    let reference = reference(device, &at_rest(&passing, number.into()))?;
    let plain = frames(device, &passing, &[("jitter", "1"), ("share", "1.0")], number + 1, 1)?;
    let steady = frames(device, &passing, &[], number + 1, 1)?;
    let one = root_mean_square(&apart(&plain[0].drawn, &reference));
    let found = root_mean_square(&apart(&steady[0].steady, &reference));
    assert!(found < 0.92 * one, "{found} beside {one} without");
    Ok(())
}

#[test]
fn the_first_frame_shows_no_history() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let first = frames(device, &bars(), &[], 1, 1)?;
    let worst = apart(&first[0].drawn, &first[0].steady).pop().unwrap_or(0.0);
    // Half a bit of a half float.
    assert!(worst < 1.0 / 2048.0, "{worst}");
    Ok(())
}

#[test]
fn a_camera_that_moves_leaves_no_ghosts() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut moving = bars();
    // Some one and a half pixels a frame, and a little of everything else.
    moving.camera.movement = Movement { velocity: DVec3::new(6.0, 0.6, -1.0), spin: DVec3::new(0.0, 0.1, 0.05) };
    moving.objects[1].movement = Movement { velocity: DVec3::new(-5.0, 2.0, 0.0), spin: DVec3::ZERO };
    let number = 11;
    let reference = reference(device, &at_rest(&moving, number.into()))?;
    let last = |set: &[(&str, &str)]| -> Result<Vec<f64>, Box<dyn Error>> {
        let frames = frames(device, &moving, set, number + 1, 1)?;
        Ok(apart(&frames[0].steady, &reference))
    };
    let plain = last(&[("jitter", "1"), ("share", "1.0")])?;
    let steady = last(&[])?;
    let (one, found) = (root_mean_square(&plain), root_mean_square(&steady));
    assert!(found < one, "the mixture is nearer to the reference: {found} beside {one}");
    let far = steady.iter().filter(|one| **one > 0.25).count();
    assert!(
        far * 100 < steady.len(),
        "{far} of {} pixels are a quarter of the way from black to white off",
        steady.len()
    );
    // Motion and the hold on history have a purpose: without them it is another picture.
    for deviations in ["0.75", "10.0"] {
        let ghosts = root_mean_square(&last(&[("reproject", "false"), ("deviations", deviations)])?);
        assert!(ghosts > 1.6 * found, "{deviations}: {ghosts} beside {found}");
    }
    Ok(())
}
