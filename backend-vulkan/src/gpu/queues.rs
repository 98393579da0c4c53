//! Which of a device's queues a Plan's queues are.

use crate::base::Error;
use ash::vk;
use framewright_graph::plan::Queue;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The families that a Plan's queues come from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct QueueFamilies {
    /// Graphics, compute and transfer.
    pub(crate) graphics: QueueFamily,
    /// Compute without graphics.
    pub(crate) compute: Option<QueueFamily>,
    /// Transfer without either.
    pub(crate) transfer: Option<QueueFamily>,
    /// The index of each of them once, rising.
    pub(crate) indices: Vec<u32>,
}

/// A queue family.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct QueueFamily {
    pub(crate) index: u32,
    pub(crate) flags: vk::QueueFlags,
    /// Bits of its timestamps that count; 0 if it has none.
    pub(crate) timestamp_bits: u32,
}

impl QueueFamilies {
    /// The families of `physical`; `None` if none does graphics and compute.
    pub(crate) fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<QueueFamilies> {
        QueueFamilies::chosen(families(instance, physical))
    }

    /// Those among some of its families.
    pub(super) fn among(
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        given: &[u32],
    ) -> Option<QueueFamilies> {
        let families = families(instance, physical).into_iter();
        QueueFamilies::chosen(families.filter(|family| given.contains(&family.index)).collect())
    }

    fn chosen(families: Vec<QueueFamily>) -> Option<QueueFamilies> {
        let find = |wanted: vk::QueueFlags, unwanted: vk::QueueFlags| {
            families.iter().find(|it| it.flags.contains(wanted) && !it.flags.intersects(unwanted)).copied()
        };
        use vk::QueueFlags as Does;
        let graphics = find(Does::GRAPHICS | Does::COMPUTE, Does::empty())?;
        let compute = find(Does::COMPUTE, Does::GRAPHICS);
        let transfer = find(Does::TRANSFER, Does::GRAPHICS | Does::COMPUTE);
        let mut indices: Vec<u32> =
            [Some(graphics), compute, transfer].into_iter().flatten().map(|family| family.index).collect();
        indices.sort_unstable();
        Some(QueueFamilies { graphics, compute, transfer, indices })
    }

    /// The family of a Plan's queue: a device without it uses the first.
    pub(crate) fn family(&self, queue: Queue) -> QueueFamily {
        match queue {
            Queue::Graphics => self.graphics,
            Queue::Compute => self.compute.unwrap_or(self.graphics),
            Queue::Transfer => self.transfer.unwrap_or(self.graphics),
        }
    }
}

/// All families of `physical`.
fn families(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Vec<QueueFamily> {
    // SAFETY: `physical` belongs to `instance`.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    (0..)
        .zip(families)
        .map(|(index, it)| QueueFamily { index, flags: it.queue_flags, timestamp_bits: it.timestamp_valid_bits })
        .collect()
}

/// The opened queues: one of each family.
pub(crate) struct Queues {
    pub(crate) families: QueueFamilies,
    by_family: Mutex<Vec<(u32, vk::Queue)>>,
}

impl Queues {
    /// Queues of these families, at least one of each.
    pub(crate) fn new(families: QueueFamilies, by_family: Vec<(u32, vk::Queue)>) -> Queues {
        Queues { families, by_family: Mutex::new(by_family) }
    }

    /// All queues, for one thread at a time.
    pub(crate) fn lock(&self) -> LockedQueues<'_> {
        LockedQueues(self.by_family.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// The queues while one thread has them to itself.
pub(crate) struct LockedQueues<'q>(MutexGuard<'q, Vec<(u32, vk::Queue)>>);

impl LockedQueues<'_> {
    /// The queue of a family.
    pub(crate) fn of(&self, family: QueueFamily) -> Result<vk::Queue, Error> {
        let found = self.0.iter().find(|(index, _)| *index == family.index).map(|(_, queue)| *queue);
        found.ok_or(Error::Vulkan { doing: "looking for a queue", result: vk::Result::ERROR_UNKNOWN })
    }
}
