//! The helper process: this program, started again, compiles shaders and tests drivers. It may crash without harm.

use crate::command_line::args::{CachingArguments, PipelineArguments, ShaderLimits};
use crate::error::Error;
use crate::system::{interrupt, text};
use framewright_vulkan::Helper;
use framewright_vulkan::helper::{Limits, LongTest};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// A helper whose compiler of shaders keeps to the limits of the command line.
///
/// # Errors
/// If the system doesn't tell where this program lies.
pub(crate) fn of(arguments: &PipelineArguments) -> Result<Helper, Error> {
    let mebibytes = |number: u32| u64::from(number) << 20;
    let ShaderLimits { shader_seconds, shader_memory, shader_stack } = arguments.limits;
    let limits = Limits {
        time: Duration::from_secs(shader_seconds.into()),
        memory: Some(mebibytes(shader_memory)),
        stack: usize::try_from(mebibytes(shader_stack)).unwrap_or(usize::MAX),
        ..Limits::default()
    };
    within(limits, arguments.caching)
}

/// A helper with the usual limits.
///
/// # Errors
/// Those of [`of`].
pub(crate) fn usual(caching: CachingArguments) -> Result<Helper, Error> {
    within(Limits::default(), caching)
}

/// A helper that Ctrl-C ends, and that says so when a self-test takes long.
fn within(limits: Limits, caching: CachingArguments) -> Result<Helper, Error> {
    let helper = Helper::this_program(limits).map_err(Error::Helper)?;
    let helper = if caching.no_cache { helper.with_cache(None) } else { helper };
    helper.cancel_when(interrupt::asked);
    let told = Mutex::new(String::new());
    helper.when_a_test_takes_long(move |LongTest { device, limit, .. }| {
        let mut told = told.lock().unwrap_or_else(PoisonError::into_inner);
        if *told != *device {
            text::say(&format!(
                "note: testing what `{}` does takes long; each of two tests is given up after {} s",
                text::escape(device),
                limit.as_secs()
            ));
            told.clone_from(device);
        }
    });
    Ok(helper)
}
