//! The abilities of a device as data: read from a live device by a backend, or from a saved profile.

mod estimate;
mod limits;
mod memory;
mod needs;
mod profile;
mod saved;
mod sound;
mod usual;

pub use estimate::Estimated;
pub use limits::{Limit, Limits};
pub use memory::{BufferDescriptor, ImageDescriptor, MemoryNeeds, MemoryProvider};
pub use needs::{Abilities, Need, NeedKind};
pub use profile::{FormatSupport, KnownNeeds, MemoryModel, Profile, Queues};
pub use saved::{ProfileError, SHIPPED_PROFILES};
