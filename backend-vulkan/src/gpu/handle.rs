//! The device handle: everything that is made from a device holds on to it.

use super::buffer_bounds::BufferBounds;
use super::cached_objects::Caches;
use super::dead_images::Followers;
use super::features::Features;
use super::instance::Instance;
use super::labels::are_shown;
use super::pipeline_cache::PipelineCache;
use super::queues::{QueueFamilies, Queues};
use super::summary::DeviceSummary;
use super::{minimum, portability};
use crate::base::{Cache, Cancel, Error, convert};
use ash::{ext, khr, vk};
use framewright_graph::vulkan::Format;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use std::ffi::CStr;
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// How long a device that was given up is waited for when its last user lets go of it.
const LAST_CHANCE_NANOSECONDS: u64 = 10_000_000_000;

/// An open device with its instance, queues and allocator.
pub(crate) struct Gpu {
    pub(crate) raw: ash::Device,
    pub(crate) physical: vk::PhysicalDevice,
    pub(crate) limits: vk::PhysicalDeviceLimits,
    /// The commands of `VK_EXT_debug_utils`, where a tool is there to show names and labels.
    pub(crate) labels: Option<ext::debug_utils::Device>,
    /// The commands of `VK_KHR_dynamic_rendering_local_read`, where the device has it.
    pub(crate) local_read: Option<khr::dynamic_rendering_local_read::Device>,
    /// The features that are switched on.
    pub(crate) features: Features,
    /// `maxMultiviewViewCount`: how many views a rendering scope can draw at once.
    pub(crate) max_views: u32,
    /// Whether images can be in the layout `PRESENT_SRC_KHR`.
    pub(crate) presents: bool,
    /// Whether images and buffers can have owners that aren't devices of Vulkan (`VK_EXT_queue_family_foreign`).
    pub(crate) takes_foreign: bool,
    pub(crate) queues: Queues,
    pub(crate) summary: DeviceSummary,
    pub(crate) caches: Caches,
    pub(crate) pipeline_cache: PipelineCache,
    allocator: ManuallyDrop<Arc<Mutex<Allocator>>>,
    /// Who wants to know of images that die.
    pub(crate) followers: Followers,
    abandoned: OnceLock<PendingWork>,
    /// Whether the program made the device itself, and destroys it.
    pub(crate) is_adopted: bool,
    /// Cancels waits for the device.
    pub(crate) cancel: Cancel,
    pub(crate) instance: ManuallyDrop<Instance>,
}

/// A device that was made, and what it was made with.
pub(super) struct CreatedDevice {
    pub(super) raw: ash::Device,
    /// The features that are switched on and used.
    pub(super) features: Features,
    /// Whether images can be in the layout `PRESENT_SRC_KHR`.
    pub(super) presents: bool,
    /// Whether images and buffers can have owners that aren't devices of Vulkan.
    pub(super) takes_foreign: bool,
    pub(super) families: QueueFamilies,
    /// At least one queue of each family.
    pub(super) queues: Vec<(u32, vk::Queue)>,
    /// Whether the program made the device itself, and destroys it.
    pub(super) is_adopted: bool,
    /// The allocator of its memory; `None`: it gets its own.
    pub(super) allocator: Option<Arc<Mutex<Allocator>>>,
}

/// Work that the device didn't finish in time: these timeline semaphores have not reached these values.
#[derive(Debug, Clone, Default)]
pub(crate) struct PendingWork {
    pub(crate) semaphores: Vec<vk::Semaphore>,
    pub(crate) values: Vec<u64>,
}

