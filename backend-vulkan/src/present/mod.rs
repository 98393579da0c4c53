//! Windows: surfaces, their swapchains, and frames that are shown in them.

mod form;
mod handle;
mod options;
mod presentation;
mod surface;
mod swapchain;

pub use options::{PresentMode, SwapchainOptions};
pub use presentation::{Overlay, Presentation};
pub use surface::Surface;
pub use swapchain::Swapchain;
