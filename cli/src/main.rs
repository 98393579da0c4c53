//! The `framewright` command: checks, shows and runs pipeline files.

mod args;
mod check;
mod devices;
mod error;
mod every_device;
mod facts;
mod files;
mod helper;
mod inspect;
mod interrupt;
mod layer;
mod links;
mod new;
mod notes;
mod options;
mod output;
mod picture;
mod placed;
mod planning;
mod profiles;
mod progress;
mod report;
mod rows;
mod run;
mod schema;
mod shipped;
mod stream;
mod text;
mod values;
mod variants;

use args::Command;
use error::Exit;
use std::process::ExitCode;

fn main() -> ExitCode {
    framewright_vulkan::helper::serve();
    interrupt::survive_large_files();
    let line = match args::parse(std::env::args_os()) {
        Ok(line) => line,
        Err(error) => {
            // Help and version are answers, on standard output; if nobody reads them there is nobody to tell.
            drop(error.print());
            return if error.use_stderr() { Exit::Usage } else { Exit::Fine }.into();
        }
    };
    let result = match &line.command {
        Command::Run(arguments) if arguments.validate => {
            layer::under_the_current_one().and_then(|()| run::run(arguments))
        }
        Command::Check(arguments) => check::check(arguments),
        Command::Inspect(arguments) => inspect::inspect(arguments),
        Command::Run(arguments) => run::run(arguments),
        Command::Facts(arguments) => facts::facts(arguments),
        Command::New(arguments) => new::new(arguments),
        Command::Schema(arguments) => schema::schema(arguments),
        Command::Devices(arguments) => devices::devices(arguments),
    };
    match result {
        Ok(exit) => exit,
        Err(error) => {
            text::say(&error.shown());
            if error.leaves_the_device_at_work() {
                framewright_vulkan::end_process(error.exit() as u8);
            }
            error.exit()
        }
    }
    .into()
}
