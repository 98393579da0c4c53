//! Choosing, opening and sharing a device.

use crate::cancel::Cancel;
use crate::capabilities;
use crate::error::Error;
use crate::features::Features;
use crate::helper::Helper;
use crate::instance::Instance;
use crate::memory::LiveMemory;
use crate::queues::{Families, Queues};
use crate::self_tests::SelfTests;
use crate::validation::Messages;
use ash::{ext, khr, vk};
use framewright_graph::base::nearest;
use framewright_graph::device::{BufferDescriptor, ImageDescriptor, MemoryNeeds, Profile};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use std::ffi::{CStr, FromBytesUntilNulError};
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// How long a device that was given up is waited for when its last user lets go of it.
const LAST_CHANCE_NANOSECONDS: u64 = 10_000_000_000;

/// Which device to open.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// lavapipe, the software driver that gives the same picture on every machine; where it isn't installed, the first
    /// device that meets the minimum.
    #[default]
    Default,
    /// By its number in [`Device::list`].
    Index(usize),
    /// By name: the device's own, or else the first device in whose name or driver's name the text occurs. `lavapipe`
    /// is Mesa's software driver, which calls itself llvmpipe.
    Name(String),
}

/// How to open a device.
#[derive(Debug, Clone, Default)]
pub struct DeviceOptions {
    /// Which one.
    pub choice: DeviceChoice,
    /// Whether the validation layer watches, synchronisation included. See [`crate::layer`] for how it is found.
    pub validation: bool,
    /// Where it is tested; `None`: in this process. In a helper process a driver that crashes in a test ends no more than that,
    /// and what the tests find is kept for this version of the driver.
    pub helper: Option<Helper>,
}

/// A device that exists.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceSummary {
    /// Its number.
    pub index: usize,
    /// Its own name.
    pub name: String,
    /// Its driver's name and version.
    pub driver: String,
    /// `cpu`, `integrated`, `discrete`, `virtual` or `other`.
    pub kind: &'static str,
    /// Its Vulkan version.
    pub vulkan: String,
    /// Kinds of queues that it has: `graphics`, and beside it `compute` and `transfer`.
    pub queues: Vec<&'static str>,
    /// Whether passes can read what was drawn at their own position without leaving the rendering scope.
    pub local_read: bool,
    /// What it lacks of the minimum; empty if it can be opened.
    pub missing: Vec<String>,
    driver_id: vk::DriverId,
    /// All that tells it from other devices and its driver from other drivers and versions.
    pub(crate) identity: String,
}

/// An open device. Clones share it; it closes when the last clone and the last thing made from it are gone.
#[derive(Clone)]
pub struct Device {
    pub(crate) shared: Arc<Shared>,
}

/// What all that is made from a device holds on to.
pub(crate) struct Shared {
    pub(crate) raw: ash::Device,
    pub(crate) physical: vk::PhysicalDevice,
    pub(crate) limits: vk::PhysicalDeviceLimits,
    pub(crate) labels: Option<ext::debug_utils::Device>,
    /// The commands of `VK_KHR_dynamic_rendering_local_read`, where the device has it.
    pub(crate) local_read: Option<khr::dynamic_rendering_local_read::Device>,
    /// Whether shaders can see several cubes at once.
    pub(crate) cube_arrays: bool,
    /// How many views a rendering scope can draw at once, as it says.
    pub(crate) max_views: u32,
    /// Whether vertex shaders can choose their layer.
    pub(crate) vertex_layer: bool,
    /// Whether shaders have clip distances.
    pub(crate) clip_distances: bool,
    /// Whether images can be in the layout `PRESENT_SRC_KHR`.
    pub(crate) presents: bool,
    pub(crate) queues: Queues,
    pub(crate) summary: DeviceSummary,
    pub(crate) caches: crate::caches::Caches,
    allocator: ManuallyDrop<Mutex<Allocator>>,
    /// What its self-tests found, once they ran.
    self_tests: OnceLock<SelfTests>,
    /// Where they run, if not in this process.
    helper: Option<Helper>,
    abandoned: OnceLock<Unfinished>,
    /// What gives up waits for it.
    pub(crate) cancel: Cancel,
    pub(crate) instance: ManuallyDrop<Instance>,
}

/// Work that the device didn't finish in time: these timeline semaphores have not reached these values.
#[derive(Debug, Clone, Default)]
pub(crate) struct Unfinished {
    pub(crate) semaphores: Vec<vk::Semaphore>,
    pub(crate) values: Vec<u64>,
}

impl Device {
    /// Every device that the loader finds.
    ///
    /// # Errors
    /// [`Error::NoLoader`], or [`Error::NoDevice`] if there is none.
    pub fn list() -> Result<Vec<DeviceSummary>, Error> {
        let instance = Instance::new(false)?;
        Ok(devices(&instance)?.into_iter().map(|(_, summary)| summary).collect())
    }

