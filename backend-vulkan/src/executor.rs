//! Executing a Plan, frame by frame.

use crate::check::{Refuse, check};
use crate::device::{Device, Shared};
use crate::error::Error;
use crate::prepare::Prepared;
use crate::readback::{self, Texels};
use crate::record::Frame;
use crate::recorder::DrawSource;
use crate::shaders::ShaderLibrary;
use crate::submit::Commands;
use crate::timing::{FrameReport, Timing};
use framewright_graph::plan::{Plan, Role};
use std::sync::Arc;
use std::time::Duration;

/// How a Plan is executed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExecutorOptions {
    /// Whether each transient image is filled with conspicuous values when the frame takes it into use, which must not
    /// change the picture. Needs a Plan that was compiled with poison.
    pub poison: bool,
    /// How long the device may take for a frame. If it takes longer the device is given up: nothing that was made from it
    /// can be used any more.
    pub timeout: Duration,
}

impl Default for ExecutorOptions {
    fn default() -> Self {
        ExecutorOptions { poison: false, timeout: Duration::from_secs(120) }
    }
}

/// A Plan on a device, ready to draw frames. One frame is in flight at a time: [`Executor::frame`] waits for it.
pub struct Executor {
    shared: Arc<Shared>,
    plan: Plan,
    options: ExecutorOptions,
    commands: Commands,
    timing: Timing,
    prepared: Prepared,
    drawn: bool,
}

impl Executor {
    /// Makes everything that `plan` needs on `device`: memory, images, pipelines, descriptor sets.
    ///
    /// # Errors
    /// [`Error::Violations`] if the Plan is wrong in itself, [`Error::BadPlan`] or [`Error::OtherMemoryNeeds`] if this
    /// device can't execute it as it is, [`Error::Shader`] and [`Error::Mismatch`] for shaders, [`Error::OutOfMemory`].
    pub fn new(
        device: &Device,
        plan: &Plan,
        shaders: &mut ShaderLibrary,
        options: &ExecutorOptions,
    ) -> Result<Executor, Error> {
        Executor::checked(device, plan, shaders, options, Refuse::Violations)
    }

    /// Like [`Executor::new`], but hazards in the Plan pass, to see what the validation layer or the poison says of them.
    ///
    /// # Errors
    /// Those of [`Executor::new`]; [`Error::Violations`] only for what is malformed.
    ///
    /// # Safety
    /// Missing barriers, wrong layouts and images that lie over each other are undefined behaviour on the device: either
    /// the Plan has none, or the device is a software driver that executes commands in order.
    pub unsafe fn with_hazards(
        device: &Device,
        plan: &Plan,
        shaders: &mut ShaderLibrary,
        options: &ExecutorOptions,
    ) -> Result<Executor, Error> {
        Executor::checked(device, plan, shaders, options, Refuse::Malformed)
    }

    fn checked(
        device: &Device,
        plan: &Plan,
        shaders: &mut ShaderLibrary,
        options: &ExecutorOptions,
        refuse: Refuse,
    ) -> Result<Executor, Error> {
        let shared = &device.shared;
        check(shared, plan, refuse, options.poison)?;
        Ok(Executor {
            shared: shared.clone(),
            commands: Commands::new(shared)?,
            timing: Timing::new(shared, plan)?,
            prepared: Prepared::new(shared, plan, shaders)?,
            plan: plan.clone(),
            options: options.clone(),
            drawn: false,
        })
    }

    /// Draws a frame and waits until the device is done.
    ///
    /// # Errors
    /// What `source` returns, [`Error::Recording`] if it misused its recorder, [`Error::DeviceLost`], [`Error::Timeout`].
    pub fn frame(&mut self, source: &mut dyn DrawSource) -> Result<FrameReport, Error> {
        let frame =
            Frame { shared: &self.shared, plan: &self.plan, prepared: &self.prepared, poison: self.options.poison };
        let timing = &mut self.timing;
        let recorded = self.commands.record(|commands| frame.record(commands, source, timing))?;
        self.commands.submit("drawing a frame", self.options.timeout)?;
        self.drawn = true;
        self.timing.report(&self.plan, &recorded.draws)
    }

    /// The output number `output` of the Plan, as the last frame left it.
    ///
    /// # Errors
    /// [`Error::BadResource`] if there is no such output or no frame yet, [`Error::OutOfMemory`], [`Error::DeviceLost`].
    pub fn read(&self, output: usize) -> Result<Texels, Error> {
        let bad = |what: &str| Error::BadResource { what: format!("output {output} can't be read: {what}") };
        let image = *self.plan.outputs.get(output).ok_or_else(|| bad("the Plan has fewer"))?;
        match self.plan.image(image).role {
            Role::Output { after, .. } if self.drawn => {
                readback::read(&self.shared, &self.prepared.images[image.0 as usize], after)
            }
            Role::Output { .. } => Err(bad("no frame was drawn yet")),
            Role::Transient(_) => Err(bad("it is transient")),
        }
    }
}
