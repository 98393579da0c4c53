//! `cargo bench --workspace --profile test --bench dev_instructions`: the instructions that checking all variants of `forward`
//! takes, beside the committed ones. It fails if they are 3 % more, and names the command that accepts the new figures. It
//! needs valgrind. The profile `dev`, and that of the whole workspace, counts what tests build anyway.
//!
//! The count is that of checking all variants on one thread, less that of checking one: so neither the beginning of the
//! command nor its shaders are part of it. The helper process that compiles shaders isn't counted; a first run fills the
//! cache of shaders. `instructions.txt` holds the committed figures.

#[allow(dead_code, reason = "each bench uses a part of it")]
#[path = "../../graph/benches/shared/counts.rs"]
mod counts;

use counts::{Code, Guard};
use std::error::Error;
use std::process::{Command, ExitCode};

const ACCEPT: &str = "FRAMEWRIGHT_ACCEPT=cli cargo bench --workspace --profile test --bench dev_instructions";
const FIGURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions.txt");

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let all = ["--all-variants", "--device", "all", "--threads", "1"];
    command(&all).output()?;
    let guard = Guard { figures: FIGURES, accept: ACCEPT };
    guard.run(["variants of forward"], |_| {
        let [one, every] = [&[][..], &all[..]].map(|words| counts::instructions(&command(words), Code::Program));
        Ok(every?.saturating_sub(one?))
    })
}

fn command(words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_framewright"));
    command.args(["check", "forward"]).args(words);
    command
}
