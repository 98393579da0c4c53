//! Windows: surfaces, their swapchains, and frames that are shown in them.

mod form;
mod handle;
mod options;
mod overlay;
mod presentation;
mod surface;
mod swapchain;

pub use options::{PresentMode, SwapchainOptions};
pub use overlay::Overlay;
pub use presentation::Presentation;
pub use surface::Surface;
pub use swapchain::Swapchain;
