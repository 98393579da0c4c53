//! The abilities of a device as data: read from a live device by a backend, or from a saved profile.

mod estimate;
mod features;
mod limits;
mod memory;
mod needs;
mod profile;
mod profile_rules;
mod saved_profiles;
mod usual_images;

pub use estimate::MemoryEstimate;
pub(crate) use features::{DYNAMIC_RENDERING, INDEPENDENT_BLEND, SEPARATE_LAYOUTS};
pub use features::{EVERY_PLAN_USES, SOME_PLANS_USE};
pub use limits::{Limit, Limits};
pub use memory::{BufferDescriptor, ImageDescriptor, MemoryNeeds, MemoryProvider};
pub use needs::{Abilities, Need, NeedKind};
pub use profile::{FormatSupport, KnownNeeds, MemoryModel, Profile, Queues};
pub use saved_profiles::{ProfileError, SHIPPED_PROFILES};
