//! What `framewright explain` takes.

use super::pipeline::PipelineArguments;
use super::subject::SubjectArguments;
use super::values::AnswerFormat;
use clap::{Arg, ArgMatches, Args, Command, Error, FromArgMatches, Id};

/// `framewright explain`.
#[derive(Debug)]
pub(crate) enum ExplainArguments {
    /// The code of a mistake, by itself.
    Code { code: String, format: AnswerFormat },
    /// A thing in a Plan.
    Thing(Box<ThingArguments>),
}

/// A thing in a Plan.
#[derive(Debug, Args)]
pub(crate) struct ThingArguments {
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

/// The arguments of [`ExplainArguments::Code`].
const CODE: &str = "code";
const FORMAT: &str = "format";

impl Args for ExplainArguments {
    fn augment_args(command: Command) -> Command {
        let command = ThingArguments::augment_args(command);
        let others: Vec<Id> = command.get_arguments().map(|it| it.get_id().clone()).filter(|it| it != FORMAT).collect();
        let code = Arg::new(CODE).long(CODE).value_name("E0123").conflicts_with_all(others);
        command.arg(code.help(
            "Explain the code of a mistake: its rule, why it is one, and what mends it. Without pipeline and thing",
        ))
    }

    fn augment_args_for_update(command: Command) -> Command {
        ExplainArguments::augment_args(command)
    }
}

impl FromArgMatches for ExplainArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<ExplainArguments, Error> {
        Ok(match matches.get_one::<String>(CODE) {
            Some(code) => {
                let format = matches.get_one(FORMAT).copied().unwrap_or_default();
                ExplainArguments::Code { code: code.clone(), format }
            }
            None => ExplainArguments::Thing(Box::new(ThingArguments::from_arg_matches(matches)?)),
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = ExplainArguments::from_arg_matches(matches)?;
        Ok(())
    }
}
