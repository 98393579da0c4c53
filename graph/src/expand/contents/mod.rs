//! What images and buffers hold when passes read them: who writes before whom.
//!
//! ```text
//! accesses ─► storage_writes ─► writers ─► waits ─► order ─► history ─► padding
//! ```
//! `storage_writes` lets storage writes keep what they don't write. `order` reports reads of what nothing wrote, and `waits` the circle behind
//! one. `history` and `padding` finish a frame without mistakes.

pub(super) mod accesses;
pub(super) mod history;
pub(super) mod order;
pub(super) mod padding;
pub(super) mod storage_writes;
mod waits;
mod writers;
