//! What `framewright explain` takes.

use super::pipeline::PipelineArguments;
use super::subject::SubjectArguments;
use super::values::AnswerFormat;
use clap::Args;

/// `framewright explain`.
#[derive(Debug, Args)]
pub(crate) struct ExplainArguments {
    #[command(flatten)]
    pub(crate) pipeline: PipelineArguments,
    /// The thing to explain: the name of a pass, an image or a buffer, or `step:3`, `resolve:color`, `barrier:color`, `heap:0`,
    /// `queue:compute`.
    #[arg(value_name = "THING")]
    pub(crate) thing: String,
    #[command(flatten)]
    pub(crate) subject: SubjectArguments,
    /// Form of the answer.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: AnswerFormat,
}
