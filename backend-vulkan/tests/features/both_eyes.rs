//! What a program records for both eyes at once (DO-12): transfers, and pipelines of its own within a rendering scope and outside of one.
//! In each way to draw for two eyes the pictures are those of one eye after the other, and what is known of them beforehand.

mod engine;
mod watched;

use crate::frames::on_each_driver;
use engine::{EXTENT, Engine};
use framewright_graph::compile::Options;
use framewright_graph::frame::{Eye, EyeForm, Stereo};
use framewright_graph::plan::{Plan, Resource};
use framewright_graph::vulkan::Rotation;
use framewright_tests::render::{Setup, Ways, library, plan_for};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::{Device, Executor, ExecutorOptions};

/// What each eye sees: its square, in its colour, with the blue that tells the eye if there is any, and channels exchanged.
fn expected(has_blue: bool) -> [Vec<[u8; 4]>; 2] {
    [0, 1].map(|eye| {
        let texel = |at: u32| {
            let (x, y) = (at % EXTENT[0], at / EXTENT[0]);
            let inside = (1 + eye..3 + eye).contains(&x) && (1..3).contains(&y);
            let blue = if has_blue { 51 * (1 + eye as u8) } else { 0 };
            let [red, green] = if inside { [[255, 0], [0, 255]][eye as usize] } else { [0, 0] };
            if eye == 0 { [blue, green, red, 255] } else { [blue, red, green, 255] }
        };
        (0..EXTENT[0] * EXTENT[1]).map(texel).collect()
    })
}

/// Both eyes' parts of an output. Each eye's own are outputs that follow each other.
fn pictures(plan: &Plan, executor: &mut Executor, at: usize) -> [Vec<[u8; 4]>; 2] {
    let read = |executor: &mut Executor, at| executor.read(at).expect("a picture").bytes.as_chunks().0.to_vec();
    let first = read(executor, at);
    let Resource::Image(image) = plan.outputs[at].resource else { panic!("an image") };
    let run = match plan.image(image).eyes {
        None => return [first, read(executor, at + 1)],
        Some(EyeForm::Layers) => first.len() / 2,
        Some(EyeForm::Halves) => EXTENT[0] as usize,
    };
    [0, 1].map(|eye| first.chunks(run).skip(eye).step_by(2).flatten().copied().collect())
}

/// Each way to draw for two eyes that the device has.
fn ways(device: &Device) -> Vec<Stereo> {
    let all = [Stereo::MultiPass, Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];
    let ways: Vec<Stereo> = all.into_iter().filter(|stereo| stereo.lacks(&device.profile()).is_none()).collect();
    assert!(ways.len() >= 2, "{:?}", device.profile());
    ways
}

/// Draws two frames in each way to draw for two eyes, and holds what is recorded, and the pictures, against what is known of them.
fn draw(device: &Device, made: impl Fn(&Device) -> Engine<'_>) {
    let scene = empty_scene();
    let setup =
        Setup { pipeline: "tests/pipelines/recorded_for_both_eyes.ron", set: &[], scene: &scene, extent: EXTENT };
    for stereo in ways(device) {
        let ways = Ways { stereo, rotation: Rotation::Identity };
        let mut shaders = library();
        let plan = plan_for(device, &setup, ways, &mut shaders, &Options::default());
        let plan = plan.unwrap_or_else(|error| panic!("{stereo:?}: {error}"));
        let mut executor =
            Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
        let mut engine = made(device);
        let at_once = stereo != Stereo::MultiPass;
        let passes: &[&str] = if at_once { &["draw"] } else { &["draw (left)", "draw (right)"] };
        for pass in passes {
            assert_eq!(executor.both_eyes(pass).map(|it| it.0), at_once.then_some(stereo));
            engine.prepare(&executor, pass);
        }
        assert_eq!(executor.both_eyes("store"), executor.both_eyes("draw"), "{}", plan.tree());
        let names = ["clear", "draw", "noted_eye", "store", "keep"];
        let eyes: &[Option<Eye>] = if at_once { &[None] } else { &[Some(Eye::Left), Some(Eye::Right)] };
        for _ in 0..2 {
            engine.recorded.clear();
            executor.frame(&mut engine).expect("a frame");
            for name in names {
                let by = engine.recorded.iter().filter(|(of, _)| of == name).map(|it| it.1);
                assert_eq!(by.collect::<Vec<_>>(), eyes, "{stereo:?}: {name}");
            }
            assert_eq!(pictures(&plan, &mut executor, 0), expected(true), "{stereo:?}\n{}", plan.tree());
        }
    }
}

#[test]
fn do_12_a_program_records_both_eyes_at_once_and_shows_what_it_shows_one_after_the_other() {
    on_each_driver(|device| draw(device, Engine::new));
}

/// DO-8, DO-12: also where its draws come in secondary command buffers, which inherit the views that the scope is drawn for.
#[test]
fn do_12_secondary_command_buffers_draw_for_both_eyes_at_once() {
    on_each_driver(|device| draw(device, |device| Engine::new(device).by_secondary()));
}
