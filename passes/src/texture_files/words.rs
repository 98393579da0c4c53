//! What readers say of a file.

use crate::decoder_words;
use framewright_graph::frame::TextureProblem;

/// What a decoder says of a file.
pub(super) fn damaged(reason: impl std::fmt::Display) -> TextureProblem {
    TextureProblem::Damaged { reason: decoder_words(reason) }
}

/// What an image has, in words.
pub(super) fn parts([width, height, depth]: [u32; 3], mips: u32, layers: u32) -> String {
    format!("{width}×{height}×{depth} texels with mips: {mips}, layers: {layers}")
}
