//! Random pipelines: made from a seed, evaluated on the CPU, executed on real drivers, compared bit for bit.
//!
//! ```text
//! seed ─► generate ─► pipeline ─┬─► to_frame ─► compile ─► verify ─► execute ─┐
//!                               └─► meaning (frame after frame on the CPU) ───┴─► the same, or shrink
//! ```

pub mod allowed;
mod compare;
pub mod generate;
pub mod hash;
pub mod judge;
pub mod meaning;
pub mod pipeline;
pub mod rng;
pub mod shader;
pub mod shrink;
pub mod spoil;
pub mod texels;
pub mod text;
pub mod to_frame;
pub mod to_ron;
pub mod valid;

use allowed::Allowed;
use framewright_graph::frame::Frame;
use rng::Rng;

/// The frame of a random pipeline of `passes` passes, always the same for the same seed.
#[must_use]
pub fn frame(seed: u64, passes: u32) -> Frame {
    to_frame::to_frame(&generate::pipeline(seed, passes, &Allowed::today()))
}

/// How many passes the pipeline of a seed has: from 1 to `most`, more often few than many.
#[must_use]
pub fn passes(seed: u64, most: u32) -> u32 {
    let mut rng = Rng::new(seed);
    let many = rng.below(most);
    1 + rng.below(many + 1)
}
