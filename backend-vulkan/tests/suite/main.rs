//! The backend's tests, but for those whose programs say why they stand alone. `cargo test -p framewright-vulkan --test suite
//! executor::` runs those of one module.

mod agreement;
mod both_eyes;
mod both_eyes_drawn;
mod device;
mod examples;
mod executor;
mod lifetimes;
mod poison;
mod refusals;
mod shaders;
#[path = "../testing/mod.rs"]
mod testing;
mod upscaler;
