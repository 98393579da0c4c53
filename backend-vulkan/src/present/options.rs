//! How swapchains are made.

use framewright_graph::vulkan::Format;
use std::time::Duration;

/// How a swapchain is made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SwapchainOptions {
    /// Width and height of the pictures, where the surface leaves them to the program: X11 and Windows don't.
    pub extent: [u32; 2],
    /// Formats that will do, the best first; those of sRGB by default. Each is taken in sRGB's colour space: of UNORM formats the
    /// pipeline encodes the values itself.
    pub formats: Vec<Format>,
    /// When a picture is shown. A surface that lacks the mode waits for the screen ([`PresentMode::Fifo`]), which each one has.
    pub mode: PresentMode,
    /// How many images there are at least. The surface may have more.
    pub images: u32,
    /// Whether pictures are turned as the surface wants them (`preTransform`), which saves its compositor a pass where screens are
    /// mounted turned; see [`Swapchain::rotation`](crate::Swapchain::rotation). Else they are upright.
    pub turned: bool,
    /// How long an image may take to become free.
    pub timeout: Duration,
}

impl Default for SwapchainOptions {
    fn default() -> SwapchainOptions {
        SwapchainOptions {
            extent: [1280, 720],
            formats: vec![Format::R8G8B8A8_SRGB, Format::B8G8R8A8_SRGB],
            mode: PresentMode::Fifo,
            images: 3,
            turned: false,
            timeout: Duration::from_secs(10),
        }
    }
}

/// When a picture is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PresentMode {
    /// At the screen's next refresh, in order: no picture is left out and none tears.
    Fifo,
    /// As `Fifo`, but a late picture is shown at once, and may tear.
    FifoRelaxed,
    /// At the screen's next refresh the newest: pictures may be left out.
    Mailbox,
    /// At once: pictures may tear.
    Immediate,
}
