//! The command line of `framewright measure`.

use super::args::PipelineArguments;
use super::scenes::{DrawingDevice, SceneArguments};
use super::values::{DEFAULT_SIZE, Size, sweep};
use clap::Args;
use clap::builder::RangedI64ValueParser;
use framewright_lab::results::{FLICKER_FRAMES, FRAMES};
use framewright_lab::sweep::Sweep;
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// `framewright measure`.
#[derive(Debug, Args)]
pub(crate) struct MeasureArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    /// Scene to draw, as it stands at its first frame: a .glb or .gltf file, or a scene of our own in RON.
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) reading: SceneArguments,
    /// Size of the output in pixels.
    #[arg(long, value_name = "WxH", default_value_t = DEFAULT_SIZE)]
    pub(crate) size: Size,
    /// Values that a setting takes: a list, or a range and how many values of it. Repeatable: every value with every other. `@size`, `@scene`
    /// and `@stereo` may stand for a setting. Without this each setting that the preset `reference` names is swept by itself.
    #[arg(long, value_name = "NAME=A,B,C|NAME=LO..HI:STEPS", value_parser = sweep)]
    pub(crate) sweep: Vec<Sweep>,
    /// Only enough choices that every pair of values of any two sweeps occurs.
    #[arg(long)]
    pub(crate) pairwise: bool,
    /// Frames of each choice whose times are taken.
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = within(FRAMES))]
    pub(crate) frames: u32,
    /// Measures flicker too: how much the error changes from frame to frame over the first N frames of the moving scene.
    #[arg(long, value_name = "N", value_parser = within(FLICKER_FRAMES))]
    pub(crate) flicker: Option<u32>,
    /// Picture that errors are measured against: a .png or .exr file, or `auto`: the same choice under the preset `reference`, with at
    /// least 64 samples a pixel; `none` measures costs alone.
    #[arg(long, value_name = "auto|none|FILE", default_value = "auto")]
    pub(crate) reference: PathBuf,
    /// Measure only one of N parts of the sweep, numbered from 1: `framewright merge` joins them.
    #[arg(long, value_name = "K/N", default_value = "1/1", value_parser = shard)]
    pub(crate) shard: Shard,
    /// Folder for the results. What is measured there already stays.
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) device: DrawingDevice,
}

/// Reads a number of this range.
fn within(range: RangeInclusive<u32>) -> RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(i64::from(*range.start())..=i64::from(*range.end()))
}

/// One part of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shard {
    /// From 1.
    pub(crate) number: usize,
    pub(crate) of: usize,
}

fn shard(text: &str) -> Result<Shard, String> {
    let part = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
    match part {
        Some((number, of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
        _ => Err("expected K/N with K from 1 to N, such as 1/4".to_owned()),
    }
}
