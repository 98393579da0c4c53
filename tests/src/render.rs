//! A pipeline file and a scene become pictures: the whole way, on a real driver under the validation layer.

use framewright_graph::base::{self, Diagnostic, Root, Sources};
use framewright_graph::compile::{self, Options};
use framewright_graph::expand::{self, Inputs};
use framewright_graph::frame::Stereo;
use framewright_graph::language::{self, PipelineFiles};
use framewright_graph::plan::Plan;
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw::{SceneDrawSource, interfaces};
use framewright_passes::scene::Scene;
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::{
    Blame, Device, DeviceChoice, DeviceOptions, Executor, ExecutorOptions, Message, ShaderLibrary, Texels,
};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// The device that the tests of one program share: `FRAMEWRIGHT_TEST_DEVICE` or the default. `None`, with a message, where
/// the machine has no driver or no validation layer that is awake; with `CI` set that is a failure.
///
/// # Panics
/// With `CI` set, if there is none.
pub fn device() -> Option<&'static Device> {
    static DEVICE: OnceLock<Option<Device>> = OnceLock::new();
    DEVICE.get_or_init(own_device).as_ref()
}

/// The same device, opened anew: for a test that counts what the device holds.
///
/// # Panics
/// With `CI` set, if there is none.
pub fn own_device() -> Option<Device> {
    let choice = std::env::var("FRAMEWRIGHT_TEST_DEVICE").map_or(DeviceChoice::Default, DeviceChoice::Name);
    let opened = Device::open(&DeviceOptions { choice, validation: true, ..DeviceOptions::default() });
    // The layer's silence proves nothing before it has reported a planted mistake.
    match opened.and_then(|device| device.canary().map(|_| device)) {
        Ok(device) => Some(device),
        Err(error) => {
            let may_be_absent = error.blame() == Blame::Environment && std::env::var_os("CI").is_none();
            assert!(may_be_absent, "{error}");
            eprintln!("skipped: {error}");
            None
        }
    }
}

/// A pipeline with its settings, scene and size.
pub struct Setup<'a> {
    /// The pipeline file, relative to the repository.
    pub pipeline: &'a str,
    /// Settings by name.
    pub set: &'a [(&'a str, &'a str)],
    /// The scene.
    pub scene: &'a Scene,
    /// Width and height of the output.
    pub extent: [u32; 2],
}

/// A file of the repository.
#[must_use]
pub fn in_repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// The Plan for `setup` on `device`, found right by the checker.
///
/// # Errors
/// Any error that keeps the pipeline file from becoming a Plan, or the checker's findings.
pub fn plan(
    device: &Device,
    setup: &Setup<'_>,
    shaders: &mut ShaderLibrary,
    options: &Options,
) -> Result<Plan, Box<dyn Error>> {
    plan_for(device, setup, Ways::default(), shaders, options)
}

/// How a frame is drawn for those who look at it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Ways {
    /// For two eyes.
    pub stereo: Stereo,
    /// By how much what is shown on a screen is turned.
    pub rotation: Rotation,
}

/// The Plan for `setup` on `device`, drawn in one of the [`Ways`].
///
/// # Errors
/// Those of [`plan`].
pub fn plan_for(
    device: &Device,
    setup: &Setup<'_>,
    Ways { stereo, rotation }: Ways,
    shaders: &mut ShaderLibrary,
    options: &Options,
) -> Result<Plan, Box<dyn Error>> {
    let mut sources = Sources::default();
    let text = std::fs::read_to_string(in_repository(setup.pipeline))?;
    let mut named = PipelineFiles::beside(Root::new(in_repository("")), setup.pipeline, &[]);
    let pipeline = language::read_with(&mut sources, &mut named, setup.pipeline, setup.pipeline, text);
    let sources = Arc::new(sources);
    let rendered = |mistakes: Vec<Diagnostic>| base::render(&sources, &mistakes);
    let pipeline = pipeline.map_err(rendered)?;
    let set: Vec<_> = setup.set.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let facts = setup.scene.facts();
    // It decides how one image holds what both eyes see.
    let profile = (stereo != Stereo::Off).then(|| device.profile());
    let inputs = Inputs {
        set: &set,
        facts,
        facts_known: true,
        output_extent: setup.extent,
        dump: &[],
        device: profile.as_ref(),
        rotation,
        window: None,
        stereo,
    };
    let frame = expand::expand(&pipeline, sources.clone(), &inputs, shaders).map_err(rendered)?;
    let plan = compile::compile(&frame, &device.profile(), &mut device.memory(), options);
    let plan = plan.map_err(rendered)?;
    let violations: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
    if violations.is_empty() { Ok(plan) } else { Err(violations.join("\n").into()) }
}

