//! Calls of `vkCmdPipelineBarrier`, counted on their way to the driver.
//!
//! vk-graph calls the driver while it finds barriers. So that its own work can be told from the driver's, and because nothing
//! else tells of its barriers, it gets a Vulkan loader that answers with [`count`] where it asks for this function.

use ash::vk;
use std::ffi::{CStr, c_char};
use std::mem::transmute;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

/// The end of a counted call.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Driver {
    /// It is passed on.
    Called,
    /// It ends here.
    Skipped,
}

const COUNTED: &CStr = c"vkCmdPipelineBarrier";

static LOADER: OnceLock<ash::Entry> = OnceLock::new();
static GET_DEVICE_PROC_ADDR: OnceLock<vk::PFN_vkGetDeviceProcAddr> = OnceLock::new();
static CMD_PIPELINE_BARRIER: OnceLock<vk::PFN_vkCmdPipelineBarrier> = OnceLock::new();
static SKIPPED: AtomicBool = AtomicBool::new(false);
static CALLS: AtomicU64 = AtomicU64::new(0);
static IMAGES: AtomicU64 = AtomicU64::new(0);

/// The system's Vulkan loader, and calls counted.
pub(super) fn loader() -> Result<ash::Entry, String> {
    if LOADER.get().is_none() {
        // SAFETY: The loader is kept until the process ends.
        let _ = LOADER.set(unsafe { ash::Entry::load() }.map_err(|error| error.to_string())?);
    }
    // SAFETY: `get_instance_proc_addr` answers as the loader does, but for functions of the same type.
    Ok(unsafe { ash::Entry::from_static_fn(ash::StaticFn { get_instance_proc_addr }) })
}

/// Counts from nothing.
pub(super) fn begin(driver: Driver) {
    SKIPPED.store(driver == Driver::Skipped, Relaxed);
    CALLS.store(0, Relaxed);
    IMAGES.store(0, Relaxed);
}

/// Calls since `begin`, and image barriers in them.
pub(super) fn counted() -> (u64, u64) {
    (CALLS.load(Relaxed), IMAGES.load(Relaxed))
}

unsafe extern "system" fn get_instance_proc_addr(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let loader = LOADER.get()?.static_fn();
    // SAFETY: The caller's arguments are passed on.
    let found = unsafe { (loader.get_instance_proc_addr)(instance, name) }?;
    // SAFETY: Vulkan's names are strings that end with a zero.
    if unsafe { CStr::from_ptr(name) } != c"vkGetDeviceProcAddr" {
        return Some(found);
    }
    // SAFETY: This is the type of the function of this name.
    let original = unsafe { transmute::<unsafe extern "system" fn(), vk::PFN_vkGetDeviceProcAddr>(found) };
    GET_DEVICE_PROC_ADDR.get_or_init(|| original);
    // SAFETY: A function of the same type takes its place.
    Some(unsafe { transmute::<vk::PFN_vkGetDeviceProcAddr, unsafe extern "system" fn()>(get_device_proc_addr) })
}

unsafe extern "system" fn get_device_proc_addr(device: vk::Device, name: *const c_char) -> vk::PFN_vkVoidFunction {
    // SAFETY: The caller's arguments are passed on.
    let found = unsafe { GET_DEVICE_PROC_ADDR.get()?(device, name) }?;
    // SAFETY: Vulkan's names are strings that end with a zero.
    if unsafe { CStr::from_ptr(name) } != COUNTED {
        return Some(found);
    }
    // SAFETY: This is the type of the function of this name.
    let original = unsafe { transmute::<unsafe extern "system" fn(), vk::PFN_vkCmdPipelineBarrier>(found) };
    CMD_PIPELINE_BARRIER.get_or_init(|| original);
    // SAFETY: A function of the same type takes its place.
    Some(unsafe { transmute::<vk::PFN_vkCmdPipelineBarrier, unsafe extern "system" fn()>(count) })
}

#[allow(clippy::too_many_arguments, reason = "these are the arguments of vkCmdPipelineBarrier")]
unsafe extern "system" fn count(
    commands: vk::CommandBuffer,
    before: vk::PipelineStageFlags,
    after: vk::PipelineStageFlags,
    flags: vk::DependencyFlags,
    memory_count: u32,
    memory: *const vk::MemoryBarrier<'_>,
    buffer_count: u32,
    buffers: *const vk::BufferMemoryBarrier<'_>,
    image_count: u32,
    images: *const vk::ImageMemoryBarrier<'_>,
) {
    CALLS.fetch_add(1, Relaxed);
    IMAGES.fetch_add(u64::from(image_count), Relaxed);
    if let (false, Some(original)) = (SKIPPED.load(Relaxed), CMD_PIPELINE_BARRIER.get()) {
        // SAFETY: The caller's arguments are passed on.
        unsafe {
            original(commands, before, after, flags, memory_count, memory, buffer_count, buffers, image_count, images)
        }
    }
}
