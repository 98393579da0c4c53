//! Devices that the program made itself.

use crate::arguments::{FramewrightNames, Structure, handle, list, reference, structure};
use crate::device::{FramewrightDevice, helper_of};
use crate::last_error::{call, text};
use crate::status::{FramewrightStatus, Problem};
use framewright::Device;
use framewright::vulkan::ash::{self, vk};
use framewright::vulkan::{AdoptedDevice, Error};
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
    let is_null = |null: bool, what: &str| match null {
        true => Err(Problem::Misuse(format!("`{what}` of `program` is NULL"))),
        false => Ok(()),
    };
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
        let entry = ash::Entry::load().map_err(|error| Error::NoLoader { reason: error.to_string() })?;
        let instance = ash::Instance::load(entry.static_fn(), program.instance);
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

/// # Safety
/// They are as the fields say.
unsafe fn names(names: &FramewrightNames, what: &str) -> Result<Vec<CString>, Problem> {
    // SAFETY: the caller's word.
    Ok(unsafe { names.texts(what)? }.into_iter().map(text).collect())
}
