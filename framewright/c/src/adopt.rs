//! Devices that the program made itself.

use crate::arguments::{FramewrightNames, Structure, free, handle, list, reference, structure};
use crate::device::{FramewrightDevice, helper_of};
use crate::last_error::{call, text};
use crate::status::{FramewrightStatus, Problem};
use framewright::Device;
use framewright::vulkan::ash::{self, vk};
use framewright::vulkan::{AdoptedDevice, DeviceFeatures, Error};
use std::ffi::{CStr, CString, c_char};
use std::ptr;

/// A queue that the library may use.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightQueue {
    /// Its family.
    pub family: u32,
    /// The queue.
    pub queue: vk::Queue,
}

/// A device that the program made itself, and what it was made with. The instance has Vulkan 1.3 as its `apiVersion`, and comes from the
/// system's loader.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightAdoptedDevice {
    /// sizeof(FramewrightAdoptedDevice).
    pub struct_size: usize,
    /// The instance.
    pub instance: vk::Instance,
    /// The extensions that it was created with.
    pub instance_extensions: FramewrightNames,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: vk::Device,
    /// The extensions that it was created with.
    pub device_extensions: FramewrightNames,
    /// The features that it was created with, as they were chained to its creation. What is missing is named by the error.
    pub features: *const vk::PhysicalDeviceFeatures2<'static>,
    /// Queues that the library may use, of which one does graphics and compute. While a call of the library draws, uploads or reads back,
    /// no other thread submits to them.
    pub queues: *const FramewrightQueue,
    /// How many there are.
    pub queue_count: usize,
    /// As in FramewrightDeviceOptions.
    pub helper: *const c_char,
}

// SAFETY: it begins with its size, and has integers, pointers and Vulkan's handles alone.
unsafe impl Structure for FramewrightAdoptedDevice {
    const NAME: &'static str = "FramewrightAdoptedDevice";
    const DEFAULT: Self = FramewrightAdoptedDevice {
        struct_size: 0,
        instance: vk::Instance::null(),
        instance_extensions: FramewrightNames::NONE,
        physical_device: vk::PhysicalDevice::null(),
        device: vk::Device::null(),
        device_extensions: FramewrightNames::NONE,
        features: ptr::null(),
        queues: ptr::null(),
        queue_count: 0,
        helper: ptr::null(),
    };
}

/// Uses a device that the program made itself. The library destroys what it makes from it, and neither device nor instance: they outlive
/// all that is made from the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_device_adopt(
    program: *const FramewrightAdoptedDevice,
    device: *mut *mut FramewrightDevice,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        handle(device, "device", || {
            reference(program, "program")?;
            adopt(&structure(program, "program")?)
        })
    })
}

/// # Safety
/// That of [`Device::adopt`], and the fields are as they say.
unsafe fn adopt(program: &FramewrightAdoptedDevice) -> Result<FramewrightDevice, Problem> {
    let is_null = |null: bool, what: &str| is_null(null, &format!("`{what}` of `program`"));
    is_null(program.instance == vk::Instance::null(), "instance")?;
    is_null(program.physical_device == vk::PhysicalDevice::null(), "physical_device")?;
    is_null(program.device == vk::Device::null(), "device")?;
    // SAFETY: the caller's word.
    let queues = unsafe { list(program.queues, program.queue_count, "queues")? };
    if let Some(number) = queues.iter().position(|queue| queue.queue == vk::Queue::null()) {
        return Err(Problem::Misuse(format!("`queues[{number}].queue` of `program` is NULL")));
    }
    // SAFETY: the system's loader is trusted; the handles and lists are the caller's word.
    unsafe {
        let instance = of_loader(program.instance)?;
        let device = ash::Device::load(instance.fp_v1_0(), program.device);
        let of_instance = names(&program.instance_extensions, "instance_extensions")?;
        let of_device = names(&program.device_extensions, "device_extensions")?;
        let helper = helper_of(program.helper)?;
        let program = AdoptedDevice {
            instance: &instance,
            instance_extensions: &of_instance.iter().map(CString::as_c_str).collect::<Vec<&CStr>>(),
            physical: program.physical_device,
            device: &device,
            device_extensions: &of_device.iter().map(CString::as_c_str).collect::<Vec<&CStr>>(),
            features: reference(program.features, "features")?,
            queues: &queues.iter().map(|queue| (queue.family, queue.queue)).collect::<Vec<_>>(),
            allocator: None,
        };
        Ok(FramewrightDevice::new(Device::adopt(&program, helper.clone())?, helper))
    }
}

