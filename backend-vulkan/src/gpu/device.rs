//! Choosing, opening and sharing a device.

use super::buffer_bounds::BufferBounds;
use super::dead_images::DeadImages;
use super::device_features::DeviceFeatures;
use super::handle::Gpu;
use super::instance::Instance;
use super::minimum::missing_of;
use super::pipeline_cache::PipelineCounts;
use super::summary::{DeviceChoice, DeviceSummary, choose, devices, summary};
use super::validation::Messages;
use crate::base::Error;
use crate::process::Helper;
use ash::vk;
use framewright_graph::device::{EVERY_PLAN_USES, Profile};
use raw_window_handle::RawDisplayHandle;
use std::ffi::CStr;
use std::sync::{Arc, OnceLock};

/// How to open a device.
#[derive(Debug, Clone, Default)]
pub struct DeviceOptions {
    /// The device to open.
    pub choice: DeviceChoice,
    /// Whether the validation layer watches, synchronisation included. See [`crate::layer`] for how it is found.
    pub validation: bool,
    /// The process in which the device is tested; `None`: this one. A driver that crashes in a test ends only the helper process. The
    /// helper keeps what it found for this version of the driver, and its pipelines.
    pub helper: Option<Helper>,
    /// Whether the device keeps draws and shaders within their buffers; by default it does.
    pub bounds: BufferBounds,
    /// The display whose windows pictures are shown in, for [`Device::surface`]; `None`: nothing is shown.
    pub display: Option<RawDisplayHandle>,
}

/// An open device. Clones share it; it closes when the last clone and the last thing made from it are gone.
#[derive(Clone)]
pub struct Device {
    pub(crate) gpu: Arc<Gpu>,
    /// The helper process that tests the device; `None`: this process does.
    pub(crate) helper: Option<Helper>,
    /// The results of the device's self-tests, once it was tested.
    pub(crate) tested: Arc<OnceLock<TestedDevice>>,
}

/// Capabilities of a device after its self-tests.
pub(crate) struct TestedDevice {
    /// The claimed profile, less what failed its test.
    pub(crate) profile: Profile,
    /// Features that the device claims and is used without, and why.
    pub(crate) used_without: Vec<String>,
}

impl Device {
    /// Every device that the loader finds.
    ///
    /// # Errors
    /// [`Error::NoLoader`], or [`Error::NoDevice`] if there is none.
    pub fn list() -> Result<Vec<DeviceSummary>, Error> {
        let instance = Instance::new(false, None)?;
        Ok(devices(&instance)?.into_iter().map(|(_, summary)| summary).collect())
    }

    /// Opens a device.
    ///
    /// # Errors
    /// No loader, no device, none of that name, less than the minimum, no validation layer.
    pub fn open(options: &DeviceOptions) -> Result<Device, Error> {
        let instance = Instance::new(options.validation, options.display)?;
        let (physical, summary) = choose(devices(&instance)?, &options.choice)?;
        if !summary.missing.is_empty() {
            return Err(Error::Lacking { device: summary.name, missing: summary.missing });
        }
        let helper = options.helper.clone();
        let gpu = Gpu::open(instance, physical, summary, options.bounds, helper.as_ref().and_then(Helper::cache))?;
        Ok(Device { gpu: Arc::new(gpu), helper, tested: Arc::default() })
    }

