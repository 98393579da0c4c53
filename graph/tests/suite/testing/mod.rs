//! Helpers that the tests of this crate share.

pub(crate) mod graphs;
pub(crate) mod hand_written_plans;
pub(crate) mod parts;
pub(crate) mod pipelines;
pub(crate) mod plans;
pub(crate) mod raster;
pub(crate) mod symbolic;
pub(crate) mod table;
