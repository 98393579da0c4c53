//! Devices that the library opens.

use crate::arguments::{Structure, free, handle, optional_text, output, reference, structure};
use crate::last_error::{call, text};
use crate::status::{FramewrightStatus, Problem};
use framewright::vulkan::ash::vk;
use framewright::vulkan::{DeadImages, DeviceChoice, helper::Limits};
use framewright::{BufferBounds, Device, DeviceOptions, Helper};
use std::ffi::{CString, c_char, c_void};
use std::ptr;
use std::sync::OnceLock;

/// A device. Any thread may use it, and several at once. It closes when it and all that was made from it are freed.
pub struct FramewrightDevice {
    pub(crate) device: Device,
    /// The process that compiles the shaders of its renderers.
    pub(crate) helper: Option<Helper>,
    name: CString,
    /// The images that died, once the program has asked for them.
    dead: OnceLock<DeadImages>,
}

/// How to open a device. 0 in a field is its default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightDeviceOptions {
    /// sizeof(FramewrightDeviceOptions).
    pub struct_size: usize,
    /// Its name, or a part of it or of its driver's name; NULL: lavapipe, or where there is none, the first device that will do.
    pub name: *const c_char,
    /// Whether the validation layer watches: see `framewright_device_findings`.
    pub validation: u32,
    /// A program whose `main` calls `helper::serve`, such as the command `framewright`: shaders are compiled and drivers tested in
    /// it, and can't end this one. NULL: in this process, which is for shaders and drivers that are trusted.
    pub helper: *const c_char,
    /// Whether the device leaves draws and shaders unchecked: `robustBufferAccess` is off. Then no index of a draw, an indirect draw or a
    /// shader may reach beyond its buffer: for programs that draw files and shaders of their own alone. 0: it keeps them within.
    pub unchecked_bounds: u32,
}

// SAFETY: it begins with its size, and has integers and pointers alone.
unsafe impl Structure for FramewrightDeviceOptions {
    const NAME: &'static str = "FramewrightDeviceOptions";
    const DEFAULT: Self = FramewrightDeviceOptions {
        struct_size: 0,
        name: ptr::null(),
        validation: 0,
        helper: ptr::null(),
        unchecked_bounds: 0,
    };
}

/// Is told a finding of the validation layer, which lives until it returns: the layer's words, behind the step and pass where the layer
/// knows them.
pub type FramewrightFinding = Option<unsafe extern "C" fn(context: *mut c_void, text: *const c_char)>;

/// Is told an image of the library's that died.
pub type FramewrightDeadImage = Option<unsafe extern "C" fn(context: *mut c_void, image: vk::Image)>;

impl FramewrightDevice {
    pub(crate) fn new(device: Device, helper: Option<Helper>) -> FramewrightDevice {
        FramewrightDevice { name: text(&device.summary().name), device, helper, dead: OnceLock::new() }
    }
}

/// The helper process that a program asks for.
///
/// # Safety
/// The pointer is NULL or leads to a text.
pub(crate) unsafe fn helper_of(program: *const c_char) -> Result<Option<Helper>, Problem> {
    // SAFETY: the caller's word.
    let program = unsafe { optional_text(program, "helper")? };
    Ok(program.map(|program| Helper::program(program, Limits::default())))
}

/// Opens a device of the library's own. `options` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_device_open(
    options: *const FramewrightDeviceOptions,
    device: *mut *mut FramewrightDevice,
) -> FramewrightStatus {
    let open = || {
        // SAFETY: the caller's word.
        let (options, name, helper) = unsafe {
            let options = structure(options, "options")?;
            (options, optional_text(options.name, "name")?, helper_of(options.helper)?)
        };
        let choice = name.map_or(DeviceChoice::Default, |name| DeviceChoice::Name(name.to_owned()));
        let validation = options.validation != 0;
        let bounds = match options.unchecked_bounds {
            0 => BufferBounds::CHECKED,
            // SAFETY: the caller's word.
            _ => unsafe { BufferBounds::unchecked() },
        };
        let options = DeviceOptions { choice, validation, helper: helper.clone(), bounds, display: None };
        let device = Device::open(&options)?;
        Ok(FramewrightDevice::new(device, helper))
    };
    // SAFETY: the caller's word.
    call(|| unsafe { handle(device, "device", open) })
}

/// The device's name, which lives as long as the handle; NULL for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_device_name(device: *const FramewrightDevice) -> *const c_char {
    // SAFETY: the caller's word.
    unsafe { device.as_ref() }.map_or(ptr::null(), |device| device.name.as_ptr())
}

/// Vulkan's handles of a device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightVulkan {
    /// The instance.
    pub instance: vk::Instance,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: vk::Device,
    /// The queue family that frames are for. Of a device of the library's its queue number 0 is used.
    pub queue_family: u32,
}

/// Tells Vulkan's handles of a device, for buffers, images and pipelines of the program's own. They live as long as the device, and the program
/// destroys none of them. While a call of the library draws, uploads or reads back, no other thread submits to queues of the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_device_vulkan(
    device: *const FramewrightDevice,
    vulkan: *mut FramewrightVulkan,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        let device = &reference(device, "device")?.device;
        let (instance, physical_device) = device.raw_physical();
        let found = FramewrightVulkan {
            instance: instance.handle(),
            physical_device,
            device: device.raw().handle(),
            queue_family: device.graphics_queue_family(),
        };
        output(vulkan, "vulkan", found)
    })
}

/// Plants mistakes, and fails if the validation layer doesn't report them, or if settings in the environment keep it from reporting others.
/// What it plants is no finding.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_device_canary(device: *const FramewrightDevice) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| Ok(unsafe { reference(device, "device")? }.device.canary().map(drop)?))
}

/// Tells each finding of the validation layer so far, once however often the layer said it: none without `FramewrightDeviceOptions::validation`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_device_findings(
    device: *const FramewrightDevice,
    tell: FramewrightFinding,
    context: *mut c_void,
) -> FramewrightStatus {
    call(|| {
        // SAFETY: the caller's word.
        let device = unsafe { reference(device, "device")? };
        let tell = tell.ok_or_else(|| Problem::Misuse("`tell` is NULL".to_owned()))?;
        for (message, _) in device.device.messages().distinct().iter().filter(|(message, _)| message.is_finding()) {
            let message = text(&message.located());
            // SAFETY: the caller's word: it takes a text and what is given with it.
            unsafe { tell(context, message.as_ptr()) };
        }
        Ok(())
    })
}

/// Tells each image of the library's that was destroyed since the last call; the first call begins to look. A program that keeps views of
/// images that it was told, as by `framewright_pass_image`, destroys those views then: another image may have the same handle later.
/// It asks in the function that records the pass, before it looks up a view.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_device_dead_images(
    device: *const FramewrightDevice,
    tell: FramewrightDeadImage,
    context: *mut c_void,
) -> FramewrightStatus {
    call(|| {
        // SAFETY: the caller's word.
        let device = unsafe { reference(device, "device")? };
        let tell = tell.ok_or_else(|| Problem::Misuse("`tell` is NULL".to_owned()))?;
        for image in device.dead.get_or_init(|| device.device.follow_images()).take() {
            // SAFETY: the caller's word: it takes an image and what is given with it.
            unsafe { tell(context, image) };
        }
        Ok(())
    })
}

/// Frees the handle of a device. What was made from it keeps it open.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_device_free(device: *mut FramewrightDevice) {
    // SAFETY: the caller's word.
    unsafe { free(device) };
}
