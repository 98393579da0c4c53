//! The results of a sweep, as the file `results.json` has them. `docs/measuring.md` describes it.

mod joining;
mod json;
mod naming;
mod plausible;
mod spread;

use crate::metric::{Errors, Flicker};
pub use joining::{JoiningProblem, Part, difference, joined};
pub use json::ResultsProblem;
pub use naming::Group;
use serde::{Deserialize, Serialize};
pub use spread::spread;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// The version of the form.
pub const FORMAT_VERSION: u32 = 1;

/// The numbers of frames of a choice whose times can be taken.
pub const FRAMES: RangeInclusive<u32> = 1..=100_000;
/// The numbers of frames over which flicker can be measured: a frame alone doesn't flicker.
pub const FLICKER_FRAMES: RangeInclusive<u32> = 2..=1000;

/// All that a sweep has measured so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Results {
    /// [`FORMAT_VERSION`].
    pub format_version: u32,
    /// Results of one subject can be compared, and joined.
    pub subject: Subject,
    /// In the order of the sweep.
    pub rows: Vec<Row>,
}

/// The things that all rows have in common.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subject {
    /// Framewright's version.
    pub framewright: String,
    /// A digest of all shipped shaders.
    pub shipped_shaders: String,
    /// The pipeline's file, as it was named.
    pub pipeline: String,
    /// A digest of the pipeline and of all files that it names, the user's own shaders among them.
    pub pipeline_digest: String,
    /// The device's name.
    pub device: String,
    /// The driver's name and version.
    pub driver: String,
    /// Frames whose times were taken, for each row, of [`FRAMES`].
    pub frames: u32,
    /// Frames of the moving scene over which flicker is measured, of [`FLICKER_FRAMES`]; `None`: it isn't.
    pub flicker_frames: Option<u32>,
    /// The pictures that errors are measured against: `auto`, `none`, or the digest of a picture.
    pub reference: String,
    /// The choice that the ratios of times are relative to: all settings of the pipeline, by name, and `@scene`, by its digest,
    /// `@size` and `@stereo`.
    pub baseline: BTreeMap<String, String>,
}

/// One choice of the sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The values that the sweep chose, by setting; `@size`, `@scene` and `@stereo` may be among them.
    pub choice: BTreeMap<String, String>,
    /// All settings of the pipeline, by name.
    pub settings: BTreeMap<String, String>,
    /// The scene's file, as it was named.
    pub scene: String,
    /// A digest of the scene's file.
    pub scene_digest: String,
    /// Width and height of the output in pixels.
    pub size: [u32; 2],
    /// The way of drawing for two eyes, or `off`.
    pub stereo: String,
    /// How measuring it ended.
    pub outcome: Outcome,
}

/// How measuring a row ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// It has figures.
    Measured(Box<RowFigures>),
    /// The choice can't be drawn: the error's text.
    Failed(String),
}

/// A row's figures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RowFigures {
    /// What the frame costs.
    pub cost: Cost,
    /// The errors beside the reference; `None` if there was none.
    pub errors: Option<Errors>,
    /// The reference's own errors beside one of half as many samples: an estimate of what it is wrong by itself.
    pub reference_errors: Option<Errors>,
    /// By pass, in the order of execution.
    pub passes: Vec<PassCost>,
    /// The picture, as a path within the folder.
    pub picture: Option<String>,
    /// The reference's picture, as a path within the folder.
    pub reference: Option<String>,
    /// The picture of FLIP, as a path within the folder.
    pub heat_map: Option<String>,
    /// The flicker over frames of the moving scene; `None` if it wasn't measured.
    pub flicker: Option<Flicker>,
    /// The picture of flicker, as a path within the folder.
    pub flicker_map: Option<String>,
}

/// The cost of a frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cost {
    /// Milliseconds on the device; `None` if the device doesn't tell times.
    pub gpu_milliseconds: Option<Spread>,
    /// The time on the device relative to the baseline's, frame by frame in the same run; `None` if the device doesn't tell times.
    pub gpu_ratio: Option<Spread>,
    /// Milliseconds that the processor takes to record the frame.
    pub recording_milliseconds: Spread,
    /// Bytes of transient memory.
    pub transient_bytes: u64,
    /// Bytes that loads, stores, resolves and copies move, after the Plan.
    pub moved_bytes: u64,
    /// How often fragment shaders ran in a frame: the median; `None` if the device doesn't count it, or draws several views at once.
    pub fragment_invocations: Option<u64>,
}

/// A pass's cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassCost {
    /// The pass's name.
    pub name: String,
    /// Milliseconds on the device; `None` if the device doesn't tell times.
    pub gpu_milliseconds: Option<Spread>,
}

/// Many figures of one thing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// The middle one.
    pub median: f64,
    /// A quarter of the figures is below.
    pub low: f64,
    /// A quarter of the figures is above.
    pub high: f64,
}