    /// Opens a device of a program's physical device, to find out what the program makes its own device with: Plans are made on it,
    /// [`Plan::features`](framewright_graph::plan::Plan::features) tells what they use, and [`DeviceFeatures::exactly`](crate::DeviceFeatures::exactly)
    /// makes the chain. It has every feature that is used, as far as the physical device has them. It may be closed before the program's own device
    /// is made. `instance_extensions` are those that the instance was created with.
    ///
    /// # Errors
    /// [`Error::Lacking`] if the physical device lacks what every Plan uses.
    ///
    /// # Safety
    /// `physical` belongs to `instance`, whose `apiVersion` is 1.3 or later, and which lives until everything made from the device is gone.
    pub unsafe fn open_physical(
        instance: &ash::Instance,
        instance_extensions: &[&CStr],
        physical: vk::PhysicalDevice,
        helper: Option<Helper>,
    ) -> Result<Device, Error> {
        let instance = Instance::adopted(instance.clone(), instance_extensions);
        let summary = summary(&instance, 0, physical);
        let missing = missing_of(&instance.raw, physical, |name| EVERY_PLAN_USES.contains(&name));
        if !missing.is_empty() {
            return Err(Error::Lacking { device: summary.name, missing });
        }
        let cache = helper.as_ref().and_then(Helper::cache);
        let gpu = Gpu::open(instance, physical, summary, BufferBounds::CHECKED, cache)?;
        Ok(Device { gpu: Arc::new(gpu), helper, tested: Arc::default() })
    }

    /// The name, properties and identity of the device.
    #[must_use]
    pub fn summary(&self) -> &DeviceSummary {
        &self.gpu.summary
    }

    /// Whether the device keeps draws and shaders within their buffers. Of an adopted device the program has said so.
    #[must_use]
    pub fn checks_bounds(&self) -> bool {
        self.gpu.features.bounds()
    }

    /// How many pipelines were made so far. They are made with an executor, by
    /// [`Executor::change`](crate::Executor::change) and by [`Device::make_pipelines`], and never by a frame.
    #[must_use]
    pub fn pipeline_counts(&self) -> PipelineCounts {
        self.gpu.pipeline_cache.counts()
    }

    /// Messages of the validation layer so far; empty without validation. The list stays readable after the device is gone,
    /// when it also holds what closing it brought up.
    #[must_use]
    pub fn messages(&self) -> Messages {
        self.gpu.instance.validation.as_ref().map_or_else(Messages::default, |it| it.messages.clone())
    }

    /// Vulkan's own device, for programs that record commands of their own. All its functions are unsafe; it must not be
    /// destroyed, nor used after the last clone of this device is gone.
    #[must_use]
    pub fn raw(&self) -> &ash::Device {
        &self.gpu.raw
    }

    /// Vulkan's own instance and physical device, under the rules of [`Device::raw`].
    #[must_use]
    pub fn raw_physical(&self) -> (&ash::Instance, vk::PhysicalDevice) {
        (&self.gpu.instance.raw, self.gpu.physical)
    }

    /// What a program makes a device of the same physical device with that has these features alone: see [`DeviceFeatures::exactly`].
    ///
    /// # Errors
    /// Those of [`DeviceFeatures::exactly`].
    pub fn exact_features(&self, names: &[&str]) -> Result<DeviceFeatures, Error> {
        let (instance, physical) = self.raw_physical();
        // SAFETY: the physical device belongs to the instance, which is one of Vulkan 1.3.
        unsafe { DeviceFeatures::exactly(instance, physical, names) }
    }

    /// The index of the queue family that frames are submitted to. Unless the device was adopted, its queue number 0 is used. Command
    /// buffers for [`Executor::record_into`](crate::Executor::record_into) are of this family.
    #[must_use]
    pub fn graphics_queue_family(&self) -> u32 {
        self.gpu.queues.families.graphics.index
    }

    /// Tells from now on which of its images died. Images that the program imported die by its own hand, and aren't told.
    #[must_use]
    pub fn follow_images(&self) -> DeadImages {
        self.gpu.followers.add()
    }

    /// Has every wait for this device end with [`Error::Cancelled`] soon after `asked` becomes true.
    /// It is asked about 20 times a second. Only the first call for a device counts.
    ///
    /// The device is given up, as after a timeout: it may go on working, and nothing that was made from it can be used any
    /// more. If the program ends before the device does, let it end by [`end_process`](crate::end_process).
    pub fn cancel_when(&self, asked: impl Fn() -> bool + Send + Sync + 'static) {
        self.gpu.cancel.when(asked);
    }
}
