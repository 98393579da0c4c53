//! `cargo bench --package framewright-passes`: what it takes the processor to record a frame for two eyes, in each way that the
//! device can draw it, as shares of what one eye after the other takes in the same run.
//!
//! A scene of a number of cubes is drawn through `forward`. Where nothing moves a frame is only recorded; where the camera
//! does, all that depends on it is prepared again in every frame. Ways take turns from frame to frame, and the least time of
//! each counts: other work on the machine only adds. `-- --short` draws every frame twice, to see that it runs.

use framewright_graph::base::{Root, Sources};
use framewright_graph::frame::Stereo;
use framewright_graph::vulkan::Rotation;
use framewright_graph::{compile, expand, language};
use framewright_passes::draw::{self, SceneDrawSource};
use framewright_passes::scene::{Scene, text};
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::{Device, DeviceOptions, Executor, ExecutorOptions, ShaderLibrary};
use std::sync::Arc;

const EXTENT: [u32; 2] = [32, 32];

/// A way of drawing for two eyes, and whether eyes that are drawn for one after the other are given the same objects.
#[derive(Clone, Copy)]
struct Way {
    name: &'static str,
    stereo: Stereo,
    shared_culling: bool,
}

const WAYS: [Way; 5] = [
    Way { name: "multi-pass", stereo: Stereo::MultiPass, shared_culling: false },
    Way { name: "multi-pass, shared culling", stereo: Stereo::MultiPass, shared_culling: true },
    Way { name: "double-wide", stereo: Stereo::DoubleWide, shared_culling: false },
    Way { name: "instanced", stereo: Stereo::Instanced, shared_culling: false },
    Way { name: "multiview", stereo: Stereo::Multiview, shared_culling: false },
];

fn main() {
    let short = std::env::args().any(|argument| argument == "--short");
    let device = Device::open(&DeviceOptions::default()).expect("a device");
    let profile = device.profile();
    println!("{}, {}", profile.name, profile.source);
    println!("| objects | camera | way | recording, ms | share of multi-pass |");
    println!("|---|---|---|---|---|");
    for objects in [100, 1_000, 10_000] {
        for moving in [false, true] {
            let scene = scene(objects, moving);
            let mut ways: Vec<(Way, Drawn)> = WAYS
                .into_iter()
                .filter(|way| way.stereo.lacks(&profile).is_none())
                .map(|way| (way, Drawn::new(&device, &scene, way)))
                .collect();
            let frames = if short { 2 } else { 40_000 / objects.max(500) };
            let mut least = vec![f64::INFINITY; ways.len()];
            // The first frame is prepared before it is recorded.
            for number in 0..=frames {
                for ((_, drawn), least) in ways.iter_mut().zip(&mut least) {
                    let frame = drawn.executor.frame(&mut drawn.source).expect("a frame");
                    if number > 0 {
                        let report = drawn.executor.report(frame).expect("its report");
                        *least = least.min(report.recording_milliseconds);
                    }
                }
            }
            let camera = if moving { "moves" } else { "rests" };
            for ((way, _), time) in ways.iter().zip(&least) {
                println!("| {objects} | {camera} | {} | {time:.3} | {:.2} |", way.name, time / least[0]);
            }
        }
    }
}

struct Drawn {
    executor: Executor,
    source: SceneDrawSource,
}

impl Drawn {
    fn new(device: &Device, scene: &Scene, way: Way) -> Drawn {
        let (name, pipeline) = ("forward.ron", include_str!("../../examples/pipelines/forward.ron"));
        let mut sources = Sources::default();
        let document = language::read(&mut sources, name, name, pipeline.to_owned()).expect("a pipeline");
        let mut shaders = ShaderLibrary::new(Vec::<Root>::new(), SHADERS, draw::interfaces());
        let profile = device.profile();
        let inputs = expand::Inputs {
            set: &[("msaa".to_owned(), "1".to_owned())],
            facts: scene.facts(),
            facts_known: true,
            output_extent: EXTENT,
            rotation: Rotation::Identity,
            dump: &[],
            device: Some(&profile),
            window: None,
            stereo: way.stereo,
        };
        let frame = expand::expand(&document, Arc::new(sources), &inputs, &mut shaders).expect("a frame");
        let options = compile::Options::default();
        let plan = compile::compile(&frame, &profile, &mut device.memory(), &options).expect("a Plan");
        let executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default()).expect("an executor");
        let mut source = SceneDrawSource::for_plan(device, scene, EXTENT, &plan).expect("a draw source");
        source.set_shared_culling(way.shared_culling);
        Drawn { executor, source }
    }
}

/// A number of cubes in a square before the camera, of four materials in turn.
fn scene(objects: usize, moving: bool) -> Scene {
    let side = objects.isqrt().max(1);
    let velocity = if moving { ", velocity: (0.01, 0, 0)" } else { "" };
    let text = format!(
        "Scene(version: 1, camera: (position: (0, 30, 60), target: (0, 0, 0), fov: 60{velocity}),
            sun: (direction: (1, -2, -1), intensity: 1), ambient: (0.2, 0.2, 0.2),
            sky: (zenith: \"#3060a0\", horizon: \"#c0d0e0\", ground: \"#404040\"),
            materials: [(name: \"a\", color: \"#c04030\"), (name: \"b\", color: \"#3050b0\"),
                (name: \"c\", color: \"#f0f0f0\", texture: Checker(count: (2, 2), colors: (\"#ffffff\", \"#606060\"))),
                (name: \"d\", color: \"#40a050\")],
            objects: [Cube(name: \"cubes\", material: [\"a\", \"b\", \"c\", \"d\"], position: (-20, 0, -20), size: 0.2,
                repeat: Grid(count: ({side}, 1, {}), step: (0.4, 0, 0.4)))])",
        objects / side
    );
    text::read(&mut Sources::default(), "cubes", "cubes", text).expect("a scene")
}
