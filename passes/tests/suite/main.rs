//! The tests of what the shipped passes draw. `cargo test -p framewright-passes --test suite scene::` runs those of one module.

mod cascades;
mod clusters;
mod draw_lists;
mod eyes;
mod facts;
mod frustum;
mod scene;
mod shader_page;
mod shipped;
mod texture_containers;
mod texture_files;
mod twin_grading;
mod twin_radiance;
mod twin_tone_mapping;