    /// Opens a device.
    ///
    /// # Errors
    /// No loader, no device, none of that name, less than the minimum, no validation layer.
    pub fn open(options: &DeviceOptions) -> Result<Device, Error> {
        let instance = Instance::new(options.validation)?;
        let (physical, summary) = choose(devices(&instance)?, &options.choice)?;
        if !summary.missing.is_empty() {
            return Err(Error::Lacking { device: summary.name, missing: summary.missing });
        }
        let families = Families::of(&instance.raw, physical).ok_or(Error::NoDevice)?;
        let has_local_read = capabilities::has_local_read(&instance.raw, physical);
        let mut features = Features::used(&Features::of(&instance.raw, physical, false), has_local_read);
        let cube_arrays = features.cube_arrays();
        let max_views = capabilities::max_views(&instance.raw, physical, &features);
        let vertex_layer = features.vertex_layer();
        let clip_distances = features.clip_distances();
        let queue = |family: &u32| vk::DeviceQueueCreateInfo::default().queue_family_index(*family);
        let queues: Vec<_> = families.indices.iter().map(|family| queue(family).queue_priorities(&[1.0])).collect();
        // Without swapchains there is no layout PRESENT_SRC_KHR.
        let presents = instance.surfaces && capabilities::has_extension(&instance.raw, physical, khr::swapchain::NAME);
        let extensions: Vec<_> =
            [(has_local_read, khr::dynamic_rendering_local_read::NAME), (presents, khr::swapchain::NAME)]
                .into_iter()
                .filter_map(|(there, name)| there.then_some(name.as_ptr()))
                .collect();
        let info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&extensions);
        let info = features.chain(info);
        // SAFETY: `physical` belongs to the instance and has these features, extensions and queue families.
        let raw = unsafe { instance.raw.create_device(physical, &info, None) }
            .map_err(Error::vulkan("opening the device"))?;
        // SAFETY: `physical` belongs to the instance.
        let properties = unsafe { instance.raw.get_physical_device_properties(physical) };
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.raw.clone(),
            device: raw.clone(),
            physical_device: physical,
            debug_settings: gpu_allocator::AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: gpu_allocator::AllocationSizes::default(),
        });
        let allocator = match allocator {
            Ok(allocator) => allocator,
            Err(error) => {
                // SAFETY: nothing was made from the device yet.
                unsafe { raw.destroy_device(None) };
                return Err(Error::OutOfMemory {
                    what: "the device".into(),
                    bytes: 0,
                    parts: Vec::new(),
                    reason: error.to_string(),
                });
            }
        };
        let local_read = has_local_read.then(|| khr::dynamic_rendering_local_read::Device::new(&instance.raw, &raw));
        let labels = instance.labels.then(|| ext::debug_utils::Device::new(&instance.raw, &raw));
        let shared = Shared {
            physical,
            limits: properties.limits,
            labels,
            local_read,
            cube_arrays,
            max_views,
            vertex_layer,
            clip_distances,
            presents,
            queues: Queues::new(&raw, families),
            summary,
            caches: crate::caches::Caches::default(),
            allocator: ManuallyDrop::new(Mutex::new(allocator)),
            self_tests: OnceLock::new(),
            helper: options.helper.clone(),
            abandoned: OnceLock::new(),
            cancel: Cancel::default(),
            raw,
            instance: ManuallyDrop::new(instance),
        };
        Ok(Device { shared: Arc::new(shared) })
    }

    /// What the device can do, as far as Plans depend on it. The first time it is tried how the device resolves depth, and
    /// whether it draws several views at once, which takes small frames: in a helper process, if [`DeviceOptions::helper`] names
    /// one.
    #[must_use]
    pub fn profile(&self) -> Profile {
        let source = format!("read from {}, Vulkan {}", self.shared.summary.driver, self.shared.summary.vulkan);
        let SelfTests { depth_resolve, draws_views, draws_views_untested, .. } = self.self_tests();
        let mut profile =
            capabilities::profile(&self.shared, source, &mut self.memory(), depth_resolve.clone(), *draws_views);
        if *draws_views_untested {
            profile.untested_multiview = std::mem::take(&mut profile.refuted_multiview);
        }
        profile
    }

    /// What the device says it can do and is used without, and why: it failed the self-test, or the test gave no answer.
    /// The first time the device is tested.
    #[must_use]
    pub fn used_without(&self) -> Vec<String> {
        self.self_tests().used_without(self.shared.max_views >= 2)
    }

    fn self_tests(&self) -> &SelfTests {
        self.shared.self_tests.get_or_init(|| SelfTests::of(self, self.shared.helper.as_ref()))
    }

    /// Opens the device of this identity, for its self-tests.
    pub(crate) fn open_identified(identity: &str) -> Result<Device, Error> {
        let found = Device::list()?.into_iter().find(|device| device.identity == identity);
        let choice = DeviceChoice::Index(found.ok_or(Error::NoDevice)?.index);
        Device::open(&DeviceOptions { choice, ..DeviceOptions::default() })
    }

    /// What images and buffers take of this device's memory, for [`framewright_graph::compile`].
    #[must_use]
    pub fn memory(&self) -> LiveMemory {
        LiveMemory::new(self)
    }

    /// Which device this is.
    #[must_use]
    pub fn summary(&self) -> &DeviceSummary {
        &self.shared.summary
    }

    /// What the validation layer said so far; empty without validation. The list stays readable after the device is
    /// gone, when it also holds what closing it brought up.
    #[must_use]
    pub fn messages(&self) -> Messages {
        self.shared.instance.validation.as_ref().map_or_else(Messages::default, |it| it.messages.clone())
    }

    /// Vulkan's own device, for programs that record commands of their own. All its functions are unsafe; it must not be
    /// destroyed, nor used after the last clone of this device is gone.
    #[must_use]
    pub fn raw(&self) -> &ash::Device {
        &self.shared.raw
    }

    /// Vulkan's own instance and physical device, under the rules of [`Device::raw`].
    #[must_use]
    pub fn raw_physical(&self) -> (&ash::Instance, ash::vk::PhysicalDevice) {
        (&self.shared.instance.raw, self.shared.physical)
    }

    /// The validation layer that watches, in words.
    #[must_use]
    pub fn validation_layer(&self) -> Option<&str> {
        self.shared.instance.validation.as_ref().map(|it| it.layer.shown.as_str())
    }
}

