//! The block `params` of a pass.
//!
//! Where each frame has values of its own, there is a copy of the block for each frame in flight. The host writes the frame's copy before
//! the frame is submitted, and what was written before a submission is visible to it: so no barrier is needed.

use super::frame::FrameClock;
use crate::base::Error;
use crate::gpu::Gpu;
use crate::memory::{MemoryUse, RawBuffer};
use crate::pipeline::parameters;
use ash::vk;
use framewright_graph::frame::FrameValue;
use framewright_graph::plan;
use framewright_graph::shader::{Block, PARAMS};
use std::sync::Arc;

/// A block `params` with the values of a pass.
pub(crate) struct ParamBlock {
    /// What every copy holds, but for the values of a frame.
    bytes: Vec<u8>,
    /// The values that each frame has its own of, and where they lie.
    of_frame: Vec<(usize, FrameValue)>,
    /// One, or one for each frame in flight if frames have values of their own.
    copies: Vec<RawBuffer>,
}

impl ParamBlock {
    /// The block of a pass. `frames`: how many may be in flight, at least one.
    ///
    /// # Errors
    /// [`Error::Mismatch`] where block and values don't fit; [`Error::OutOfMemory`].
    pub(super) fn new(gpu: &Arc<Gpu>, block: &Block, pass: &plan::Pass, frames: u32) -> Result<ParamBlock, Error> {
        let mismatch = |what: String| Error::Mismatch { pass: pass.name.to_string(), what };
        let bytes = parameters::fill(block, &pass.params).map_err(mismatch)?;
        let of_frame = parameters::frame_values(block, &pass.params);
        let count = if of_frame.is_empty() { 1 } else { frames.max(1) };
        let copy = |_| {
            let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
            let mut buffer = RawBuffer::new(gpu, PARAMS, bytes.len() as u64, usage, MemoryUse::Upload)?;
            buffer.fill(&bytes)?;
            Ok(buffer)
        };
        let copies = (0..count).map(copy).collect::<Result<_, Error>>()?;
        Ok(ParamBlock { bytes, of_frame, copies })
    }

    /// Whether each frame has values of its own.
    pub(super) fn has_frame_values(&self) -> bool {
        !self.of_frame.is_empty()
    }

    /// After how many frames the same copy is read again.
    pub(super) fn period(&self) -> u64 {
        self.copies.len() as u64
    }

    /// The copy that a frame reads.
    pub(super) fn buffer(&self, frame: u64) -> vk::Buffer {
        self.copies[self.place(frame)].raw
    }

    /// Writes the values of a frame into its copy. The frame that read the copy before must have been waited for.
    pub(super) fn write(&mut self, frame: u64, clock: FrameClock) -> Result<(), Error> {
        for (place, value) in &self.of_frame {
            if let Some(bytes) = self.bytes.get_mut(*place..place.saturating_add(4)) {
                bytes.copy_from_slice(&clock.word(*value));
            }
        }
        let place = self.place(frame);
        self.copies[place].fill(&self.bytes)
    }

    fn place(&self, frame: u64) -> usize {
        usize::try_from(frame % self.period()).unwrap_or(0)
    }
}
