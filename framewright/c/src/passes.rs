//! Custom passes, which the program records.

use crate::arguments::{output, reference, text};
use crate::last_error::{self, call};
use crate::renderer::{FramewrightRenderer, with};
use crate::status::{FramewrightStatus, Problem};
use framewright::vulkan::Error;
use framewright::vulkan::ash::vk;
use framewright::{CustomRecorder, Recorder, SecondaryRecorder};
use std::ffi::{c_char, c_void};
use std::ptr;

/// A custom pass that is to be recorded. It lives until its callback returns.
#[repr(C)]
pub struct FramewrightPass<'p> {
    /// The name of the pass.
    pub name: *const c_char,
    /// What the pipeline calls its work: the name behind `custom`.
    pub custom: *const c_char,
    /// Where it is recorded. Its barriers are there already.
    pub commands: vk::CommandBuffer,
    /// Whether it stands inside a rendering scope with the pass's targets, which is left open; else it stands outside of one.
    pub in_scope: u32,
    /// Width of the targets; 0 outside of a scope.
    pub width: u32,
    /// Height of the targets; 0 outside of a scope.
    pub height: u32,
    /// The number of the frame, as `framewright_renderer_frame` returns it.
    pub frame: u64,
    /// Leads `framewright_pass_image` and `framewright_pass_buffer` to what the pass accesses.
    pub resources: *const FramewrightResources<'p>,
    /// The queue family that the commands are for: that for graphics, or that for compute if the pipeline says `queue: Any`.
    pub queue_family: u32,
    /// What secondary command buffers are begun with, beside `RENDER_PASS_CONTINUE`, for a pass that `framewright_renderer_set_secondary` says
    /// has them: then `commands` takes `vkCmdExecuteCommands` and nothing else. NULL for other passes.
    pub inheritance: *const vk::CommandBufferInheritanceRenderingInfo<'p>,
}

/// What a pass outside of a rendering scope accesses.
pub struct FramewrightResources<'p>(&'p CustomRecorder<'p>);

/// Records a custom pass: commands that touch what the pipeline says that the pass touches, and what is the program's own. Returns 0 if it
/// doesn't know the pass, which is an error of the frame. No function is called for the renderer meanwhile, and no
/// exception or longjmp leaves it.
pub type FramewrightRecord =
    Option<unsafe extern "C" fn(context: *mut c_void, pass: *const FramewrightPass<'_>) -> u32>;

/// An image that a pass accesses.
#[repr(C)]
pub struct FramewrightPassImage {
    /// Vulkan's image.
    pub image: vk::Image,
    /// The part that the pass may touch.
    pub range: vk::ImageSubresourceRange,
    /// Width in texels of its first mip level, as much as is in use.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Depth in texels: 1, but for a volume.
    pub depth: u32,
    /// The layout that it is in, and is left in.
    pub layout: vk::ImageLayout,
}

/// The program's callback, and what it is given.
#[derive(Clone, Copy)]
pub(crate) struct Callback {
    pub(crate) record: unsafe extern "C" fn(*mut c_void, *const FramewrightPass<'_>) -> u32,
    pub(crate) context: *mut c_void,
}

impl Callback {
    /// Has the program record what stands inside a rendering scope.
    pub(crate) fn inside(&self, recorder: &mut Recorder<'_>) -> Result<u32, Error> {
        let (name, custom) = (recorder.pass().to_owned(), recorder.shader().to_owned());
        let ([width, height], frame) = (recorder.target_extent(), recorder.frame());
        let queue_family = recorder.queue_family();
        let commands = recorder.raw();
        let pass = |name, custom| FramewrightPass {
            name,
            custom,
            commands,
            in_scope: 1,
            width,
            height,
            frame,
            resources: ptr::null(),
            queue_family,
            inheritance: ptr::null(),
        };
        self.call(&name, &custom, pass).map(|()| 1)
    }

    /// Has the program execute its secondary command buffers inside a rendering scope.
    pub(crate) fn secondary(&self, custom: &str, recorder: &mut SecondaryRecorder<'_>) -> Result<u32, Error> {
        let commands = recorder.raw();
        let ([width, height], frame) = (recorder.target_extent(), recorder.frame());
        let (queue_family, inheritance) = (recorder.queue_family(), recorder.inheritance());
        let pass = |name, custom| FramewrightPass {
            name,
            custom,
            commands,
            in_scope: 1,
            width,
            height,
            frame,
            resources: ptr::null(),
            queue_family,
            inheritance: &raw const inheritance,
        };
        self.call(recorder.pass(), custom, pass).map(|()| 1)
    }

    /// Has the program record what stands outside of rendering scopes.
    pub(crate) fn outside(&self, custom: &str, recorder: &mut CustomRecorder<'_>) -> Result<(), Error> {
        let commands = recorder.raw();
        let (queue_family, frame) = (recorder.queue_family(), recorder.frame());
        let resources = FramewrightResources(recorder);
        let pass = |name, custom| FramewrightPass {
            name,
            custom,
            commands,
            in_scope: 0,
            width: 0,
            height: 0,
            frame,
            resources: &resources,
            queue_family,
            inheritance: ptr::null(),
        };
        self.call(recorder.pass(), custom, pass)
    }

    fn call<'p>(
        &self,
        name: &str,
        custom: &str,
        pass: impl FnOnce(*const c_char, *const c_char) -> FramewrightPass<'p>,
    ) -> Result<(), Error> {
        let (name_of_c, custom_of_c) = (last_error::text(name), last_error::text(custom));
        let pass = pass(name_of_c.as_ptr(), custom_of_c.as_ptr());
        // SAFETY: the program's word: it takes a pass and what was given with it.
        match unsafe { (self.record)(self.context, &raw const pass) } {
            0 => Err(Error::DrawSource {
                what: format!("the program doesn't record `{custom}`, which pass `{name}` asks for"),
            }),
            _ => Ok(()),
        }
    }
}

/// # Safety
/// The pointer is NULL or leads to a pass whose callback hasn't returned.
unsafe fn recorder<'p>(pass: *const FramewrightPass<'p>) -> Result<&'p CustomRecorder<'p>, Problem> {
    // SAFETY: the caller's word.
    let resources = unsafe { reference(pass, "pass")?.resources.as_ref() };
    let resources = resources.ok_or_else(|| Problem::Misuse("the pass stands inside a rendering scope".to_owned()))?;
    Ok(resources.0)
}