/// Opens a device of a program's physical device, to find out what the program makes its own device with: renderers on it tell what their
/// frames use, `framewright_renderer_device_features`. It has every feature that is used, as far as the physical device has them. The
/// instance has Vulkan 1.3 as its `apiVersion`, comes from the system's loader, and outlives all that is made from the handle.
/// `instance_extensions` are those that it was created with; NULL: none. `helper` is as in FramewrightDeviceOptions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_device_open_physical(
    instance: vk::Instance,
    instance_extensions: *const FramewrightNames,
    physical_device: vk::PhysicalDevice,
    helper: *const c_char,
    device: *mut *mut FramewrightDevice,
) -> FramewrightStatus {
    let open = || {
        is_null(instance == vk::Instance::null(), "`instance`")?;
        is_null(physical_device == vk::PhysicalDevice::null(), "`physical_device`")?;
        // SAFETY: the system's loader is trusted; the handles and lists are the caller's word.
        unsafe {
            let instance = of_loader(instance)?;
            let extensions = instance_extensions.as_ref().unwrap_or(&FramewrightNames::NONE);
            let extensions = names(extensions, "instance_extensions")?;
            let extensions: Vec<&CStr> = extensions.iter().map(CString::as_c_str).collect();
            let helper = helper_of(helper)?;
            let device = Device::open_physical(&instance, &extensions, physical_device, helper.clone())?;
            Ok(FramewrightDevice::new(device, helper))
        }
    };
    // SAFETY: the caller's word.
    call(|| unsafe { handle(device, "device", open) })
}

/// An instance of the system's loader.
///
/// # Safety
/// The loader is trusted, and the instance is one of its.
unsafe fn of_loader(instance: vk::Instance) -> Result<ash::Instance, Error> {
    // SAFETY: the caller's word.
    unsafe {
        let entry = ash::Entry::load().map_err(|error| Error::NoLoader { reason: error.to_string() })?;
        Ok(ash::Instance::load(entry.static_fn(), instance))
    }
}

fn is_null(null: bool, what: &str) -> Result<(), Problem> {
    if null { Err(Problem::Misuse(format!("{what} is NULL"))) } else { Ok(()) }
}

/// Features and extensions for a device that the program makes, and has the library use.
pub struct FramewrightFeatures {
    /// What the chain leads to, out of a box, which isn't moved any more.
    features: *mut DeviceFeatures,
    chain: vk::PhysicalDeviceFeatures2<'static>,
    extensions: Vec<*const c_char>,
}

impl FramewrightFeatures {
    pub(crate) fn new(features: DeviceFeatures) -> FramewrightFeatures {
        let extensions = features.extensions().iter().map(|name| name.as_ptr()).collect();
        let features = Box::into_raw(Box::new(features));
        // SAFETY: what the chain leads to stays where it is, and lives as long: both are freed together.
        let chain = unsafe { (*features).chain() };
        FramewrightFeatures { features, chain, extensions }
    }
}

impl Drop for FramewrightFeatures {
    fn drop(&mut self) {
        // SAFETY: it comes from a box. The program has freed the handle, so it no longer uses the chain.
        drop(unsafe { Box::from_raw(self.features) });
    }
}

/// Tells with which features and extensions the program makes a device that the library is to use: those that
/// `framewright_renderer_features` lists, or of several renderers all lists together. NULL: all that any renderer uses where the device has
/// it. It is an error if the device lacks any, or of the latter what the library needs everywhere. `robustBufferAccess` is among the latter
/// alone: add it where files or shaders of strangers are drawn. Freed by `framewright_features_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_features_open(
    instance: vk::Instance,
    physical_device: vk::PhysicalDevice,
    used: *const FramewrightNames,
    features: *mut *mut FramewrightFeatures,
) -> FramewrightStatus {
    let open = || {
        is_null(instance == vk::Instance::null(), "`instance`")?;
        is_null(physical_device == vk::PhysicalDevice::null(), "`physical_device`")?;
        // SAFETY: the system's loader is trusted; the handles and the list are the caller's word.
        let features = unsafe {
            let instance = of_loader(instance)?;
            match used.as_ref() {
                None => DeviceFeatures::of(&instance, physical_device)?,
                Some(used) => DeviceFeatures::exactly(&instance, physical_device, &used.texts("used")?)?,
            }
        };
        Ok(FramewrightFeatures::new(features))
    };
    // SAFETY: the caller's word.
    call(|| unsafe { handle(features, "features", open) })
}

/// The features, chained: for `VkDeviceCreateInfo.pNext` and `FramewrightAdoptedDevice.features`. It lives as long as the handle; NULL for
/// NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_features_chain(
    features: *const FramewrightFeatures,
) -> *const vk::PhysicalDeviceFeatures2<'static> {
    // SAFETY: the caller's word.
    unsafe { features.as_ref() }.map_or(ptr::null(), |features| &raw const features.chain)
}

/// The extensions of the device, for `VkDeviceCreateInfo` and `FramewrightAdoptedDevice.device_extensions`. They live as long as the handle;
/// none for NULL. A program that presents adds `VK_KHR_swapchain`, if it isn't among them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_features_extensions(features: *const FramewrightFeatures) -> FramewrightNames {
    // SAFETY: the caller's word.
    unsafe { features.as_ref() }.map_or(FramewrightNames::NONE, |features| FramewrightNames {
        names: features.extensions.as_ptr(),
        count: features.extensions.len(),
    })
}

/// Frees the handle of features.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_features_free(features: *mut FramewrightFeatures) {
    // SAFETY: the caller's word.
    unsafe { free(features) };
}

/// # Safety
/// They are as the fields say.
unsafe fn names(names: &FramewrightNames, what: &str) -> Result<Vec<CString>, Problem> {
    // SAFETY: the caller's word.
    Ok(unsafe { names.texts(what)? }.into_iter().map(text).collect())
}
