//! A pipeline is checked against a file of an engine's interfaces as the engine's own executor checks it: both take it, or
//! both refuse it.

use crate::testing;
use framewright_graph::base::{self, Root, Sources};
use framewright_graph::compile::{self, Options};
use framewright_graph::expand::{self, Inputs};
use framewright_graph::frame::{Draw, Stereo};
use framewright_graph::language::{self, Facts};
use framewright_graph::plan::Plan;
use framewright_graph::shader::DrawInterfaces;
use framewright_graph::vulkan::{FillValue, Rotation};
use framewright_tests::render::in_repository;
use framewright_vulkan::{
    BindGroup, Buffer, BufferUsage, CustomRecorder, Device, DispatchRecorder, DrawSource, Error, Executor,
    ExecutorOptions, Recorder, Resource, ShaderLibrary,
};
use std::sync::Arc;

#[path = "../../../examples/custom_pass/interface.rs"]
mod engine;

const EXTENT: [u32; 2] = [16, 8];

/// The engine's shaders, with draws that bring this along.
fn shaders(interfaces: DrawInterfaces) -> ShaderLibrary {
    ShaderLibrary::new(vec![Root::new(in_repository("examples/custom_pass"))], &[], interfaces)
}

/// The Plan of the engine's pipeline, checked against these interfaces.
fn planned(device: &Device, interfaces: DrawInterfaces) -> Result<Plan, String> {
    let mut sources = Sources::default();
    let text = std::fs::read_to_string(in_repository("examples/custom_pass/engine.ron")).expect("a text");
    let read = language::read(&mut sources, "engine.ron", "engine.ron", text);
    let pipeline = read.map_err(|mistakes| base::render(&sources, &mistakes))?;
    let sources = Arc::new(sources);
    let profile = device.profile();
    let inputs = Inputs {
        set: &[],
        facts: Facts::UNKNOWN,
        facts_known: false,
        output_extent: EXTENT,
        rotation: Rotation::Identity,
        dump: &[],
        device: Some(&profile),
        stereo: Stereo::Off,
        window: None,
    };
    expand::expand(&pipeline, sources.clone(), &inputs, &mut shaders(interfaces))
        .and_then(|frame| compile::compile(&frame, &profile, &mut device.memory(), &Options::default()))
        .map_err(|mistakes| base::render(&sources, &mistakes))
}

/// The interfaces out of the file that the engine writes, with one piece of its text replaced.
fn out_of_file(old: &str, new: &str) -> Option<DrawInterfaces> {
    let text = engine::interfaces().to_ron();
    assert!(text.contains(old), "the file doesn't hold {old}");
    DrawInterfaces::read(&mut Sources::default(), "interface.ron", "interface.ron", text.replacen(old, new, 1)).ok()
}

/// The engine.
struct Engine {
    vertices: Buffer,
    camera: BindGroup,
    only_camera: BindGroup,
    materials: BindGroup,
    gust: Gust,
    /// The frames in which the compute pass was dispatched.
    frames: Vec<u64>,
}

/// What the engine binds for its compute pass.
enum Gust {
    Bound,
    Unbound,
    OfObjects,
}

impl Engine {
    fn new(device: &Device) -> Result<Engine, Error> {
        let words = |values: &[f32]| values.iter().flat_map(|value| value.to_ne_bytes()).collect::<Vec<u8>>();
        let corner = |x, y| [x, y, 1.0, 0.5, 0.0];
        let vertices = [corner(-1.0, -1.0), corner(3.0, -1.0), corner(-1.0, 3.0)].concat();
        let camera = device.buffer(BufferUsage::Uniform, &words(&[0.0; 4]))?;
        let materials = device.buffer(BufferUsage::Storage, &words(&[1.0, 0.0, 1.0, 1.0]))?;
        let interfaces = engine::interfaces();
        let objects = interfaces.of(Draw::Objects(framewright_graph::frame::DrawList::Opaque));
        Ok(Engine {
            vertices: device.buffer(BufferUsage::Vertex, &words(&vertices))?,
            camera: device.bind_group(&objects, 1, &[(0, Resource::Buffer(&camera))])?,
            only_camera: device.bind_group(&interfaces.of(Draw::Custom), 1, &[(0, Resource::Buffer(&camera))])?,
            materials: device.bind_group(&objects, 2, &[(0, Resource::Buffer(&materials))])?,
            gust: Gust::Bound,
            frames: Vec::new(),
        })
    }
}

impl DrawSource for Engine {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        if draw == Draw::Custom {
            assert_eq!(recorder.shader(), "grass");
            recorder.bind_group(1, &self.only_camera);
        } else {
            recorder.bind_group(1, &self.camera);
            recorder.bind_group(2, &self.materials);
            recorder.bind_vertex_buffer(&self.vertices);
        }
        recorder.draw(0..3, 0..1);
        Ok(1)
    }

    fn dispatch(&mut self, recorder: &mut DispatchRecorder<'_>) -> Result<(), Error> {
        assert_eq!((recorder.pass(), recorder.shader(), recorder.view()), ("gust", "gust", None));
        self.frames.push(recorder.frame());
        match self.gust {
            Gust::Bound => recorder.bind_group(1, &self.only_camera),
            Gust::Unbound => {}
            Gust::OfObjects => recorder.bind_group(2, &self.materials),
        }
        Ok(())
    }

    fn custom(&mut self, callback: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        assert_eq!(callback, "upload");
        recorder.fill("wind", FillValue::Bits([0; 4]));
        Ok(())
    }
}

