//! How large textures may be, and what is wrong with a file that holds none.

use crate::decoder_words;
use framewright_graph::frame::TextureProblem;

/// Texels along a side of a picture. A strip for a three-dimensional image is longer than textures of other kinds.
pub const MOST_SIDE: u32 = 16384;
/// Texels of a picture: 64 Mi.
pub const MOST_TEXELS: u64 = 64 << 20;
/// Bytes of a picture's file: 1 GiB.
pub const MOST_BYTES: u64 = 1 << 30;
/// Bytes that a decoder may take beside the file's own: what the largest picture takes with four 32-bit components.
pub(super) const MOST_DECODED: u64 = MOST_TEXELS * 16 + (64 << 20);

/// What a decoder says of a file.
pub(super) fn damaged(reason: impl std::fmt::Display) -> TextureProblem {
    TextureProblem::Damaged { reason: decoder_words(reason) }
}
