//! Which image or buffer of a frame.

/// Index of an image in [`Frame::images`](super::Frame::images).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ImageIndex(pub u32);

/// Index of a buffer in [`Frame::buffers`](super::Frame::buffers).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BufferIndex(pub u32);

/// An image or a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Resource {
    /// An image.
    Image(ImageIndex),
    /// A buffer.
    Buffer(BufferIndex),
}
