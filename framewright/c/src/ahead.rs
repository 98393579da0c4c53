//! What is made or told before it is needed: other renderers, pipelines, and the file of draw interfaces.

use crate::arguments::{handle, output};
use crate::last_error::{call, text};
use crate::renderer::{FramewrightRenderer, State, locked, with};
use crate::status::FramewrightStatus;
use std::ffi::c_char;
use std::sync::Mutex;

/// Makes another renderer of the pipeline, with the choices, the scene and the names of `framewright_renderer_set_secondary` of this one. It reads the
/// files anew, has drawn nothing, and has no recorder. Choices can be tried with it on another thread, and `framewright_renderer_make_pipelines` called,
/// while this one draws.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_clone(
    renderer: *mut FramewrightRenderer,
    other: *mut *mut FramewrightRenderer,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe {
        handle(other, "other", || {
            let state = locked(renderer)?;
            let made = State::of(state.renderer.try_clone()?, state.draws.clone());
            let (scene, secondary) = (state.scene.clone(), state.secondary.clone());
            Ok(FramewrightRenderer(Mutex::new(State { scene, secondary, ..made })))
        })
    })
}

/// Makes all Vulkan pipelines that the next frame needs, on several threads. The device keeps them while there is a Plan, so that another renderer that
/// comes to the same choices finds them made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_make_pipelines(renderer: *mut FramewrightRenderer) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe { with(renderer, |state| Ok(state.renderer.make_pipelines()?)) }
}

/// Tells the text of a file with all that the program's draws bring along, its sets and its custom passes: `framewright check --interface` checks
/// pipelines with it. The text lives as long as the renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_renderer_interface(
    renderer: *mut FramewrightRenderer,
    ron: *mut *const c_char,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    unsafe {
        with(renderer, |state| {
            let told = state.interface.get_or_insert_with(|| text(&state.draws.interfaces.to_ron()));
            output(ron, "ron", told.as_ptr())
        })
    }
}
