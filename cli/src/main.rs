//! The `framewright` command: checks, shows and runs pipeline files.

mod attaching;
mod budget;
mod command_line;
mod commands;
mod drawing;
mod error;
mod error_code;
mod files;
mod findings;
mod measure;
mod planning;
mod serving;
mod system;
mod variants;
mod window;

use std::process::ExitCode;
use system::{Exit, platform, text};

fn main() -> ExitCode {
    framewright_vulkan::helper::serve();
    platform::survive_large_files();
    let line = match command_line::args::parse(std::env::args_os()) {
        Ok(line) => line,
        Err(error) => {
            // Help and version are answers, on standard output. Failing to print them is not reported: nobody reads them.
            drop(error.print());
            return if error.use_stderr() { Exit::Usage } else { Exit::Fine }.into();
        }
    };
    let exit = commands::execute(&line.command).unwrap_or_else(|error| {
        text::say(&error.shown());
        if error.leaves_the_device_at_work() {
            framewright_vulkan::end_process(error.exit() as u8);
        }
        error.exit()
    });
    exit.into()
}
