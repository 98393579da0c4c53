//! Framewright for programs in C and C++.
//!
//! `framewright.h` is made of this crate by cbindgen; a test holds that it is. Each function checks its arguments, turns errors and
//! panics into a [`FramewrightStatus`], and leaves the text to [`framewright_last_error`]. Handles are boxes of what the crate
//! `framewright` has.
//!
//! # Safety
//! The functions trust a caller in C with what the header says: pointers that are not NULL point to what their types say, handles come
//! from this library and aren't freed yet, and Vulkan's objects are as the Rust functions of the same names demand.
#![allow(clippy::missing_safety_doc, reason = "the rules for all functions stand above, and at the head of the header")]

mod adopt;
mod ahead;
mod arguments;
mod bind_groups;
mod callback;
mod device;
mod draw_calls;
mod draws;
mod frames;
mod images;
mod last_error;
mod options;
mod passes;
mod recorder;
mod renderer;
mod scene;
mod sets;
mod status;
mod texels;
mod version;
mod viewer;

pub use adopt::{
    FramewrightAdoptedDevice, FramewrightFeatures, FramewrightQueue, framewright_device_adopt,
    framewright_device_open_physical, framewright_features_chain, framewright_features_extensions,
    framewright_features_free, framewright_features_open,
};
pub use ahead::{framewright_renderer_clone, framewright_renderer_interface, framewright_renderer_make_pipelines};
pub use arguments::FramewrightNames;
pub use bind_groups::{
    FramewrightBindGroup, FramewrightBinding, framewright_bind_group_free, framewright_bind_group_open,
};
pub use device::{
    FramewrightDeadImage, FramewrightDevice, FramewrightDeviceOptions, FramewrightFinding, FramewrightVulkan,
    framewright_device_canary, framewright_device_dead_images, framewright_device_findings, framewright_device_free,
    framewright_device_name, framewright_device_open, framewright_device_vulkan,
};
pub use draw_calls::{
    framewright_pass_bind_group, framewright_pass_bind_index_buffer, framewright_pass_bind_set,
    framewright_pass_bind_vertex_buffer, framewright_pass_draw, framewright_pass_draw_indexed,
    framewright_pass_push_constants, framewright_pass_set_cull_mode, framewright_pass_set_front_face,
    framewright_pass_set_scissor, framewright_pass_set_viewport,
};
pub use draws::{
    FramewrightAttribute, FramewrightDrawInterface, FramewrightResourceKind, FramewrightSuppliedResource,
    FramewrightVertexBuffer,
};
pub use frames::{
    FramewrightChoice, FramewrightSemaphore, FramewrightSubmission, framewright_renderer_discard,
    framewright_renderer_frame, framewright_renderer_prepare, framewright_renderer_record_into,
    framewright_renderer_run_all, framewright_renderer_set_dirty, framewright_renderer_set_frame_number,
    framewright_renderer_set_time, framewright_renderer_submit, framewright_renderer_wait,
};
pub use images::{
    FramewrightOwner, FramewrightState, framewright_renderer_image, framewright_renderer_image_info,
    framewright_renderer_import_buffers, framewright_renderer_import_images, framewright_renderer_set_owner,
    framewright_renderer_states,
};
pub use last_error::{FramewrightMistake, framewright_last_error, framewright_last_mistake};
pub use options::{FramewrightFile, FramewrightRendererOptions};
pub use passes::{
    FramewrightDraw, FramewrightEye, FramewrightEyeForm, FramewrightEyeTarget, FramewrightFormats, FramewrightPass,
    FramewrightPassImage, FramewrightRecord, FramewrightResources, framewright_pass_buffer, framewright_pass_image,
    framewright_pass_param,
};
pub use recorder::{
    framewright_renderer_both_eyes, framewright_renderer_formats, framewright_renderer_inheritance,
    framewright_renderer_set_recorder, framewright_renderer_set_secondary,
};
pub use renderer::{
    FramewrightChange, FramewrightFacts, FramewrightFeature, FramewrightRenderer, FramewrightRotation,
    FramewrightStereo, framewright_renderer_bind_set, framewright_renderer_device_features,
    framewright_renderer_features, framewright_renderer_files_changed, framewright_renderer_free,
    framewright_renderer_open, framewright_renderer_open_carried, framewright_renderer_reload,
    framewright_renderer_set, framewright_renderer_set_dump, framewright_renderer_set_extent,
    framewright_renderer_set_facts, framewright_renderer_set_output_format, framewright_renderer_set_preset,
    framewright_renderer_set_rotation, framewright_renderer_set_scene, framewright_renderer_set_stereo,
};
pub use scene::{FramewrightScene, framewright_scene_free, framewright_scene_load, framewright_scene_mistake};
pub use sets::FramewrightSet;
pub use status::FramewrightStatus;
pub use texels::{FramewrightTexels, framewright_renderer_read};
pub use version::{FRAMEWRIGHT_ABI, framewright_abi, framewright_version};
pub use viewer::{
    FramewrightViewer, framewright_viewer_frame, framewright_viewer_free, framewright_viewer_serve,
    framewright_viewer_url,
};