#[test]
fn the_file_of_the_example_is_the_one_that_the_engine_writes() {
    let file = std::fs::read_to_string(in_repository("examples/custom_pass/interface.ron")).expect("a text");
    assert_eq!(file, engine::interfaces().to_ron());
}

#[test]
fn what_is_checked_against_the_file_is_drawn_by_the_engine_in_silence() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let plan = planned(&device, out_of_file("", "").expect("right")).unwrap_or_else(|wrong| panic!("{wrong}"));
    let mut executor =
        Executor::new(&device, &plan, &mut shaders(engine::interfaces()), &ExecutorOptions::default()).expect("fits");
    let mut engine = Engine::new(&device).expect("its resources");
    for _ in 0..2 {
        executor.frame(&mut engine).expect("a frame");
    }
    let texels = executor.read(0).expect("texels").bytes.as_chunks::<4>().0.to_vec();
    // The tint times the material, half of which is 0; the grass stands in the upper left corner.
    assert_eq!(texels[0], [0, 255, 0, 255]);
    assert_eq!(texels[EXTENT[0] as usize - 1], [255, 0, 0, 255]);
    assert_eq!(engine.frames, [0, 1]);
    drop((executor, engine, device));
    assert_eq!(testing::findings(&messages), []);
}

#[test]
fn what_a_compute_pass_reads_of_the_engine_must_be_bound() {
    let Some(device) = testing::device() else { return };
    let plan = planned(device, engine::interfaces()).unwrap_or_else(|wrong| panic!("{wrong}"));
    let refused = |source: &mut dyn DrawSource| {
        let options = ExecutorOptions::default();
        let mut executor = Executor::new(device, &plan, &mut shaders(engine::interfaces()), &options).expect("fits");
        executor.frame(source).expect_err("a refusal").to_string()
    };
    let engine = |gust| Engine { gust, ..Engine::new(device).expect("its resources") };
    assert_eq!(
        refused(&mut engine(Gust::Unbound)),
        "pass `gust`, while recording: a dispatch without a bind group for set 1"
    );
    assert_eq!(refused(&mut engine(Gust::OfObjects)), "pass `gust`, while recording: the draw interface has no set 2");
    let words = "nobody binds what `gust` reads of the draw source, which the compute pass `gust` asks for";
    assert!(refused(&mut OnlyCustom(engine(Gust::Bound))).contains(words));
}

/// An engine that knows nothing of compute passes.
struct OnlyCustom(Engine);

impl DrawSource for OnlyCustom {
    fn record(&mut self, draw: Draw, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        self.0.record(draw, recorder)
    }

    fn custom(&mut self, callback: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        self.0.custom(callback, recorder)
    }
}

#[test]
fn what_the_executor_refuses_the_check_refuses_and_nothing_else() {
    let Some(device) = testing::device() else { return };
    let plan = planned(device, engine::interfaces()).unwrap_or_else(|wrong| panic!("{wrong}"));
    let mut verdicts = Vec::new();
    for (old, new) in [
        ("", ""),
        ("vertex_stride: 20", "vertex_stride: 64"),
        ("components: 2", "components: 1"),
        ("(name: \"place\"", "(name: \"more\", components: 1, offset: 0), (name: \"place\""),
        ("\"tint\"", "\"tints\""),
        ("                (name: \"place\", components: 2, offset: 0),\n", ""),
        ("\"materials\"", "\"material\""),
        ("set: 2", "set: 3"),
        ("set: 2, binding: 0", "set: 2, binding: 1"),
        ("kind: StorageBlock", "kind: UniformBlock"),
        ("kind: UniformBlock", "kind: SampledImage"),
        ("of: [Objects(Opaque), ", "of: ["),
        ("of: [Custom, Compute]", "of: [Sky, Compute]"),
        ("of: [Custom, Compute]", "of: [Custom]"),
        (
            "of: [Custom, Compute],\n            vertex_stride: 0,\n            attributes: [\n            ],\n            supplied: [\n                (name: \"camera\"",
            "of: [Custom, Compute],\n            supplied: [\n                (name: \"eye\"",
        ),
    ] {
        let interfaces = out_of_file(old, new).unwrap_or_else(|| panic!("{new} is a right file"));
        let checked = planned(device, interfaces.clone());
        let made = Executor::new(device, &plan, &mut shaders(interfaces), &ExecutorOptions::default()).map(drop);
        assert_eq!(checked.is_ok(), made.is_ok(), "{old} → {new}: {:?} and {made:?}", checked.map(drop));
        verdicts.push(made.is_ok());
    }
    let expected = [vec![true; 4], vec![false; 11]].concat();
    assert_eq!(verdicts, expected);
}