impl Shared {
    /// The allocator, for one thread at a time.
    pub(crate) fn allocator(&self) -> MutexGuard<'_, Allocator> {
        self.allocator.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes that the device didn't finish its work in time. It may still be using anything, so nothing is freed from now
    /// on.
    pub(crate) fn abandon(&self, unfinished: Unfinished) {
        self.abandoned.get_or_init(|| unfinished);
    }

    /// Whether things may still be in use although nobody waits for them.
    pub(crate) fn is_abandoned(&self) -> bool {
        self.abandoned.get().is_some()
    }

    /// What an image of this description needs of memory.
    pub(crate) fn memory_needs(&self, descriptor: &ImageDescriptor) -> MemoryNeeds {
        let create = crate::image::create_info(descriptor, &self.queues.families.indices);
        let info = vk::DeviceImageMemoryRequirements::default().create_info(&create);
        let mut needs = vk::MemoryRequirements2::default();
        // SAFETY: maintenance4 is on, and both structures outlive the call.
        unsafe { self.raw.get_device_image_memory_requirements(&info, &mut needs) };
        memory_needs(needs.memory_requirements)
    }

    /// What a buffer of this description needs of memory.
    pub(crate) fn buffer_memory_needs(&self, descriptor: &BufferDescriptor) -> MemoryNeeds {
        memory_needs(crate::buffer::needs(self, &crate::buffer::create_info(descriptor, &self.queues.families.indices)))
    }
}

fn memory_needs(requirements: vk::MemoryRequirements) -> MemoryNeeds {
    let vk::MemoryRequirements { size, alignment, memory_type_bits } = requirements;
    MemoryNeeds { bytes: size, alignment, type_bits: memory_type_bits }
}

impl Drop for Shared {
    fn drop(&mut self) {
        if let Some(Unfinished { semaphores, values }) = self.abandoned.get() {
            if self.is_cancelled() {
                return;
            }
            // A software driver's threads crash if the process ends under them: a device that is merely slow gets a chance.
            let wait = vk::SemaphoreWaitInfo::default().semaphores(semaphores).values(values);
            // SAFETY: neither semaphores nor device were destroyed. Whatever comes of the wait, nothing more is done.
            let _ = unsafe { self.raw.wait_semaphores(&wait, LAST_CHANCE_NANOSECONDS) };
            return;
        }
        // SAFETY: everything made from the device held on to it and is gone. The allocator frees its blocks before the
        // device closes, the device closes before its instance, and none of them is touched again.
        unsafe {
            self.caches.destroy(&self.raw);
            ManuallyDrop::drop(&mut self.allocator);
            self.raw.destroy_device(None);
            ManuallyDrop::drop(&mut self.instance);
        }
    }
}

/// Every device with its summary, in the loader's order.
fn devices(instance: &Instance) -> Result<Vec<(vk::PhysicalDevice, DeviceSummary)>, Error> {
    // SAFETY: the instance lives.
    let found = unsafe { instance.raw.enumerate_physical_devices() }.map_err(Error::vulkan("listing devices"))?;
    if found.is_empty() {
        return Err(Error::NoDevice);
    }
    Ok((0..).zip(found).map(|(index, physical)| (physical, summary(instance, index, physical))).collect())
}

