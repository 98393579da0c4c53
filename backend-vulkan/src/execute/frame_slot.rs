//! The place of one frame in flight: its command buffers, and what is kept until the device is done with it.

use super::import::Import;
use super::options::ExecutorOptions;
use super::output_readback::OutputReadback;
use super::promises::Promises;
use super::submission::SemaphorePoint;
use crate::base::Error;
use crate::commands::{CommandPool, Readback, record};
use crate::gpu::Gpu;
use crate::prepare::{Batch, Frame, PreparedPlan};
use crate::record::{Breadcrumbs, DrawSource, FragmentCounts, Observers, PassWatch, RecordedFrame, Recording, Timing};
use ash::vk;
use framewright_graph::plan::Plan;
use std::sync::Arc;
use std::time::Instant;

/// The objects of one frame in flight.
pub(super) struct FrameSlot {
    /// By batch.
    pub(super) commands: Vec<(CommandPool, vk::CommandBuffer)>,
    pub(super) observers: Observers,
    pub(super) recorded: RecordedFrame,
    /// By output, if they are kept.
    pub(super) outputs: Vec<Readback>,
    /// The frame that has the place, and where it ends.
    pub(super) frame: Option<(u64, FrameEnd)>,
    pub(super) finished: bool,
}

/// What tells that the device is done with a frame.
#[derive(Debug, Clone, Copy)]
pub(super) enum FrameEnd {
    /// The timelines of the Plan's queues, and the one of the program's semaphores at this value.
    Own { outer: u64 },
    /// A timeline of the program's, which submits the frame itself.
    Given(SemaphorePoint),
}

/// The imports and readbacks of a frame, which the Plan doesn't hold.
pub(crate) struct FrameExtras<'b> {
    pub(crate) imports: &'b [Import],
    /// By output, if they are kept.
    pub(crate) readbacks: &'b [OutputReadback],
}

impl FrameSlot {
    /// Room for a frame of `plan`.
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        batches: &[Batch],
        options: &ExecutorOptions,
        promises: Option<&Promises>,
    ) -> Result<FrameSlot, Error> {
        let commands = batches.iter().map(|batch| {
            let pool = CommandPool::new(gpu, batch.queue)?;
            let buffer = pool.buffer()?;
            Ok::<_, Error>((pool, buffer))
        });
        Ok(FrameSlot {
            commands: commands.collect::<Result<_, _>>()?,
            observers: Observers {
                timing: options.timestamps.then(|| Timing::new(gpu, plan, batches.len())).transpose()?,
                fragments: match options.fragment_counts {
                    true => FragmentCounts::new(gpu, plan, batches.len())?,
                    false => None,
                },
                watch: promises.map(|it| PassWatch::new(gpu, &it.steps)),
                breadcrumbs: options.breadcrumbs.then(|| Breadcrumbs::new(gpu, batches.len())).transpose()?,
            },
            recorded: RecordedFrame::default(),
            outputs: Vec::new(),
            frame: None,
            finished: false,
        })
    }

    /// Records all batches of a frame into command buffers of their own.
    pub(super) fn record(
        &mut self,
        batches: &[Batch],
        frame: &Frame<'_>,
        prepared: &PreparedPlan,
        source: &mut dyn DrawSource,
        extras: &FrameExtras<'_>,
    ) -> Result<(), Error> {
        for (pool, _) in &self.commands {
            pool.reset()?;
        }
        let buffers: &[(CommandPool, vk::CommandBuffer)] = &self.commands;
        recorded(&mut self.recorded, &mut self.observers, |recorded, observers| {
            let mut recording = Recording::new(frame, prepared, source, observers, recorded);
            for (batch, (_, buffer)) in batches.iter().zip(buffers) {
                record(frame.gpu, *buffer, |commands| {
                    record_batch(&mut recording, commands, batch, extras, &self.outputs)
                })?;
            }
            Ok(())
        })
    }

    /// Records a frame of one batch into a command buffer of the program's, which is being recorded.
    pub(super) fn record_into(
        &mut self,
        commands: vk::CommandBuffer,
        batch: &Batch,
        frame: &Frame<'_>,
        prepared: &PreparedPlan,
        source: &mut dyn DrawSource,
        extras: &FrameExtras<'_>,
    ) -> Result<(), Error> {
        recorded(&mut self.recorded, &mut self.observers, |recorded, observers| {
            let mut recording = Recording::new(frame, prepared, source, observers, recorded);
            record_batch(&mut recording, commands, batch, extras, &self.outputs)
        })
    }
}

/// Begins a frame, has `record` record it, and notes how long that took.
fn recorded(
    recorded: &mut RecordedFrame,
    observers: &mut Observers,
    record: impl FnOnce(&mut RecordedFrame, &mut Observers) -> Result<(), Error>,
) -> Result<(), Error> {
    let begun = Instant::now();
    observers.begin_frame()?;
    record(recorded, observers)?;
    recorded.end(begun);
    Ok(())
}

/// Records a batch with what the Plan doesn't hold.
fn record_batch(
    recording: &mut Recording<'_>,
    commands: vk::CommandBuffer,
    batch: &Batch,
    extras: &FrameExtras<'_>,
    outputs: &[Readback],
) -> Result<(), Error> {
    recording.begin_batch(commands, batch.queue);
    for step in batch.steps.clone() {
        for import in extras.imports.iter().filter(|it| it.first.0 as usize == step) {
            import.record(recording.frame, commands);
        }
        recording.step(commands, step)?;
        let readbacks = extras.readbacks.iter().zip(outputs);
        for (readback, into) in readbacks.filter(|(it, _)| it.after.0 as usize == step) {
            readback.record(recording.frame, commands, into);
        }
        for import in extras.imports.iter().filter(|it| it.last.0 as usize == step) {
            import.record_giving(recording.frame, commands);
        }
    }
    recording.end_batch(commands);
    Ok(())
}
