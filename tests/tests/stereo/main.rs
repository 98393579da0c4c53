//! What two eyes see, drawn one after the other and at once.

mod agreement;
mod cameras;
mod eyes;
mod packed;
mod rotated;

use framewright_graph::compile::Options;
use framewright_graph::frame::Draw;
use framewright_graph::plan::{Pass, Plan, Resource, Work};
use framewright_graph::rotation::Rotation;
use framewright_graph::view::{Eye, EyeForm, Stereo};
use framewright_passes::draw::{Eyes, SceneDrawSource};
use framewright_passes::scene::Scene;
use framewright_tests::render::{Setup, Ways, library, plan_for, silent};
use framewright_vulkan::{Device, Executor, ExecutorOptions, FrameReport, Texels};
use std::error::Error;

/// Odd, so that a half of it would be no whole number.
const EXTENT: [u32; 2] = [97, 61];
const EVEN: [u32; 2] = [96, 60];

/// What is drawn.
#[derive(Clone, Copy)]
struct Case<'a> {
    pipeline: &'a str,
    set: &'a [(&'a str, &'a str)],
    scene: &'a Scene,
    extent: [u32; 2],
    frames: u32,
}

/// What the left eye sees, and the right one.
type Pair = [Vec<u8>; 2];

/// What was drawn.
struct Drawn {
    plan: Plan,
    /// Of the last frame.
    report: FrameReport,
    /// By frame and output; twice the same where both eyes share it.
    frames: Vec<Vec<Pair>>,
}

/// A pipeline file that is shipped.
fn shipped(name: &str) -> String {
    format!("examples/pipelines/{name}.ron")
}

/// Those ways to draw for both eyes at once that the device knows.
fn at_once(device: &Device) -> Vec<Stereo> {
    let all = [Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];
    all.into_iter().filter(|stereo| stereo.lacks(&device.profile()).is_none()).collect()
}

/// One eye after the other, or both at once, upright.
fn upright(stereo: Stereo) -> Ways {
    Ways { stereo, rotation: Rotation::Identity }
}

fn drawn(device: &Device, case: &Case<'_>, ways: Ways, eyes: &Eyes) -> Result<Drawn, Box<dyn Error>> {
    let mut shaders = library();
    let Case { pipeline, set, scene, extent, frames } = *case;
    let plan = plan_for(device, &Setup { pipeline, set, scene, extent }, ways, &mut shaders, &Options::default())?;
    let mut draws = SceneDrawSource::for_eyes(device, scene, extent, &plan, eyes)?;
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    let mut shown = Vec::new();
    let mut report = None;
    for _ in 0..frames {
        report = Some(executor.frame(&mut draws)?);
        shown.push(read(&plan, &mut executor)?);
    }
    silent(device)?;
    Ok(Drawn { plan, report: report.ok_or("no frame")?, frames: shown })
}

/// All outputs, each as both eyes see it.
fn read(plan: &Plan, executor: &mut Executor) -> Result<Vec<Pair>, Box<dyn Error>> {
    let mut pictures = Vec::new();
    for (at, output) in plan.outputs.iter().enumerate().filter(|(_, output)| output.eye != Some(Eye::Right)) {
        let texels = executor.read(at)?;
        let Resource::Image(image) = output.resource else { return Err("an output that is no image".into()) };
        pictures.push(match (output.eye, plan.image(image).eyes) {
            (Some(_), _) => [texels.bytes, executor.read(at + 1)?.bytes],
            (None, None) => [texels.bytes.clone(), texels.bytes],
            (None, Some(form)) => parted(&texels, form),
        });
    }
    Ok(pictures)
}

/// Both eyes' parts of what holds them.
fn parted(texels: &Texels, form: EyeForm) -> Pair {
    let run = match form {
        EyeForm::Layers => texels.bytes.len() / 2,
        EyeForm::Halves => texels.bytes.len() / (2 * texels.extent[1] as usize),
    };
    [0, 1].map(|eye| texels.bytes.chunks(run).skip(eye).step_by(2).flatten().copied().collect())
}

/// How many pixels of four bytes differ by more than one step in any channel.
fn apart(one: &[u8], other: &[u8]) -> usize {
    assert_eq!(one.len(), other.len());
    let pixels = one.as_chunks::<4>().0.iter().zip(other.as_chunks::<4>().0);
    pixels.filter(|(one, other)| one.iter().zip(*other).any(|(one, other)| one.abs_diff(*other) > 1)).count()
}

/// How many pixels differ so; and how many by more than three steps where the second picture has no edge.
fn apart_within(found: &[u8], expected: &[u8], [width, height]: [u32; 2]) -> [usize; 2] {
    let [width, height] = [width, height].map(|side| side as usize);
    assert_eq!([found.len(), expected.len()], [4 * width * height; 2]);
    let step = |one: usize, of: &[u8]| {
        let pixels = expected[4 * one..4 * one + 4].iter().zip(of);
        pixels.map(|(one, other)| one.abs_diff(*other)).max().unwrap_or(0)
    };
    let is_edge = |at: usize| {
        let around = |at: usize, of: usize| at.saturating_sub(2)..(at + 3).min(of);
        let mut near = around(at / width, height).flat_map(|y| around(at % width, width).map(move |x| y * width + x));
        near.any(|near| step(at, &expected[4 * near..4 * near + 4]) > 8)
    };
    let steps: Vec<u8> = found.chunks(4).enumerate().map(|(at, pixel)| step(at, pixel)).collect();
    let within = steps.iter().enumerate().filter(|(at, step)| **step > 3 && !is_edge(*at)).count();
    [steps.iter().filter(|step| **step > 1).count(), within]
}

/// Texels of four floats.
fn floats(picture: &[u8]) -> Vec<[f32; 4]> {
    picture.as_chunks::<4>().0.as_chunks::<4>().0.iter().map(|texel| texel.map(f32::from_ne_bytes)).collect()
}

/// How images hold both eyes' parts, if any do.
fn form(plan: &Plan) -> Option<EyeForm> {
    plan.images.iter().find_map(|image| image.eyes)
}

/// All that is drawn within rendering scopes.
fn rendered(plan: &Plan) -> impl Iterator<Item = &Pass> {
    let scopes = plan.steps.iter().filter_map(|step| match &step.work {
        Work::Render(scope) => Some(&scope.passes),
        _ => None,
    });
    scopes.flatten()
}

/// How many passes draw what casts shadows.
fn casters(plan: &Plan) -> usize {
    rendered(plan).filter(|pass| matches!(pass.draw, Some(Draw::Casters(_)))).count()
}
