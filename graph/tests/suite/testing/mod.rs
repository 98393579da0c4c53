//! What the tests of this crate share.

pub(crate) mod graphs;
pub(crate) mod hand_written_plans;
pub(crate) mod plans;
pub(crate) mod raster;
#[path = "../../../../tests/src/sweep.rs"]
#[allow(dead_code, unreachable_pub, reason = "the tests of the whole share it")]
pub(crate) mod sweep;
pub(crate) mod symbolic;
pub(crate) mod table;
