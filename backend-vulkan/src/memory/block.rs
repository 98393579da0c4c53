//! Device memory: blocks out of gpu-allocator, and what images and buffers need.

use crate::base::Error;
use crate::gpu::Gpu;
use ash::vk;
use framewright_graph::base::amount;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use std::sync::Arc;

/// A block of memory, given back when dropped.
pub(crate) struct MemoryBlock {
    gpu: Arc<Gpu>,
    allocation: Option<Allocation>,
}

/// The purpose of memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MemoryUse {
    /// Images.
    Images,
    /// Buffers that the device alone uses.
    Buffers,
    /// A buffer that the host fills and the device reads.
    Upload,
    /// A buffer that the device fills and the host reads.
    Readback,
}

impl MemoryBlock {
    /// A block for `requirements`.
    pub(crate) fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        requirements: vk::MemoryRequirements,
        kind: MemoryUse,
    ) -> Result<MemoryBlock, Error> {
        let description = AllocationCreateDesc {
            name,
            requirements,
            location: match kind {
                MemoryUse::Images | MemoryUse::Buffers => MemoryLocation::GpuOnly,
                MemoryUse::Upload => MemoryLocation::CpuToGpu,
                MemoryUse::Readback => MemoryLocation::GpuToCpu,
            },
            linear: kind != MemoryUse::Images,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let failed = |reason: String| Error::OutOfMemory {
            what: name.to_owned(),
            bytes: requirements.size,
            parts: Vec::new(),
            reason,
        };
        // Software drivers promise any amount of memory, and the system ends the program when it is touched.
        let largest = gpu.largest_heap(requirements.memory_type_bits);
        if requirements.size > largest {
            return Err(failed(format!("the device has {} of such memory", amount::bytes(largest))));
        }
        let allocation = gpu.allocator().allocate(&description).map_err(|error| failed(error.to_string()))?;
        Ok(MemoryBlock { gpu: gpu.clone(), allocation: Some(allocation) })
    }

    /// Vulkan's memory object and the offset in it at which this block begins.
    pub(crate) fn place(&self) -> (vk::DeviceMemory, u64) {
        self.allocation.as_ref().map_or((vk::DeviceMemory::null(), 0), |allocation| {
            // SAFETY: the handle is used only to bind resources that are destroyed before this block is freed.
            (unsafe { allocation.memory() }, allocation.offset())
        })
    }

    /// The bytes, if the host can see them.
    pub(crate) fn bytes(&self) -> &[u8] {
        self.allocation.as_ref().and_then(Allocation::mapped_slice).unwrap_or(&[])
    }

    /// The bytes, to be written, if the host can see them.
    pub(crate) fn bytes_mut(&mut self) -> &mut [u8] {
        self.allocation.as_mut().and_then(Allocation::mapped_slice_mut).unwrap_or(&mut [])
    }
}

impl Drop for MemoryBlock {
    fn drop(&mut self) {
        if let Some(allocation) = self.allocation.take()
            && !self.gpu.is_abandoned()
        {
            // Freeing fails only for an allocation of another allocator.
            let _ = self.gpu.allocator().free(allocation);
        }
    }
}
