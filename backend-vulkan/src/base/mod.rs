//! Foundation of the other modules: errors, Vulkan's enumerants, cancelling, the cache folder.

mod cache;
mod cancel;
pub(crate) mod convert;
mod error;

pub use cache::{Cache, CachedFiles};
pub use cancel::end_process;
pub use error::{Blame, Error, INSTALL};

pub(crate) use cache::{files_in, identity_of, path_variable, read_file, replace_file};
pub(crate) use cancel::{Cancel, SLICE};
pub(crate) use convert::Clear;
