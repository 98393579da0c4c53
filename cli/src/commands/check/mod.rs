//! `framewright check`: whether a pipeline is right, without a GPU.

mod every_device;
mod one_device;
pub(crate) mod verdict;

use crate::command_line::args::CheckArguments;
use crate::error::Error;
use crate::planning::{View, device};
use crate::system::Exit;
use crate::variants;
use std::ffi::OsStr;

/// The inputs of a frame that is checked.
pub(crate) fn view(arguments: &CheckArguments) -> View<'static> {
    View { size: arguments.size, ..View::without_scene(arguments.planning.rotate) }
}

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
