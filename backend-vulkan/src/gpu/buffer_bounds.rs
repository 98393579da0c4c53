//! Whether a device keeps draws and shaders within their buffers.

/// Whether a device keeps draws and shaders within their buffers: `robustBufferAccess`.
///
/// Without it a device may be faster. An index beyond a buffer then reads or writes other memory, or the device is lost: a pipeline file
/// may hold such an index as well as a shader does, and nothing looks for it. So it is for programs that draw files of their own alone.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct BufferBounds {
    unchecked: bool,
}

impl BufferBounds {
    /// The device keeps to them: for files and shaders of anybody.
    pub const CHECKED: BufferBounds = BufferBounds { unchecked: false };

    /// Nothing keeps to them but what is drawn.
    ///
    /// # Safety
    /// On a device that is opened so no index of a draw, an indirect draw or a shader reaches beyond its buffer.
    #[must_use]
    pub const unsafe fn unchecked() -> BufferBounds {
        BufferBounds { unchecked: true }
    }

    pub(super) fn are_checked(self) -> bool {
        !self.unchecked
    }
}
