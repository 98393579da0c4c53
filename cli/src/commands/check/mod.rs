//! `framewright check`: whether a pipeline is right, without a GPU.

mod every_device;
mod one_device;
mod verdict;

use crate::command_line::args::CheckArguments;
use crate::error::Error;
use crate::planning::device;
use crate::system::Exit;
use crate::variants;
use std::ffi::OsStr;

/// Checks a pipeline on one device, on every device that has a shipped profile, or in all variants.
///
/// # Errors
/// Everything that is wrong, in the form for people. In the form for programs the mistakes of the pipeline are its answer.
pub(crate) fn check(arguments: &CheckArguments) -> Result<Exit, Error> {
    if arguments.all_variants {
        variants::check(arguments)
    } else if arguments.device.as_deref() == Some(OsStr::new(device::ALL)) {
        every_device::check(arguments)
    } else {
        one_device::check(arguments)
    }
}
