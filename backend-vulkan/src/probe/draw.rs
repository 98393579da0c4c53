//! The frame of a self-test: a frame like any other, with a Plan of its own.

use crate::base::Error;
use crate::execute::{Executor, ExecutorOptions};
use crate::gpu::Device;
use crate::record::{DrawSource, Recorder};
use crate::shaders::ShaderLibrary;
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::Profile;
use framewright_graph::frame::{Draw, Frame};
use framewright_graph::shader::DrawInterface;

/// Draws `frame` with these shaders on a device that is taken to do what `claimed` says.
///
/// # Errors
/// If that can't be done.
pub(super) fn draw(
    device: &Device,
    claimed: &Profile,
    frame: &Frame,
    shaders: &'static [(&'static str, &'static str)],
) -> Result<Executor, Error> {
    let plan = compile(frame, claimed, &mut device.memory(), &Options::default());
    let failed = |what: String| Error::BadPlan { what };
    let plan = plan.map_err(|mistakes| failed(mistakes.into_iter().map(|it| it.message).collect()))?;
    let mut shaders = ShaderLibrary::new(Vec::new(), shaders, |_| DrawInterface::default());
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    executor.frame(&mut FullScreenOnly)?;
    Ok(executor)
}

/// Full-screen draws need nothing brought along.
struct FullScreenOnly;

impl DrawSource for FullScreenOnly {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Ok(0)
    }
}
