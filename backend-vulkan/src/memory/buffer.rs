//! Buffers and their memory.

use super::block::{MemoryBlock, MemoryUse};
use crate::base::{Error, convert};
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::device::BufferDescriptor;
use framewright_graph::vulkan::Sharing;
use std::sync::Arc;

/// A buffer bound to memory. The memory lives at least as long.
pub(crate) struct RawBuffer {
    gpu: Arc<Gpu>,
    pub(crate) raw: vk::Buffer,
    memory: BackingMemory,
    pub(crate) bytes: u64,
    pub(crate) usage: vk::BufferUsageFlags,
}

/// The owner of a buffer's memory.
enum BackingMemory {
    /// The buffer's own.
    Own(MemoryBlock),
    /// That of several buffers, kept by each of them.
    Heap { _memory: Arc<MemoryBlock> },
    /// Buffer and memory belong to somebody else.
    Foreign,
}

/// How a buffer of this description is created: the one place that knows, so that memory needs are those of the buffer.
/// Its size is rounded up to whole words, since fills write words. `families` are all that may use a shared buffer.
pub(crate) fn create_info<'f>(descriptor: &BufferDescriptor, families: &'f [u32]) -> vk::BufferCreateInfo<'f> {
    let info = vk::BufferCreateInfo::default()
        .size(descriptor.bytes.checked_next_multiple_of(4).unwrap_or(descriptor.bytes))
        .usage(convert::buffer_usage(descriptor.usage));
    if descriptor.sharing == Sharing::Concurrent { sharing(info, families) } else { info }
}

/// With several queue families, a buffer that all of them may use at any time.
fn sharing<'f>(info: vk::BufferCreateInfo<'f>, families: &'f [u32]) -> vk::BufferCreateInfo<'f> {
    if families.len() > 1 {
        info.sharing_mode(vk::SharingMode::CONCURRENT).queue_family_indices(families)
    } else {
        info
    }
}

/// Memory requirements of a buffer that is created so.
pub(crate) fn needs(gpu: &Gpu, info: &vk::BufferCreateInfo<'_>) -> vk::MemoryRequirements {
    let info = vk::DeviceBufferMemoryRequirements::default().create_info(info);
    let mut needs = vk::MemoryRequirements2::default();
    // SAFETY: maintenance4 is on, and both structures outlive the call.
    unsafe { gpu.raw.get_device_buffer_memory_requirements(&info, &mut needs) };
    needs.memory_requirements
}

