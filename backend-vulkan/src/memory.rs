//! Device memory: blocks out of gpu-allocator, and what images and buffers need.

use crate::device::{Device, Shared};
use crate::error::Error;
use ash::vk;
use framewright_graph::base::amount;
use framewright_graph::device::{BufferDescriptor, ImageDescriptor, MemoryNeeds, MemoryProvider};
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use std::sync::Arc;

/// The memory needs of a device that is here: exact.
pub struct LiveMemory {
    shared: Arc<Shared>,
}

impl LiveMemory {
    pub(crate) fn new(device: &Device) -> LiveMemory {
        LiveMemory { shared: device.shared.clone() }
    }
}

impl MemoryProvider for LiveMemory {
    fn exact(&self) -> bool {
        true
    }

    fn image(&mut self, descriptor: &ImageDescriptor) -> MemoryNeeds {
        if self.shared.can_make(descriptor) { self.shared.memory_needs(descriptor) } else { IMPOSSIBLE }
    }

    fn buffer(&mut self, descriptor: &BufferDescriptor) -> MemoryNeeds {
        if self.shared.can_make_buffer(descriptor) { self.shared.buffer_memory_needs(descriptor) } else { IMPOSSIBLE }
    }
}

/// Device memory that is in use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryInUse {
    /// Heaps, images and buffers in it.
    pub allocations: usize,
    /// Bytes that they take.
    pub bytes: u64,
    /// Bytes that were got from the device; what is free of them serves what comes next.
    pub reserved_bytes: u64,
}

impl Device {
    /// What is made from this device takes of its memory: executors, buffers, textures.
    #[must_use]
    pub fn memory_in_use(&self) -> MemoryInUse {
        let report = self.shared.allocator().generate_report();
        MemoryInUse {
            allocations: report.allocations.len(),
            bytes: report.total_allocated_bytes,
            reserved_bytes: report.total_capacity_bytes,
        }
    }
}

/// The needs of what the driver may not even be asked about: no memory is enough.
const IMPOSSIBLE: MemoryNeeds = MemoryNeeds { bytes: u64::MAX, alignment: 1, type_bits: u32::MAX };

/// A block of memory, given back when dropped.
pub(crate) struct Memory {
    shared: Arc<Shared>,
    allocation: Option<Allocation>,
}

/// What memory is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Images.
    Images,
    /// Buffers that the device alone uses.
    Buffers,
    /// A buffer that the host fills and the device reads.
    Upload,
    /// A buffer that the device fills and the host reads.
    Readback,
}

impl Memory {
    /// A block for `requirements`.
    pub(crate) fn new(
        shared: &Arc<Shared>,
        name: &str,
        requirements: vk::MemoryRequirements,
        kind: Kind,
    ) -> Result<Memory, Error> {
        let description = AllocationCreateDesc {
            name,
            requirements,
            location: match kind {
                Kind::Images | Kind::Buffers => MemoryLocation::GpuOnly,
                Kind::Upload => MemoryLocation::CpuToGpu,
                Kind::Readback => MemoryLocation::GpuToCpu,
            },
            linear: kind != Kind::Images,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let failed = |reason: String| Error::OutOfMemory {
            what: name.to_owned(),
            bytes: requirements.size,
            parts: Vec::new(),
            reason,
        };
        // Software drivers promise whatever they are asked for, and the system ends the program when it is touched.
        let largest = largest_heap(shared, requirements.memory_type_bits);
        if requirements.size > largest {
            return Err(failed(format!("the device has {} of such memory", amount::bytes(largest))));
        }
        let allocation = shared.allocator().allocate(&description).map_err(|error| failed(error.to_string()))?;
        Ok(Memory { shared: shared.clone(), allocation: Some(allocation) })
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

/// Bytes of the largest heap behind the memory types `type_bits`.
pub(crate) fn largest_heap(shared: &Shared, type_bits: u32) -> u64 {
    // SAFETY: `physical` belongs to the instance.
    let memory = unsafe { shared.instance.raw.get_physical_device_memory_properties(shared.physical) };
    let types = memory.memory_types_as_slice().iter().enumerate();
    let accepted = types.filter(|(number, _)| type_bits & (1 << number) != 0);
    accepted.map(|(_, ty)| memory.memory_heaps[ty.heap_index as usize].size).max().unwrap_or(0)
}

impl Drop for Memory {
    fn drop(&mut self) {
        if let Some(allocation) = self.allocation.take()
            && !self.shared.is_abandoned()
        {
            // Freeing fails only for an allocation of another allocator.
            let _ = self.shared.allocator().free(allocation);
        }
    }
}
