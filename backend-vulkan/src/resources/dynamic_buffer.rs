//! Buffers that are written again and again while frames in flight read what was written before.

use super::texture::{Buffer, BufferUsage, flags_of};
use crate::base::Error;
use crate::gpu::{Device, Gpu};
use crate::memory::{MemoryUse, RawBuffer};
use ash::vk;
use std::sync::{Arc, Mutex, PoisonError};

/// A buffer for contents that change from frame to frame, such as those of a camera, of moving objects or of particles. Clones share it.
///
/// [`DynamicBuffer::write`] writes a copy that no frame in flight reads, and all that is recorded afterwards reads that copy. A
/// copy is made when there is none left: there are as many as the writes that frames in flight read, and one or two more. They stay as
/// long as the buffer, and then writing allocates nothing.
#[derive(Clone)]
pub struct DynamicBuffer(pub(crate) Arc<RawDynamicBuffer>);

/// A dynamic buffer's parts.
pub(crate) struct RawDynamicBuffer {
    gpu: Arc<Gpu>,
    pub(crate) flags: vk::BufferUsageFlags,
    bytes: u64,
    copies: Mutex<Copies>,
}

/// Copies, which frames in flight hold as long as they read them.
struct Copies {
    all: Vec<Arc<RawBuffer>>,
    /// The one that was written last.
    last: usize,
}

impl Device {
    /// A buffer of `bytes` bytes, at least 16, that is written again and again. Until the first write it holds zeros.
    ///
    /// # Errors
    /// No memory, or more than a uniform or storage block of this device can hold.
    pub fn dynamic_buffer(&self, usage: BufferUsage, bytes: u64) -> Result<DynamicBuffer, Error> {
        let flags = flags_of(&self.gpu, usage, bytes)?;
        let bytes = bytes.max(16);
        let mut first = copy(&self.gpu, flags, bytes)?;
        first.clear()?;
        let copies = Mutex::new(Copies { all: vec![Arc::new(first)], last: 0 });
        Ok(DynamicBuffer(Arc::new(RawDynamicBuffer { gpu: self.gpu.clone(), flags, bytes, copies })))
    }
}

impl DynamicBuffer {
    /// Bytes that it holds.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.0.bytes
    }

    /// Gives it other contents, from its first byte on, for all draws and dispatches that are recorded from now on. What lies behind
    /// `contents` is undefined.
    ///
    /// # Errors
    /// [`Error::BadResource`] if it holds less; no memory for another copy.
    pub fn write(&self, contents: &[u8]) -> Result<(), Error> {
        self.0.write(contents)
    }

    /// The copy that was written last, to be bound as vertices or indices. As long as the program keeps it, it isn't written.
    #[must_use]
    pub fn current(&self) -> Buffer {
        Buffer(self.0.current())
    }
}

impl RawDynamicBuffer {
    /// Whether this device made it.
    pub(crate) fn is_of(&self, gpu: &Gpu) -> bool {
        std::ptr::eq(Arc::as_ptr(&self.gpu), gpu)
    }

    /// The copy that was written last.
    pub(crate) fn current(&self) -> Arc<RawBuffer> {
        let copies = self.copies.lock().unwrap_or_else(PoisonError::into_inner);
        copies.all[copies.last].clone()
    }

    fn write(&self, contents: &[u8]) -> Result<(), Error> {
        if contents.len() as u64 > self.bytes {
            let (given, bytes) = (contents.len(), self.bytes);
            let what = format!("{given} bytes were written to a dynamic buffer, which holds {bytes}");
            return Err(Error::BadResource { what });
        }
        let mut copies = self.copies.lock().unwrap_or_else(PoisonError::into_inner);
        // In turns, so that several buffers come to the same choices of copies again, for which bind groups have sets.
        let (number, last) = (copies.all.len(), copies.last);
        let mut in_turns = (1..=number).map(|step| (last + step) % number);
        let free = in_turns.find(|at| Arc::get_mut(&mut copies.all[*at]).is_some());
        let at = match free {
            Some(at) => at,
            None => {
                copies.all.push(Arc::new(copy(&self.gpu, self.flags, self.bytes)?));
                copies.all.len() - 1
            }
        };
        copies.last = at;
        // Only references under the lock are added, so the copy is still nobody else's.
        Arc::get_mut(&mut copies.all[at]).map_or(Ok(()), |copy| copy.fill(contents))
    }
}

/// A copy with undefined contents.
fn copy(gpu: &Arc<Gpu>, flags: vk::BufferUsageFlags, bytes: u64) -> Result<RawBuffer, Error> {
    RawBuffer::shared(gpu, "dynamic buffer", bytes, flags, MemoryUse::Upload)
}