impl RawBuffer {
    /// A buffer of `bytes` bytes, more than zero, with memory of its own.
    pub(crate) fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        kind: MemoryUse,
    ) -> Result<RawBuffer, Error> {
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        RawBuffer::with_own_memory(gpu, name, &info, bytes, kind)
    }

    /// As [`RawBuffer::new`], for the shaders of all queues at once.
    pub(crate) fn shared(
        gpu: &Arc<Gpu>,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        kind: MemoryUse,
    ) -> Result<RawBuffer, Error> {
        let info = vk::BufferCreateInfo::default().size(bytes).usage(usage);
        let info = sharing(info, &gpu.queues.families.indices);
        RawBuffer::with_own_memory(gpu, name, &info, bytes, kind)
    }

    /// A buffer of a Plan, with memory of its own.
    pub(crate) fn persistent(gpu: &Arc<Gpu>, name: &str, descriptor: &BufferDescriptor) -> Result<RawBuffer, Error> {
        let info = create_info(descriptor, &gpu.queues.families.indices);
        RawBuffer::with_own_memory(gpu, name, &info, descriptor.bytes, MemoryUse::Buffers)
    }

    /// A buffer of a Plan at `offset` of `memory`, which must be large enough and of a type that fits.
    pub(crate) fn placed(
        gpu: &Arc<Gpu>,
        name: &str,
        descriptor: &BufferDescriptor,
        memory: Arc<MemoryBlock>,
        offset: u64,
    ) -> Result<RawBuffer, Error> {
        let info = create_info(descriptor, &gpu.queues.families.indices);
        let (block, begin) = memory.place();
        let owner = BackingMemory::Heap { _memory: memory };
        RawBuffer::bound(gpu, name, &info, descriptor.bytes, owner, (block, begin + offset))
    }

    /// Somebody else's buffer of this description.
    ///
    /// # Safety
    /// It must have been made by the same device and live as long as this.
    pub(crate) unsafe fn foreign(gpu: &Arc<Gpu>, descriptor: &BufferDescriptor, raw: vk::Buffer) -> RawBuffer {
        let usage = convert::buffer_usage(descriptor.usage);
        RawBuffer { gpu: gpu.clone(), raw, memory: BackingMemory::Foreign, bytes: descriptor.bytes, usage }
    }

    fn with_own_memory(
        gpu: &Arc<Gpu>,
        name: &str,
        info: &vk::BufferCreateInfo<'_>,
        bytes: u64,
        kind: MemoryUse,
    ) -> Result<RawBuffer, Error> {
        let memory = MemoryBlock::new(gpu, name, needs(gpu, info), kind)?;
        let place = memory.place();
        RawBuffer::bound(gpu, name, info, bytes, BackingMemory::Own(memory), place)
    }

    fn bound(
        gpu: &Arc<Gpu>,
        name: &str,
        info: &vk::BufferCreateInfo<'_>,
        bytes: u64,
        memory: BackingMemory,
        (block, offset): (vk::DeviceMemory, u64),
    ) -> Result<RawBuffer, Error> {
        // SAFETY: the device lives and the size isn't zero.
        let raw = unsafe { gpu.raw.create_buffer(info, None) }.map_err(Error::vulkan("creating a buffer"))?;
        let buffer = RawBuffer { gpu: gpu.clone(), raw, memory, bytes, usage: info.usage };
        // SAFETY: the buffer is new; size, alignment and type of the memory are those of its requirements, or were checked
        // against them when it was placed.
        unsafe { gpu.raw.bind_buffer_memory(raw, block, offset) }
            .map_err(Error::vulkan("binding a buffer to memory"))?;
        gpu.name(raw, name);
        Ok(buffer)
    }

    /// Whether this device made it.
    pub(crate) fn is_of(&self, gpu: &Gpu) -> bool {
        std::ptr::eq(Arc::as_ptr(&self.gpu), gpu)
    }

    /// Whether it belongs to somebody else.
    pub(crate) fn is_foreign(&self) -> bool {
        matches!(self.memory, BackingMemory::Foreign)
    }

    /// Writes the beginning of the buffer.
    pub(crate) fn fill(&mut self, contents: &[u8]) -> Result<(), Error> {
        let bytes = contents.len();
        let target = match &mut self.memory {
            BackingMemory::Own(memory) => memory.bytes_mut().get_mut(..bytes),
            BackingMemory::Heap { .. } | BackingMemory::Foreign => None,
        };
        target.ok_or_else(|| invisible("a buffer that the host can write", bytes))?.copy_from_slice(contents);
        Ok(())
    }

    /// Writes zeros all over.
    pub(crate) fn clear(&mut self) -> Result<(), Error> {
        match &mut self.memory {
            BackingMemory::Own(memory) => memory.bytes_mut().fill(0),
            BackingMemory::Heap { .. } | BackingMemory::Foreign => {
                return Err(invisible("a buffer that the host can write", 0));
            }
        }
        Ok(())
    }

    /// The first `bytes` bytes.
    pub(crate) fn contents(&self, bytes: usize) -> Result<&[u8], Error> {
        let contents = match &self.memory {
            BackingMemory::Own(memory) => memory.bytes().get(..bytes),
            BackingMemory::Heap { .. } | BackingMemory::Foreign => None,
        };
        contents.ok_or_else(|| invisible("a buffer that the host can read", bytes))
    }
}

fn invisible(what: &str, bytes: usize) -> Error {
    let reason = "the memory isn't visible to the host".to_owned();
    Error::OutOfMemory { what: what.to_owned(), bytes: bytes as u64, parts: Vec::new(), reason }
}

impl Drop for RawBuffer {
    fn drop(&mut self) {
        if !self.is_foreign() && !self.gpu.is_abandoned() {
            // SAFETY: the owner of the buffer waits for the device before dropping it. Its memory is freed after it.
            unsafe { self.gpu.raw.destroy_buffer(self.raw, None) };
        }
    }
}