/// Draws frames by the Plan of `options`, and leaves them to be read back.
///
/// # Errors
/// Any error that keeps a frame from being drawn, or the validation layer's findings.
pub fn draw(
    device: &Device,
    setup: &Setup<'_>,
    options: &Options,
    frames: u32,
) -> Result<(Plan, Executor), Box<dyn Error>> {
    let how = ExecutorOptions { poison: options.poison, ..ExecutorOptions::default() };
    let (plan, mut executor, mut draws) = ready(device, setup, options, &how)?;
    for _ in 0..frames {
        executor.frame(&mut draws)?;
    }
    silent(device)?;
    Ok((plan, executor))
}

/// As [`draw`], with what is shown on a screen turned.
///
/// # Errors
/// Those of [`draw`].
pub fn draw_rotated(
    device: &Device,
    setup: &Setup<'_>,
    options: &Options,
    frames: u32,
    rotation: Rotation,
) -> Result<(Plan, Executor), Box<dyn Error>> {
    let mut shaders = library();
    let plan = plan_for(device, setup, Ways { rotation, ..Ways::default() }, &mut shaders, options)?;
    let mut draws = SceneDrawSource::for_plan(device, setup.scene, setup.extent, &plan)?;
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    for _ in 0..frames {
        executor.frame(&mut draws)?;
    }
    silent(device)?;
    Ok((plan, executor))
}

/// The executor and draw source of the Plan of `options`, before the first frame.
///
/// # Errors
/// Any error that keeps frames from being drawn.
pub fn ready(
    device: &Device,
    setup: &Setup<'_>,
    options: &Options,
    how: &ExecutorOptions,
) -> Result<(Plan, Executor, SceneDrawSource), Box<dyn Error>> {
    let mut shaders = library();
    let plan = plan(device, setup, &mut shaders, options)?;
    let draws = SceneDrawSource::for_plan(device, setup.scene, setup.extent, &plan)?;
    let executor = Executor::new(device, &plan, &mut shaders, how)?;
    Ok((plan, executor, draws))
}

/// The shaders of the tests, and those that are shipped.
#[must_use]
pub fn library() -> ShaderLibrary {
    ShaderLibrary::new(vec![Root::new(in_repository("tests/shaders"))], SHADERS, interfaces())
}

/// Texels of 32-bit floats as numbers, channel by channel.
#[must_use]
pub fn floats(texels: &Texels) -> Vec<f64> {
    texels.bytes.as_chunks::<4>().0.iter().map(|word| f64::from(f32::from_ne_bytes(*word))).collect()
}

/// Texels of four such numbers each.
#[must_use]
pub fn rgba(texels: &Texels) -> Vec<[f64; 4]> {
    floats(texels).as_chunks::<4>().0.to_vec()
}

/// Their red, green and blue.
#[must_use]
pub fn rgb(texels: &Texels) -> Vec<[f64; 3]> {
    rgba(texels).into_iter().map(|[r, g, b, _]| [r, g, b]).collect()
}

/// Checks that the validation layer found nothing.
///
/// # Errors
/// The layer's findings.
pub fn silent(device: &Device) -> Result<(), Box<dyn Error>> {
    let findings: Vec<_> = device.messages().list().into_iter().filter(Message::is_finding).collect();
    if findings.is_empty() { Ok(()) } else { Err(format!("{findings:#?}").into()) }
}

/// The outputs of one frame, images all of them, in the file's order.
///
/// # Errors
/// Those of [`draw`].
pub fn render(device: &Device, setup: &Setup<'_>) -> Result<Vec<Texels>, Box<dyn Error>> {
    let (plan, mut executor) = draw(device, setup, &Options::default(), 1)?;
    let outputs = (0..plan.outputs.len()).map(|output| executor.read(output)).collect::<Result<_, _>>()?;
    silent(device)?;
    Ok(outputs)
}
