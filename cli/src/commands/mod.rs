//! The commands.

mod attach;
mod cache;
mod check;
mod choose;
mod compare;
mod devices;
mod diff;
mod explain;
mod facts;
mod inspect;
mod merge;
mod new;
mod run;
mod schema;
mod serve;

use crate::command_line::args::Command;
use crate::error::Error;
use crate::measure;
use crate::system::Exit;
use crate::window;

/// Does what the command line asks for.
///
/// # Errors
/// The error that ends the command early.
pub(crate) fn execute(command: &Command) -> Result<Exit, Error> {
    match command {
        Command::Check(arguments) => check::check(arguments),
        Command::Inspect(arguments) => inspect::inspect(arguments),
        Command::Diff(arguments) => diff::diff(arguments),
        Command::Explain(arguments) => explain::explain(arguments),
        Command::Run(arguments) => run::run(arguments),
        Command::Serve(arguments) => serve::serve(arguments),
        Command::Attach(arguments) => attach::attach(arguments),
        Command::Window(arguments) => window::window(arguments),
        Command::Facts(arguments) => facts::facts(arguments),
        Command::Compare(arguments) => compare::compare(arguments),
        Command::Measure(arguments) => measure::measure(arguments),
        Command::Choose(arguments) => choose::choose(arguments),
        Command::Merge(arguments) => merge::merge(arguments),
        Command::New(arguments) => new::new(arguments),
        Command::Schema(arguments) => schema::schema(arguments),
        Command::Devices(arguments) => devices::devices(arguments),
        Command::Cache(arguments) => cache::cache(arguments),
    }
}
