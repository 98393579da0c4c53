//! How what a step left differs from what it must leave.

use crate::commands::plane_bytes;
use crate::prepare::WatchedPart;
use framewright_graph::vulkan::{Aspects, Format};
use std::collections::HashMap;

/// How a part differs after its step from what it must be, in words, if it does.
pub(super) fn difference(part: &WatchedPart, expected: &[u8], after: &[u8]) -> Option<String> {
    let pairs = expected.iter().zip(after).enumerate();
    let mut changed = pairs.filter(|(at, (a, b))| a != b && !is_unused(part, *at)).map(|(at, _)| at);
    let first = changed.next()?;
    let (count, bytes) = (changed.count() + 1, after.len());
    Some(format!("{count} of {bytes} bytes{} are others after it, the first is byte {first}", place(part)))
}

/// The part of an image, in words.
fn place(part: &WatchedPart) -> String {
    let range = part.range;
    part.format.map_or_else(String::new, |_| format!(" of mip {}, layer {}", range.base_mip, range.base_layer))
}

/// Whether a byte of a part is none that its format uses: the eight bits behind depth of 24.
fn is_unused(part: &WatchedPart, at: usize) -> bool {
    let is_24_bits = matches!(part.format, Some(Format::X8_D24_UNORM_PACK32 | Format::D24_UNORM_S8_UINT));
    is_24_bits && part.range.aspects == Aspects::DEPTH && at % 4 == 3
}

/// What passes left untouched that they promise to set: texels of images, words of buffers. A texel may be set to what the garbage was.
/// So it counts as untouched if it stays as it was in two frames with different garbage.
#[derive(Default)]
pub(crate) struct UntouchedTexels {
    /// By step and part: which garbage the frame had that was looked at last, and the texels that stayed so.
    last: HashMap<(usize, usize), (usize, Vec<bool>)>,
}

impl UntouchedTexels {
    /// What is untouched of a part, in words, if anything is. `turn`: which garbage it held before its step.
    pub(super) fn look(
        &mut self,
        at: (usize, usize),
        turn: usize,
        part: &WatchedPart,
        (garbage, after): (&[u8], &[u8]),
    ) -> Option<String> {
        let (unit, what) = match part.format {
            Some(format) => (usize::try_from(plane_bytes(format, part.range.aspects)).unwrap_or(1).max(1), "texels"),
            None => (4, "words"),
        };
        let kept: Vec<bool> = garbage.chunks(unit).zip(after.chunks(unit)).map(|(a, b)| a == b).collect();
        let (before, other) = self.last.insert(at, (turn, kept.clone()))?;
        if before == turn || other.len() != kept.len() {
            return None;
        }
        let both = || kept.iter().zip(&other).enumerate().filter(|(_, (a, b))| **a && **b).map(|(number, _)| number);
        let (first, count, all) = (both().next()?, both().count(), kept.len());
        let are = if count == 1 { "is" } else { "are" };
        Some(format!("{count} of {all} {what}{} {are} not set by it, the first is number {first}", place(part)))
    }
}
