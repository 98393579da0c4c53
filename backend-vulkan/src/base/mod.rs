//! Foundation of the other modules: errors, Vulkan's enumerants, cancelling, the cache folder, the operating system.

mod broken_promise;
mod cache;
mod cancel;
mod code;
pub(crate) mod convert;
mod debug_words;
mod error;
mod kept_files;
mod platform;
mod shader_stage;
mod span;

pub use broken_promise::BrokenPromise;
pub use cache::{Cache, CachedFiles};
pub use error::{Blame, Error, INSTALL};
pub use platform::end_process;

pub(crate) use cache::{identity_of, path_variable, read_file, replace_file};
pub(crate) use cancel::{Cancel, SLICE};
pub(crate) use convert::Clear;
pub(crate) use debug_words::{by, named, numbers};
pub(crate) use kept_files::{bytes_in, digest, shrink, used_now};
pub(crate) use platform::{
    ChildInput, apart_from_interrupts, end_with_children, in_words, is_crash, limit_this_process, loaded_library,
    start_with_input, take_standard_output, with_usual_rights,
};
pub(crate) use shader_stage::{ShaderStage, StageFacts, stage_flags};
pub(crate) use span::span;
