//! Packing in the plane lifetime × offset: the least height found within a bound on the effort.
//!
//! ```text
//! spread ─► (height above the live peak?) ─► tight ─► (above?) ─► search
//! ```
//! `spread` takes memory that was never allocated, then the range that was freed first. A resource waits for the previous
//! owner of its memory: the longer ago that one ended, the more passes share a barrier or need none.

mod block;
mod free_list;
mod measured_blocks;
mod search;
mod sweep;
#[cfg(test)]
mod tests;

pub(super) use block::{Block, Change, Packing};
pub(super) use measured_blocks::MeasuredBlocks;
