//! The program's function that records passes is set, and what it needs is told before the frame.

use crate::arguments::{optional_output, output, text};
use crate::callback::Callback;
use crate::passes::{FramewrightEyeForm, FramewrightFormats, FramewrightRecord, both};
use crate::renderer::{FramewrightRenderer, State, with};
use crate::status::{FramewrightStatus, Problem};
use framewright::ScopeFormats;
use framewright::vulkan::ash::vk;
use std::ffi::{c_char, c_void};

/// Has `record` record custom passes, the kinds of draws in `FramewrightRendererOptions.draws`, and draws of objects and sky where no scene was set, and
/// gives it `context`; NULL: nobody does.
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
///
/// A secondary command buffer isn't recorded anew or freed until each frame was waited for that executes it. One that is executed again before
/// that, as by the next of several frames in flight or by the same pass of the other eye, is begun with `SIMULTANEOUS_USE`; or there are
/// several of it.
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

/// The formats of a pass of the next frame, which stand where they are as long as the renderer.
fn told<'s>(state: &'s mut State, pass: &str) -> Result<&'s ScopeFormats, Problem> {
    let none = || Problem::Misuse(format!("no rendering scope has a pass of the name `{pass}`"));
    let found = state.executor()?.formats(pass).ok_or_else(none)?;
    let known = state.formats.iter().position(|known| *known == found);
    let number = known.unwrap_or(state.formats.len());
    if known.is_none() {
        state.formats.push(found);
    }
    Ok(&state.formats[number])
}

/// Tells what pipelines must fit that the program binds itself in the pass of this name. It begins with a plan, as a frame does. What it
/// points to lives as long as the renderer. `FRAMEWRIGHT_STATUS_MISUSE`: no rendering scope has such a pass.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_formats(
    renderer: *mut FramewrightRenderer,
    pass: *const c_char,
    formats: *mut FramewrightFormats,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| output(formats, "formats", FramewrightFormats::of(told(state, text(pass, "pass")?)?)))
    }
}

/// Tells what secondary command buffers of the pass of this name are begun with, before the frame: as `inheritance` of the pass. All else is as
/// for `framewright_renderer_formats`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_inheritance(
    renderer: *mut FramewrightRenderer,
    pass: *const c_char,
    inheritance: *mut vk::CommandBufferInheritanceRenderingInfo<'_>,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            output(inheritance.cast(), "inheritance", told(state, text(pass, "pass")?)?.inheritance())
        })
    }
}

/// Tells how the pass of this name is recorded for both eyes at once: the FramewrightStereo, and how images hold both eyes' parts. Both are
/// 0 if it isn't. It begins with a plan, as a frame does. `form` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_both_eyes(
    renderer: *mut FramewrightRenderer,
    pass: *const c_char,
    stereo: *mut u32,
    form: *mut FramewrightEyeForm,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let (found, form_of) = both(state.executor()?.both_eyes(text(pass, "pass")?));
            optional_output(form, form_of);
            output(stereo, "stereo", found)
        })
    }
}
