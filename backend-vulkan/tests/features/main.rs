//! Features of frames, one by one: small frames compiled and executed on each driver under the validation layer, and
//! exactly what they leave.

mod foreign;
mod frames;
#[path = "../testing/mod.rs"]
mod testing;

mod acceleration_structures;
mod addressed;
mod adopted;
mod allocations;
mod bindless;
mod blending;
mod both_eyes;
mod breadcrumbs;
mod buffer_references;
mod cadence;
mod clear_values;
mod compute;
mod counted_barriers;
mod debugging;
mod declared_uses;
mod depth;
mod dynamic_buffers;
mod engine_vertices;
mod formats;
mod geometry;
mod growth;
mod hand_over;
mod held;
mod hlsl_vertices;
mod image_arrays;
mod imports;
mod imports_in_flight;
mod local_reads;
mod outlasting;
mod outside_owners;
mod overlays;
mod own_commands;
mod own_pipelines;
mod presenting;
mod program_sets;
mod promises;
mod queues;
mod ray_queries;
mod resolves;
mod secondary;
mod seen_vertices;
mod state;
mod stray_vertices;
mod submitting;
mod subresources;
mod texture_arrays;
mod texture_files;
mod textures;
mod transfers;
mod used_features;
