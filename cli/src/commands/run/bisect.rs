//! `run --bisect`: every image after every pass that wrote it, in two modes that must agree, and the first that differs.

use crate::command_line::args::{DebugMode, RunArguments};
use crate::drawing::captures::{self, CapturedImage, Drawing};
use crate::error::Error;
use crate::files::outputs;
use crate::system::{Exit, text};
use clap::ValueEnum;
use framewright::Pipeline;
use framewright_graph::base::ReadFiles;
use framewright_graph::compile::{Options, Order};
use framewright_graph::frame::Frame;
use framewright_graph::plan::Plan;
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, ExecutorOptions};
use serde::Serialize;

/// What was compared, and what differs.
#[derive(Debug, Serialize)]
struct BisectResult {
    format_version: u32,
    mode: String,
    /// How many images were compared, each after a pass that wrote it.
    compared: usize,
    first_difference: Option<Difference>,
}

/// The first image that differs.
#[derive(Debug, Serialize)]
struct Difference {
    pass: String,
    image: String,
    /// Texels that differ, of how many.
    texels: [usize; 2],
    /// The first of them, from the upper left corner; layers stand side by side.
    at: [usize; 2],
    /// The words of the file that promise that the pass sets them all, if poison has refuted them.
    refuted: Option<&'static str>,
}

/// Draws in both modes and says where they part.
///
/// # Errors
/// Those of planning and drawing, and of the report.
pub(super) fn bisect(
    arguments: &RunArguments,
    mode: DebugMode,
    device: &Device,
    pipeline: &mut Pipeline,
    made: (&Plan, &Frame),
    scene: &Scene,
    read: &ReadFiles,
) -> Result<Exit, Error> {
    let (options, executor) = (arguments.planning.options(), arguments.executor_options());
    let mut drawn = |options: Options, executor: ExecutorOptions| -> Result<Vec<CapturedImage>, Error> {
        let drawing = Drawing::new(device, pipeline, made, scene, options);
        let mut all = Vec::new();
        captures::draw(Drawing { options, executor, frames: arguments.frames, ..drawing }, |captured| {
            all.push(captured);
            Ok(())
        })?;
        Ok(all)
    };
    let first = drawn(options, executor.clone())?;
    let (options, executor) = in_mode(mode, options, executor);
    let second = drawn(options, executor)?;
    let name = mode.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
    let mut first_difference = first.iter().zip(&second).find_map(|(a, b)| difference(a, b));
    if let Some(difference) = first_difference.as_mut().filter(|_| mode == DebugMode::Poison) {
        difference.refuted = made.1.promise(&difference.pass, &difference.image);
    }
    let found =
        BisectResult { format_version: 1, mode: name, compared: first.len().min(second.len()), first_difference };
    if let Some(file) = &arguments.report {
        outputs::write(&[(file, text::json(&found)?.as_bytes())], read)?;
    }
    text::print(&found.sentence()).map_err(Error::Print)?;
    Ok(if found.first_difference.is_some() { Exit::Found } else { Exit::Fine })
}

/// The options with a mode on, or off where they have it.
fn in_mode(mode: DebugMode, options: Options, executor: ExecutorOptions) -> (Options, ExecutorOptions) {
    match mode {
        DebugMode::FullBarriers => (options, ExecutorOptions { full_barriers: !executor.full_barriers, ..executor }),
        DebugMode::StepByStep => (options, ExecutorOptions { step_by_step: !executor.step_by_step, ..executor }),
        DebugMode::Poison => {
            let poison = !options.poison;
            (Options { poison, ..options }, ExecutorOptions { poison, ..executor })
        }
        DebugMode::NoAlias => (Options { alias: !options.alias, ..options }, executor),
        DebugMode::FileOrder => {
            let order = if options.order == Order::File { Order::Default } else { Order::File };
            (Options { order, ..options }, executor)
        }
        DebugMode::OneQueue => (Options { queues: !options.queues, ..options }, executor),
    }
}

/// How two captures of the same image differ.
fn difference(a: &CapturedImage, b: &CapturedImage) -> Option<Difference> {
    let texels = (a.extent[0] as usize * a.extent[1] as usize).max(1);
    let bytes = (a.bytes.len() / texels).max(1);
    let pairs = a.bytes.chunks(bytes).zip(b.bytes.chunks(bytes)).enumerate();
    let mut differ = pairs.filter(|(_, (a, b))| a != b).map(|(at, _)| at);
    let first = differ.next().or((a.bytes.len() != b.bytes.len()).then_some(0))?;
    let width = (a.extent[0] as usize).max(1);
    Some(Difference {
        pass: a.capture.pass.to_string(),
        image: a.capture.image.to_string(),
        texels: [1 + differ.count(), texels],
        at: [first % width, first / width],
        refuted: None,
    })
}

impl BisectResult {
    fn sentence(&self) -> String {
        let BisectResult { mode, compared, first_difference, .. } = self;
        match first_difference {
            None => format!("all {compared} images after their passes are the same with and without `{mode}`\n"),
            Some(Difference { pass, image, texels: [differ, all], at: [x, y], refuted }) => {
                let refuted = refuted.map_or_else(String::new, |words| {
                    format!("; `{words}` promises that the pass sets them all, which is false")
                });
                format!(
                    "with and without `{mode}` the pictures part at pass `{}`: {differ} of {all} texels of `{}` differ, the first \
                     at {x}, {y}{refuted}\n",
                    text::escape(pass),
                    text::escape(image)
                )
            }
        }
    }
}
