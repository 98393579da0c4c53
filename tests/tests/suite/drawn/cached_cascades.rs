//! Far cascades of the sun's shadow that are drawn every few frames (DO-9): of a scene that stands still no frame shows it, and a change is
//! seen when their turn comes.

use framewright_graph::compile::Options;
use framewright_graph::frame::{Cadence, Stereo};
use framewright_graph::plan::Plan;
use framewright_passes::draw::{Eyes, SceneDrawSource};
use framewright_passes::scene::{Camera, Scene, Sun};
use framewright_tests::render::{Setup, Ways, device, library, plan_for, silent};
use framewright_tests::shapes::{material, scene, square};
use framewright_vulkan::{Device, Executor, ExecutorOptions};
use glam::{DVec3, Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [96, 64];

/// A floor, a board near the camera, and one far away that stands here.
fn yard(far: f32) -> Scene {
    let mut board = material([0.8, 0.5, 0.3, 1.0]);
    board.double_sided = true;
    let flat = Mat4::from_rotation_x(-std::f32::consts::FRAC_PI_2) * Mat4::from_scale(Vec3::splat(12.0));
    let near = Mat4::from_translation(Vec3::new(0.6, 0.8, 4.0)) * Mat4::from_scale(Vec3::splat(0.4));
    let away = Mat4::from_translation(Vec3::new(far, 1.2, -4.0));
    let mut yard = scene(
        vec![square()],
        vec![material([0.7, 0.7, 0.7, 1.0]), board],
        vec![(0, 0, flat), (0, 1, near), (0, 1, away)],
    );
    yard.camera = Camera::look_at(DVec3::new(0.0, 3.0, 7.0), DVec3::new(0.0, 0.4, -2.0), DVec3::Y, 0.8, 0.05)
        .expect("a direction");
    yard.ambient = [0.1, 0.15, 0.2];
    yard.sun =
        Sun { direction: Vec3::new(0.45, -1.0, -0.6).normalize().to_array(), color: [3.0, 2.5, 2.0], shadows: true };
    yard
}

/// The Plan, and an executor of it, whose far cascades are drawn every so many frames.
fn ready(device: &Device, every: &str, stereo: Stereo, poison: bool) -> Result<(Plan, Executor), Box<dyn Error>> {
    let (mut shaders, scene, set) = (library(), yard(0.0), [("every", every)]);
    let setup = Setup { pipeline: "tests/pipelines/cached_cascades.ron", set: &set, scene: &scene, extent: EXTENT };
    let ways = Ways { stereo, ..Ways::default() };
    let plan = plan_for(device, &setup, ways, &mut shaders, &Options { poison, ..Options::default() })?;
    let options = ExecutorOptions { poison, ..ExecutorOptions::default() };
    let executor = Executor::new(device, &plan, &mut shaders, &options)?;
    Ok((plan, executor))
}

fn draws(device: &Device, scene: &Scene, plan: &Plan) -> Result<SceneDrawSource, Box<dyn Error>> {
    Ok(SceneDrawSource::for_eyes(device, scene, EXTENT, plan, &Eyes::apart(0.1))?)
}

/// All that a frame leaves.
fn picture(executor: &mut Executor, draws: &mut SceneDrawSource) -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    executor.frame(draws)?;
    let outputs = 0..executor.plan().outputs.len();
    Ok(outputs.map(|output| Ok(executor.read(output)?.bytes)).collect::<Result<_, framewright_vulkan::Error>>()?)
}

#[test]
fn do_9_far_cascades_that_are_drawn_now_and_then_show_the_same_and_a_change_in_their_turn() -> Result<(), Box<dyn Error>>
{
    let Some(device) = device() else { return Ok(()) };
    for (stereo, poison) in [(Stereo::Off, false), (Stereo::Off, true), (Stereo::MultiPass, false)] {
        let (plan, mut always) = ready(device, "1", stereo, poison)?;
        assert!(plan.steps.iter().all(|step| step.run == Cadence::Always));
        let (before, after) = (yard(-1.0), yard(1.5));
        let expected = picture(&mut always, &mut draws(device, &before, &plan)?)?;
        let changed = picture(&mut always, &mut draws(device, &after, &plan)?)?;
        assert!(expected != changed, "the change is seen");
        let (plan, mut cached) = ready(device, "4", stereo, poison)?;
        let rare = plan.steps.iter().filter(|step| step.run != Cadence::Always).count();
        assert_eq!(rare, 3, "both eyes share the sun's shadow: {}", plan.tree());
        let mut still = draws(device, &before, &plan)?;
        for frame in 0..6 {
            assert!(picture(&mut cached, &mut still)? == expected, "frame {frame} of a scene that stands still");
        }
        // From frame 6 on another scene is drawn. Cascade i runs where the number leaves i: 2 in frame 6, 3 in 7, 1 in 9.
        let mut moved = draws(device, &after, &plan)?;
        let shown: Vec<bool> =
            (6..14).map(|_| Ok(picture(&mut cached, &mut moved)? == changed)).collect::<Result<_, Box<dyn Error>>>()?;
        let first = shown.iter().position(|same| *same);
        assert!(first.is_some_and(|first| (1..=3).contains(&first)), "{stereo:?}: {shown:?}");
        assert!(shown[3..].iter().all(|same| *same), "{stereo:?}: {shown:?}");
        // Asked for, all are drawn at once.
        cached.run_all();
        assert!(picture(&mut cached, &mut still)? == expected);
    }
    silent(device)
}
