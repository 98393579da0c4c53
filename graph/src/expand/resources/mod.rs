//! Images and buffers of the frame, each from its declaration and the image or buffer that it follows.
//!
//! ```text
//! follow ─► shapes ─► images ─┐
//!           states, fills ────┴─► table (Resources) ─► parts
//! ```
//! `table` is what all later stages look images and buffers up in; `parts` are the mip levels, layers and planes that passes name.

pub(super) mod fills;
pub(super) mod follow;
pub(super) mod images;
pub(super) mod parts;
mod shapes;
mod states;
mod table;

pub(super) use images::FrameImage;
pub(super) use table::Resources;
