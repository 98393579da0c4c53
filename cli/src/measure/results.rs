//! The results of `framewright measure`: the file `results.json` in its folder. `docs/measuring.md` describes it.

use crate::metric::{Errors, Flicker};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The version of the form.
pub(crate) const FORMAT_VERSION: u32 = 1;

/// All that a sweep has measured so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Results {
    pub(crate) format_version: u32,
    /// Results of one subject can be compared, and joined.
    pub(crate) subject: Subject,
    /// In the order of the sweep.
    pub(crate) rows: Vec<Row>,
}

/// The things that all rows have in common.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Subject {
    /// Framewright's version.
    pub(crate) framewright: String,
    /// A digest of all shipped shaders.
    pub(crate) shipped_shaders: String,
    /// The pipeline's file, as it was named.
    pub(crate) pipeline: String,
    /// A digest of the pipeline and of all files that it names, the user's own shaders among them.
    pub(crate) pipeline_digest: String,
    /// The device's name.
    pub(crate) device: String,
    /// The driver's name and version.
    pub(crate) driver: String,
    /// Frames whose times were taken, for each row.
    pub(crate) frames: u32,
    /// Frames of the moving scene over which flicker is measured; `None`: it isn't.
    pub(crate) flicker_frames: Option<u32>,
    /// The pictures that errors are measured against: `auto`, `none`, or the digest of a picture.
    pub(crate) reference: String,
    /// The choice that the ratios of times are relative to: all settings of the pipeline, by name, and `@scene`, by its digest,
    /// `@size` and `@stereo`.
    pub(crate) baseline: BTreeMap<String, String>,
}

/// One choice of the sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Row {
    /// The values that the sweep chose, by setting; `@size`, `@scene` and `@stereo` may be among them.
    pub(crate) choice: BTreeMap<String, String>,
    /// All settings of the pipeline, by name.
    pub(crate) settings: BTreeMap<String, String>,
    /// The scene's file, as it was named.
    pub(crate) scene: String,
    /// A digest of the scene's file.
    pub(crate) scene_digest: String,
    /// Width and height of the output in pixels.
    pub(crate) size: [u32; 2],
    /// The way of drawing for two eyes, or `off`.
    pub(crate) stereo: String,
    pub(crate) outcome: Outcome,
}

/// How measuring a row ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Outcome {
    Measured(Box<Measured>),
    /// The choice can't be drawn: the error's text.
    Failed(String),
}

/// A row's figures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Measured {
    pub(crate) cost: Cost,
    /// The errors beside the reference; `None` if there was none.
    pub(crate) errors: Option<Errors>,
    /// The reference's own errors beside one of half as many samples: an estimate of what it is wrong by itself.
    pub(crate) reference_errors: Option<Errors>,
    /// By pass, in the order of execution.
    pub(crate) passes: Vec<PassCost>,
    /// The picture, as a path within the folder.
    pub(crate) picture: Option<String>,
    /// The reference's picture, as a path within the folder.
    pub(crate) reference: Option<String>,
    /// The picture of FLIP, as a path within the folder.
    pub(crate) heat_map: Option<String>,
    /// The flicker over frames of the moving scene; `None` if it wasn't measured.
    pub(crate) flicker: Option<Flicker>,
    /// The picture of flicker, as a path within the folder.
    pub(crate) flicker_map: Option<String>,
}

/// The cost of a frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Cost {
    /// Milliseconds on the device; `None` if the device doesn't tell times.
    pub(crate) gpu_milliseconds: Option<Spread>,
    /// The time on the device relative to the baseline's, frame by frame in the same run; `None` if the device doesn't tell times.
    pub(crate) gpu_ratio: Option<Spread>,
    /// Milliseconds that the processor takes to record the frame.
    pub(crate) recording_milliseconds: Spread,
    /// Bytes of transient memory.
    pub(crate) transient_bytes: u64,
    /// Bytes that loads, stores, resolves and copies move, after the Plan.
    pub(crate) moved_bytes: u64,
    /// How often fragment shaders ran in a frame: the median; `None` if the device doesn't count it, or draws several views at once.
    pub(crate) fragment_invocations: Option<u64>,
}

/// A pass's cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PassCost {
    pub(crate) name: String,
    /// Milliseconds on the device; `None` if the device doesn't tell times.
    pub(crate) gpu_milliseconds: Option<Spread>,
}

/// Many figures of one thing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Spread {
    pub(crate) median: f64,
    /// A quarter of the figures is below.
    pub(crate) low: f64,
    /// A quarter of the figures is above.
    pub(crate) high: f64,
}
