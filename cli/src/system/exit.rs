//! Exit codes.

use std::process::ExitCode;

/// How a command ends. The numbers are the command's contract.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exit {
    /// All is well.
    Fine = 0,
    /// The user's files are wrong or missing, or a check found something.
    Found = 1,
    /// The command line is wrong.
    Usage = 2,
    /// The environment lacks something: driver, layer, device, permission, disk.
    Environment = 3,
    /// Ctrl-C, as shells count it.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}
