//! Windows: surfaces, their swapchains, and frames that are shown in them.

mod form;
mod options;
mod presentation;
mod surface;
mod swapchain;

pub use options::{PresentMode, SwapchainOptions};
pub use presentation::Presentation;
pub use surface::Surface;
pub use swapchain::Swapchain;