fn summary(instance: &Instance, index: usize, physical: vk::PhysicalDevice) -> DeviceSummary {
    // SAFETY: `physical` belongs to the instance.
    let properties = unsafe { instance.raw.get_physical_device_properties(physical) };
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut ids = vk::PhysicalDeviceIDProperties::default();
    if properties.api_version >= vk::API_VERSION_1_2 {
        let mut all = vk::PhysicalDeviceProperties2::default().push_next(&mut driver).push_next(&mut ids);
        // SAFETY: `physical` belongs to the instance, and the chained structures outlive the call.
        unsafe { instance.raw.get_physical_device_properties2(physical, &mut all) };
    }
    let families = Families::of(&instance.raw, physical);
    let more = families.as_ref().map(|it| (it.compute.is_some(), it.transfer.is_some())).unwrap_or_default();
    let queues = [("graphics", families.is_some()), ("compute", more.0), ("transfer", more.1)];
    let (driver_name, driver_info) = (text(driver.driver_name_as_c_str()), text(driver.driver_info_as_c_str()));
    let (name, driver_text) = (text(properties.device_name_as_c_str()), format!("{driver_name} {driver_info}"));
    let numbers = [properties.vendor_id, properties.device_id, properties.driver_version, properties.api_version];
    let (device_id, driver_uuid) = (u128::from_be_bytes(ids.device_uuid), u128::from_be_bytes(ids.driver_uuid));
    DeviceSummary {
        index,
        identity: format!("{name}; {driver_text}; {numbers:x?}; device {device_id:032x}; driver {driver_uuid:032x}"),
        name,
        driver: driver_text.trim().to_owned(),
        kind: match properties.device_type {
            vk::PhysicalDeviceType::CPU => "cpu",
            vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated",
            vk::PhysicalDeviceType::DISCRETE_GPU => "discrete",
            vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual",
            _ => "other",
        },
        vulkan: capabilities::version(properties.api_version),
        queues: queues.into_iter().filter(|(_, there)| *there).map(|(name, _)| name).collect(),
        local_read: properties.api_version >= capabilities::MINIMUM_VERSION
            && capabilities::has_local_read(&instance.raw, physical),
        missing: capabilities::missing(&instance.raw, physical),
        driver_id: driver.driver_id,
    }
}

/// The device that is asked for.
fn choose(
    devices: Vec<(vk::PhysicalDevice, DeviceSummary)>,
    choice: &DeviceChoice,
) -> Result<(vk::PhysicalDevice, DeviceSummary), Error> {
    let usable = |it: &DeviceSummary| it.missing.is_empty();
    let is_lavapipe = |it: &DeviceSummary| it.driver_id == vk::DriverId::MESA_LLVMPIPE;
    let position = |test: &dyn Fn(&DeviceSummary) -> bool| devices.iter().position(|(_, it)| test(it));
    let (at, wanted) = match choice {
        DeviceChoice::Default => {
            let found = position(&|it| is_lavapipe(it) && usable(it)).or_else(|| position(&usable));
            // Where none meets the minimum, the first one's lacks are told.
            (found.or(Some(0)), String::new())
        }
        DeviceChoice::Index(index) => ((*index < devices.len()).then_some(*index), format!("number {index}")),
        DeviceChoice::Name(name) => {
            let wanted = name.to_lowercase();
            let occurs = |it: &DeviceSummary| {
                it.name.to_lowercase().contains(&wanted)
                    || it.driver.to_lowercase().contains(&wanted)
                    || (wanted == "lavapipe" && is_lavapipe(it))
            };
            let found = position(&|it| it.name == *name);
            (found.or_else(|| position(&|it| !wanted.is_empty() && occurs(it))), format!("named {name}"))
        }
    };
    let known: Vec<String> = devices.iter().map(|(_, it)| format!("{}: {}", it.index, it.name)).collect();
    let near = match choice {
        DeviceChoice::Name(name) => near(name, &devices),
        _ => None,
    };
    at.and_then(|at| devices.into_iter().nth(at)).ok_or(Error::UnknownDevice { wanted, near, known })
}

/// The device one of whose name's words is nearly `wanted`.
fn near(wanted: &str, devices: &[(vk::PhysicalDevice, DeviceSummary)]) -> Option<String> {
    let words = || devices.iter().flat_map(|(_, it)| it.name.split_whitespace());
    let word = nearest(wanted, words())?;
    devices.iter().find(|(_, it)| it.name.split_whitespace().any(|found| found == word)).map(|(_, it)| it.name.clone())
}

/// A text of Vulkan's, as far as it is UTF-8.
pub(crate) fn text(text: Result<&CStr, FromBytesUntilNulError>) -> String {
    text.map_or_else(|_| String::new(), |text| text.to_string_lossy().into_owned())
}
