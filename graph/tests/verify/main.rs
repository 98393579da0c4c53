//! The checker: accepts what is right, catches what is not.

mod accepts;
mod compiled;
mod contents;
mod eyes;
mod form;
#[path = "../hand_written_plans/mod.rs"]
mod hand_written_plans;
mod large;
mod mutations;
#[path = "../raster/mod.rs"]
#[allow(dead_code, reason = "some frames are only looked at where the compiler is tested")]
mod raster;
mod rules;
