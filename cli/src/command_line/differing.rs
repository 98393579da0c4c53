//! The command line of `framewright diff`.

use super::pipeline::PipelineArguments;
use super::subject::SubjectArguments;
use super::values::{Assignment, assignment};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// `framewright diff`. Both Plans are made in the same way but for what `--a` and `--b` choose.
#[derive(Debug, Args)]
pub(crate) struct DiffArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    /// Pipeline or Plan to compare it with; by default the same one. A file that ends with .json is a Plan, here and there.
    #[arg(value_name = "OTHER")]
    pub(crate) other: Option<PathBuf>,
    /// A choice for the first Plan alone: a setting, or `@device`, `@scene`, `@size` or `@stereo`. Repeatable.
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub(crate) a: Vec<Assignment>,
    /// A choice for the second Plan alone. Repeatable.
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub(crate) b: Vec<Assignment>,
    #[command(flatten)]
    pub(crate) subject: SubjectArguments,
    /// Form of the answer.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: DifferenceFormat,
    /// File to write instead of printing.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// Form of differences.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum DifferenceFormat {
    /// For people.
    #[default]
    Human,
    /// For programs.
    Json,
    /// For a pull request.
    Markdown,
    /// Both Plans side by side as a page to explore, in one file.
    Html,
}
