//! Scenes.

use crate::arguments::{free, handle, text};
use crate::last_error::{self, call};
use crate::status::FramewrightStatus;
use framewright::{Scene, load_scene};
use std::ffi::{CString, c_char};
use std::ptr;
use std::sync::Arc;

/// A scene in memory. Any thread may use it, and several at once.
pub struct FramewrightScene {
    pub(crate) scene: Arc<Scene>,
    mistakes: Vec<CString>,
}

/// Reads a scene from a file (`.ron`, `.gltf`, `.glb`); where there is none, the shipped scene of that name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_scene_load(
    path: *const c_char,
    scene: *mut *mut FramewrightScene,
) -> FramewrightStatus {
    let load = || {
        // SAFETY: the caller's word.
        let scene = load_scene(unsafe { text(path, "path")? })?;
        let mistakes = scene.mistakes.iter().map(|mistake| last_error::text(mistake)).collect();
        Ok(FramewrightScene { scene: Arc::new(scene), mistakes })
    };
    // SAFETY: the caller's word.
    call(|| unsafe { handle(scene, "scene", load) })
}

/// The mistakes in the file of a scene that were passed over, by their numbers from 0, each with what was left out or changed; NULL behind
/// the last one, and for NULL. They live as long as the handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_scene_mistake(scene: *const FramewrightScene, number: usize) -> *const c_char {
    // SAFETY: the caller's word.
    let scene = unsafe { scene.as_ref() };
    scene.and_then(|scene| scene.mistakes.get(number)).map_or(ptr::null(), |mistake| mistake.as_ptr())
}

/// Frees the handle of a scene. Renderers that show it go on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_scene_free(scene: *mut FramewrightScene) {
    // SAFETY: the caller's word.
    unsafe { free(scene) };
}
