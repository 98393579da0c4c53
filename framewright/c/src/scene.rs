//! Scenes.

use crate::arguments::{free, handle, text};
use crate::last_error::call;
use crate::status::FramewrightStatus;
use framewright::{Scene, load_scene};
use std::ffi::c_char;
use std::sync::Arc;

/// A scene in memory. Any thread may use it, and several at once.
pub struct FramewrightScene(pub(crate) Arc<Scene>);

/// Reads a scene from a file (`.ron`, `.gltf`, `.glb`); where there is none, the shipped scene of that name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_scene_load(
    path: *const c_char,
    scene: *mut *mut FramewrightScene,
) -> FramewrightStatus {
    // SAFETY: the caller's word.
    call(|| unsafe { handle(scene, "scene", || Ok(FramewrightScene(Arc::new(load_scene(text(path, "path")?)?)))) })
}

/// Frees the handle of a scene. Renderers that show it go on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn framewright_scene_free(scene: *mut FramewrightScene) {
    // SAFETY: the caller's word.
    unsafe { free(scene) };
}
