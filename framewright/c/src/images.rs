//! Images of the program's own.

use crate::arguments::{list, one_of, optional_output, output, text};
use crate::renderer::{FramewrightRenderer, with};
use crate::status::{FramewrightStatus, Problem};
use framewright::vulkan::ash::vk;
use framewright::vulkan::{OutsideOwner, ResourceState};
use std::ffi::c_char;

/// The state of an image or buffer: what used it last, or uses it next.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FramewrightState {
    /// Stages.
    pub stages: vk::PipelineStageFlags2,
    /// Accesses.
    pub accesses: vk::AccessFlags2,
    /// The layout; `VK_IMAGE_LAYOUT_UNDEFINED` for a buffer, and for an image whose contents the frame doesn't need.
    pub layout: vk::ImageLayout,
}

impl From<ResourceState> for FramewrightState {
    fn from(state: ResourceState) -> FramewrightState {
        FramewrightState { stages: state.stages, accesses: state.accesses, layout: state.layout }
    }
}

fn unknown(name: &str) -> Problem {
    Problem::Misuse(format!("there is no external image `{name}`"))
}

/// Tells how an image is created that can be imported for the external image `name`: an output, or one that the pipeline calls
/// `Imported`. It begins with a plan, as a frame does. What it points to lives as long as the device.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_image_info(
    renderer: *mut FramewrightRenderer,
    name: *const c_char,
    info: *mut vk::ImageCreateInfo<'static>,
) -> FramewrightStatus {
    // SAFETY: the caller's word. The lifetime is that of the device, as the header says.
    unsafe {
        with(renderer, |state| {
            let name = text(name, "name")?;
            let found = state.executor()?.image_info(name).ok_or_else(|| unknown(name))?;
            output(info.cast(), "info", found)
        })
    }
}

/// Tells the states in which each frame finds and leaves the external image or buffer `name`. `before` and `after` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_states(
    renderer: *mut FramewrightRenderer,
    name: *const c_char,
    before: *mut FramewrightState,
    after: *mut FramewrightState,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let name = text(name, "name")?;
            let found = state.executor()?.external_states(name).ok_or_else(|| unknown(name))?;
            optional_output(before, found.before.into());
            optional_output(after, found.after.into());
            Ok(())
        })
    }
}

/// Takes images of the program's own for the external image `name`, from the next frame on: one, or several, as those of a swapchain,
/// of which each frame uses the one that it is told. They are as `framewright_renderer_image_info` says, and are in the state that
/// `framewright_renderer_states` says whenever a frame begins. They live as long as the renderer, or until others are imported and
/// `framewright_renderer_wait` has waited for the last frame submitted before that import: nothing is waited for here. After
/// `FRAMEWRIGHT_CHANGE_PLAN` they are to be imported again: a frame is `FRAMEWRIGHT_STATUS_MISUSE` until they are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_import_images(
    renderer: *mut FramewrightRenderer,
    name: *const c_char,
    images: *const vk::Image,
    count: usize,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let (name, images) = (text(name, "name")?, list(images, count, "images")?);
            if images.contains(&vk::Image::null()) {
                return Err(Problem::Misuse("one of the `images` is NULL".to_owned()));
            }
            Ok(state.executor()?.import_images(name, images)?)
        })
    }
}

/// Takes buffers of the program's own for the external buffer `name`, from the next frame on. Frames use them in turn: the frame of number
/// `n` uses the one of number `n % count`, unless `FramewrightSubmission.images` chooses another one. All else is as for
/// `framewright_renderer_import_images`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_import_buffers(
    renderer: *mut FramewrightRenderer,
    name: *const c_char,
    buffers: *const vk::Buffer,
    count: usize,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let (name, buffers) = (text(name, "name")?, list(buffers, count, "buffers")?);
            if buffers.contains(&vk::Buffer::null()) {
                return Err(Problem::Misuse("one of the `buffers` is NULL".to_owned()));
            }
            Ok(state.executor()?.import_buffers(name, buffers)?)
        })
    }
}

/// Who else than this device has an image or buffer between frames.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FramewrightOwner {
    /// Nobody: the queues of the device.
    Device = 0,
    /// Another device of Vulkan, of the same driver (`VK_QUEUE_FAMILY_EXTERNAL`).
    External = 1,
    /// Anything else (`VK_QUEUE_FAMILY_FOREIGN_EXT`). The device must have `VK_EXT_queue_family_foreign` on.
    Foreign = 2,
}

/// Says who has the external image or buffer `name` between frames, a `FramewrightOwner`, in place of what the pipeline says. Each frame then
/// takes it over before its first use, in the state `before` of `framewright_renderer_states`, and gives it back in the state `after`. The owner
/// gives and takes it by barriers of its own. It holds by name, for later Plans too. Frames in flight are waited for.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_owner(
    renderer: *mut FramewrightRenderer,
    name: *const c_char,
    owner: u32,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let name = text(name, "name")?;
            let [external, foreign] = OutsideOwner::ALL.map(Some);
            let owners = [None, external, foreign];
            Ok(state.executor()?.set_owner(name, *one_of(&owners, owner, "owner")?)?)
        })
    }
}

/// Tells Vulkan's image that stood for the image `name` in the last frame, for commands of the program's own.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_image(
    renderer: *mut FramewrightRenderer,
    name: *const c_char,
    image: *mut vk::Image,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let name = text(name, "name")?;
            let found = state.renderer.executor().and_then(|executor| executor.raw_image(name));
            output(image, "image", found.ok_or_else(|| Problem::Misuse(format!("there is no image `{name}`")))?)
        })
    }
}
