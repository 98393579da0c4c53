//! Foundation of the other modules: errors, Vulkan's enumerants, cancelling, files in the cache folder.

mod cache_files;
mod cancel;
pub(crate) mod convert;
mod error;

pub use cancel::end_process;
pub use error::{Blame, Error, INSTALL};

pub(crate) use cache_files::{cache_folder, path_variable, replace_file};
pub(crate) use cancel::{Cancel, SLICE};
pub(crate) use convert::Clear;