impl Gpu {
    /// Opens `physical`, a device of `instance` that lacks nothing of the minimum. `cache` keeps the driver's pipelines.
    pub(super) fn open(
        instance: Instance,
        physical: vk::PhysicalDevice,
        summary: DeviceSummary,
        bounds: BufferBounds,
        cache: Option<&Cache>,
    ) -> Result<Gpu, Error> {
        let families = QueueFamilies::of(&instance.raw, physical).ok_or(Error::NoDevice)?;
        let features = Features::used(Features::with_bounds(&instance.raw, physical, bounds), |_| true);
        let mut chained = features.copy();
        let queue = |family: &u32| vk::DeviceQueueCreateInfo::default().queue_family_index(*family);
        let queues: Vec<_> = families.indices.iter().map(|family| queue(family).queue_priorities(&[1.0])).collect();
        // Without swapchains there is no layout PRESENT_SRC_KHR.
        let names = [khr::swapchain::NAME, ext::queue_family_foreign::NAME];
        let [has_swapchains, takes_foreign] = minimum::has_extensions(&instance.raw, physical, names);
        let presents = instance.surfaces && has_swapchains;
        let mut subset = portability::subset(&instance.raw, physical);
        let extensions = [
            (presents, khr::swapchain::NAME),
            (takes_foreign, ext::queue_family_foreign::NAME),
            (subset.is_some(), khr::portability_subset::NAME),
        ];
        let extensions = extensions.into_iter().filter_map(|(there, name)| there.then_some(name));
        let extensions: Vec<_> = features.extensions().into_iter().chain(extensions).map(CStr::as_ptr).collect();
        let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&extensions);
        let mut chain = chained.chain();
        let mut info = info.push_next(&mut chain);
        if let Some(subset) = &mut subset {
            info = info.push_next(subset);
        }
        // SAFETY: `physical` belongs to the instance and has these features, extensions and queue families.
        let raw = unsafe { instance.raw.create_device(physical, &info, None) }
            .map_err(Error::vulkan("opening the device"))?;
        // SAFETY: the device was created with one queue of each of these families.
        let queue = |family: &u32| (*family, unsafe { raw.get_device_queue(*family, 0) });
        let queues = families.indices.iter().map(queue).collect();
        let made = CreatedDevice {
            raw,
            features,
            presents,
            takes_foreign,
            families,
            queues,
            is_adopted: false,
            allocator: None,
        };
        Gpu::of(instance, physical, summary, made, cache)
    }

    /// A device that was made, of an instance that it keeps.
    pub(super) fn of(
        instance: Instance,
        physical: vk::PhysicalDevice,
        summary: DeviceSummary,
        made: CreatedDevice,
        cache: Option<&Cache>,
    ) -> Result<Gpu, Error> {
        let CreatedDevice { raw, features, presents, takes_foreign, families, queues, is_adopted, allocator } = made;
        let max_views = minimum::max_views(&instance.raw, physical, &features);
        // SAFETY: `physical` belongs to the instance.
        let properties = unsafe { instance.raw.get_physical_device_properties(physical) };
        let made_of_device = || {
            let allocator =
                allocator.map_or_else(|| own_allocator(&instance.raw, physical, &raw, features.addresses()), Ok)?;
            Ok((allocator, PipelineCache::open(&raw, cache, &summary.identity)?))
        };
        let (allocator, pipeline_cache) = made_of_device().inspect_err(|_| {
            if !is_adopted {
                // SAFETY: nothing that was made from the device is left.
                unsafe { raw.destroy_device(None) };
            }
        })?;
        let local_read =
            features.local_read().then(|| khr::dynamic_rendering_local_read::Device::new(&instance.raw, &raw));
        let labels = are_shown(&instance, physical).then(|| ext::debug_utils::Device::new(&instance.raw, &raw));
        Ok(Gpu {
            physical,
            limits: properties.limits,
            labels,
            local_read,
            features,
            max_views,
            presents,
            takes_foreign,
            queues: Queues::new(families, queues),
            summary,
            caches: Caches::default(),
            pipeline_cache,
            allocator: ManuallyDrop::new(allocator),
            followers: Followers::default(),
            abandoned: OnceLock::new(),
            is_adopted,
            cancel: Cancel::default(),
            raw,
            instance: ManuallyDrop::new(instance),
        })
    }

    /// The allocator, for one thread at a time.
    pub(crate) fn allocator(&self) -> MutexGuard<'_, Allocator> {
        self.allocator.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes that the device didn't finish its work in time. It may still be using anything, so nothing is freed from now
    /// on.
    pub(crate) fn abandon(&self, unfinished: &PendingWork) {
        self.abandoned.get_or_init(|| unfinished.clone());
    }

    /// Whether things may still be in use although nobody waits for them.
    pub(crate) fn is_abandoned(&self) -> bool {
        self.abandoned.get().is_some()
    }

    /// Features of images of a format.
    pub(crate) fn format_features(&self, format: Format) -> vk::FormatFeatureFlags {
        let format = convert::format(format);
        // SAFETY: the physical device belongs to the instance.
        unsafe { self.instance.raw.get_physical_device_format_properties(self.physical, format) }
            .optimal_tiling_features
    }

    /// How rendering scopes can resolve depth and stencil.
    pub(crate) fn depth_stencil_resolve(&self) -> vk::PhysicalDeviceDepthStencilResolveProperties<'static> {
        let mut resolve = vk::PhysicalDeviceDepthStencilResolveProperties::default();
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut resolve);
        // SAFETY: the physical device belongs to the instance, and the chained structure outlives the call.
        unsafe { self.instance.raw.get_physical_device_properties2(self.physical, &mut all) };
        resolve.p_next = std::ptr::null_mut();
        resolve
    }

    /// Bytes of the largest heap behind the memory types `type_bits`.
    pub(crate) fn largest_heap(&self, type_bits: u32) -> u64 {
        let memory = self.memory_properties();
        let types = memory.memory_types_as_slice().iter().enumerate();
        let accepted = types.filter(|(number, _)| type_bits & (1 << number) != 0);
        accepted.map(|(_, ty)| memory.memory_heaps[ty.heap_index as usize].size).max().unwrap_or(0)
    }

    /// The bytes of all heaps together.
    pub(crate) fn all_heaps(&self) -> u64 {
        let memory = self.memory_properties();
        memory.memory_heaps_as_slice().iter().map(|heap| heap.size).fold(0, u64::saturating_add)
    }

    /// The memory types that are allocated lazily, one bit each.
    pub(crate) fn lazy_types(&self) -> u32 {
        let memory = self.memory_properties();
        let lazy = |ty: &vk::MemoryType| ty.property_flags.contains(vk::MemoryPropertyFlags::LAZILY_ALLOCATED);
        (0..).zip(memory.memory_types_as_slice()).filter(|(_, ty)| lazy(ty)).fold(0, |bits, (bit, _)| bits | 1 << bit)
    }

    fn memory_properties(&self) -> vk::PhysicalDeviceMemoryProperties {
        // SAFETY: the physical device belongs to the instance.
        unsafe { self.instance.raw.get_physical_device_memory_properties(self.physical) }
    }

    /// Whether waits are to be given up.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.cancel.is_asked()
    }
}

