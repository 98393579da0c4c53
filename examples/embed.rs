//! Framewright within a program: a pipeline file becomes a Plan, and the Plan a picture.
//!
//! `cargo run --package framewright --example embed` writes `out/embedded.png`. An engine brings its own
//! `framewright_vulkan::DrawSource` in place of [`SceneDrawSource`]: something that records the draws of its objects when
//! it is asked for them.

use framewright_graph::base::{self, Root, Sources};
use framewright_graph::vulkan::Rotation;
use framewright_graph::{compile, expand, frame, language, verify};
use framewright_passes::draw::{self, SceneDrawSource};
use framewright_passes::{scene, shipped};
use framewright_vulkan::helper::{self, Limits};
use framewright_vulkan::{Device, DeviceOptions, Executor, ExecutorOptions, Helper, ShaderLibrary};
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

const EXTENT: [u32; 2] = [640, 360];

fn main() -> Result<(), Box<dyn Error>> {
    // This program is its own helper: what a shader or a driver does wrong ends a child process, and not this one. Without these
    // two lines, and naming it to the shaders and the device below, all happens here.
    helper::serve();
    let helper = Helper::this_program(Limits::default())?;

    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    let scene = scene::load(&examples.join("scenes/spheres_and_cubes.ron"))?;

    // A file becomes a description, the description with settings and facts a frame.
    let file = examples.join("pipelines/forward.ron");
    let mut sources = Sources::default();
    let text = std::fs::read_to_string(&file)?;
    let pipeline = language::read(&mut sources, &file.to_string_lossy(), "forward.ron", text)
        .map_err(|mistakes| base::render(&sources, &mistakes))?;
    let sources = Arc::new(sources);
    let shaders = ShaderLibrary::new(vec![Root::new("shaders".into())], shipped::SHADERS, draw::interfaces());
    let mut shaders = shaders.with_helper(&helper);
    let inputs = expand::Inputs {
        set: &[("msaa".to_owned(), "4".to_owned())],
        facts: scene.facts(),
        facts_known: true,
        output_extent: EXTENT,
        rotation: Rotation::Identity,
        dump: &[],
        device: None,
        stereo: frame::Stereo::Off,
    };
    let frame = expand::expand(&pipeline, sources.clone(), &inputs, &mut shaders)
        .map_err(|mistakes| base::render(&sources, &mistakes))?;

    // The frame and what a device can do become a Plan, which somebody else than its maker verifies.
    let device = Device::open(&DeviceOptions { helper: Some(helper), ..DeviceOptions::default() })?;
    let plan = compile::compile(&frame, &device.profile(), &mut device.memory(), &compile::Options::default())
        .map_err(|mistakes| base::render(&sources, &mistakes))?;
    assert!(verify::verify(&plan).is_empty());
    println!("{}", plan.tree());

    // The Plan becomes pixels.
    let options = ExecutorOptions { timestamps: true, ..ExecutorOptions::default() };
    let mut executor = Executor::new(&device, &plan, &mut shaders, &options)?;
    let mut objects = SceneDrawSource::new(&device, &scene, EXTENT)?;
    let frame = executor.frame(&mut objects)?;
    let report = executor.report(frame)?;
    let texels = executor.read(0)?;
    std::fs::create_dir_all("out")?;
    image::save_buffer("out/embedded.png", &texels.bytes, EXTENT[0], EXTENT[1], image::ExtendedColorType::Rgba8)?;
    println!("{:.1} ms on the device; out/embedded.png", report.milliseconds);
    Ok(())
}
