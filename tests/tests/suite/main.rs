//! The tests of the whole. `cargo test -p framewright-tests --test suite drawn::` runs those that draw.

mod codes;
mod debug_text;
mod drawn;
mod expanding_again;
#[path = "../../../graph/tests/suite/testing/hand_written_plans/mod.rs"]
mod hand_written_plans;
mod happens_before;
mod hostile_plans;
mod kinds;
mod kinds_asked;
mod mutation;
mod names;
mod partial_passes;
mod platforms;
mod programs;
mod queues;
mod random_pipelines;
mod random_plans;
mod raycast;
mod recompilation;
mod repository;
mod rooms;
mod shipped_plans;
mod shipped_shaders;
mod small_optima;
mod spans;
mod spare_barriers;
