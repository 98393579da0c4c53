//! How large textures may be.

/// Texels along a side of a picture. A strip for a three-dimensional image is longer than textures of other kinds.
pub const MOST_SIDE: u32 = 16384;
/// Texels of a picture: 64 Mi.
pub const MOST_TEXELS: u64 = 64 << 20;
/// Bytes of a picture's file: 1 GiB.
pub const MOST_BYTES: u64 = 1 << 30;
