//! The compiler's tests: one program, so that what they need is linked once. `cargo test -p framewright-graph --test suite
//! language::` runs those of one module.

mod alpha_to_coverage;
mod both_eyes;
mod chosen_formats;
mod compile_graphs;
mod compile_raster;
mod decided;
mod demotion;
mod depth_ladder;
mod difference;
mod encodings;
mod expression;
mod format_fallback;
mod golden_plans;
mod language;
mod layers_and_planes;
mod local_reads;
mod memory_model;
mod odd_frames;
mod on_chip;
mod plan_format;
mod queue_costs;
mod queues;
mod random_frames;
mod reference;
mod rotation;
mod saved_profiles;
mod schedule;
mod shipped_devices;
mod testing;
mod textures;
mod tree;
mod unchanged;
mod verify;
mod views;
mod weighted_resolve;