/// Tells an image that a pass outside of a rendering scope accesses, by the pipeline's name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_image(
    pass: *const FramewrightPass<'_>,
    name: *const c_char,
    image: *mut FramewrightPassImage,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        let name = text(name, "name")?;
        let found = recorder(pass)?.image(name);
        let found = found.ok_or_else(|| Problem::Misuse(format!("the pass accesses no image `{name}`")))?;
        let [width, height, depth] = found.extent;
        let range = vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::from_raw(found.range.aspects.bits()),
            base_mip_level: found.range.base_mip,
            level_count: found.range.mips,
            base_array_layer: found.range.base_layer,
            layer_count: found.range.layers,
        };
        let found = FramewrightPassImage { image: found.raw, range, width, height, depth, layout: found.layout };
        output(image, "image", found)
    })
}

/// Tells a buffer that a pass outside of a rendering scope accesses, by the pipeline's name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_pass_buffer(
    pass: *const FramewrightPass<'_>,
    name: *const c_char,
    buffer: *mut vk::Buffer,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        let name = text(name, "name")?;
        let found = recorder(pass)?.buffer(name);
        output(buffer, "buffer", found.ok_or_else(|| Problem::Misuse(format!("the pass accesses no buffer `{name}`")))?)
    })
}

/// Has `record` record custom passes, and gives it `context`; NULL: nobody does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_recorder(
    renderer: *mut FramewrightRenderer,
    record: FramewrightRecord,
    context: *mut c_void,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            state.callback = record.map(|record| Callback { record, context });
            Ok(())
        })
    }
}

/// Says whether the draws of the custom passes that the pipeline calls `custom`, inside rendering scopes, come in secondary command buffers,
/// which threads of the program record: 0, as at first, or 1. Custom passes outside of scopes execute such ones without a word.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_set_secondary(
    renderer: *mut FramewrightRenderer,
    custom: *const c_char,
    has: u32,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let custom = text(custom, "custom")?;
            match has {
                0 => state.secondary.remove(custom),
                _ => state.secondary.insert(custom.to_owned()),
            };
            Ok(())
        })
    }
}

/// Tells what secondary command buffers of the pass of this name are begun with, before the frame: as `inheritance` of the pass. It begins
/// with a plan, as a frame does. The formats that it leads to live until this function is called again for the renderer, or it is freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_inheritance(
    renderer: *mut FramewrightRenderer,
    pass: *const c_char,
    inheritance: *mut vk::CommandBufferInheritanceRenderingInfo<'_>,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let pass = text(pass, "pass")?;
            let formats = state.executor()?.formats(pass);
            let none = || Problem::Misuse(format!("no rendering scope has a pass `{pass}`"));
            let kept = state.inherited.insert(Box::new(formats.ok_or_else(none)?));
            // Its formats lie on the heap, where they stay until others take their place.
            output(inheritance.cast(), "inheritance", kept.inheritance())
        })
    }
}