/// An allocator for the memory of a device. `addresses`: its buffers can have addresses.
fn own_allocator(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    device: &ash::Device,
    addresses: bool,
) -> Result<Arc<Mutex<Allocator>>, Error> {
    let allocator = Allocator::new(&AllocatorCreateDesc {
        instance: instance.clone(),
        device: device.clone(),
        physical_device: physical,
        debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
        // Memory of buffers that have addresses must say so when it is allocated.
        buffer_device_address: addresses,
        allocation_sizes: gpu_allocator::AllocationSizes::default(),
    });
    let failed = |error: gpu_allocator::AllocationError| Error::OutOfMemory {
        what: "the device".into(),
        bytes: 0,
        parts: Vec::new(),
        reason: error.to_string(),
    };
    Ok(Arc::new(Mutex::new(allocator.map_err(failed)?)))
}

impl Drop for Gpu {
    fn drop(&mut self) {
        if let Some(PendingWork { semaphores, values }) = self.abandoned.get() {
            if self.is_cancelled() || semaphores.is_empty() {
                return;
            }
            // A software driver's threads crash if the process ends under them: a device that is merely slow gets a chance.
            let wait = vk::SemaphoreWaitInfo::default().semaphores(semaphores).values(values);
            // SAFETY: neither semaphores nor device were destroyed. The result of the wait changes nothing.
            let _ = unsafe { self.raw.wait_semaphores(&wait, LAST_CHANCE_NANOSECONDS) };
            return;
        }
        // SAFETY: everything made from the device held on to it and is gone. The allocator frees its blocks before the
        // device closes, the device closes before its instance, and none of them is touched again.
        unsafe {
            self.caches.destroy(&self.raw);
            self.pipeline_cache.close(&self.raw);
            ManuallyDrop::drop(&mut self.allocator);
            if !self.is_adopted {
                self.raw.destroy_device(None);
            }
            ManuallyDrop::drop(&mut self.instance);
        }
    }
}
