//! Windows: surfaces, their swapchains, and frames that are shown in them.

mod presentation;
mod surface;
mod swapchain;

pub use presentation::Presentation;
pub use surface::Surface;
pub use swapchain::{PresentMode, Swapchain, SwapchainOptions};
