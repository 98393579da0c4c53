//! Words for people in place of Rust's own.

use std::fmt::Debug;
use std::ops::Range;

/// The name of an enumerant or of flags in Vulkan or SPIR-V: `ash`, `rspirv` and `bitflags` have it as `Debug` text.
pub(crate) fn named(value: impl Debug) -> String {
    format!("{value:?}")
}

/// Extents or counts along axes: `8×8×1`.
pub(crate) fn by<const N: usize>(axes: [u32; N]) -> String {
    axes.map(|axis| axis.to_string()).join("×")
}

/// The numbers of a range: `4 to 7`.
pub(crate) fn numbers(range: &Range<u32>) -> String {
    match range.end.checked_sub(range.start) {
        Some(1) => range.start.to_string(),
        Some(2..) => format!("{} to {}", range.start, range.end - 1),
        Some(0) | None => "none".to_owned(),
    }
}
