//! The tests of the library's face. `cargo test -p framewright --test suite renderer::` runs those of one module.

mod captures;
mod examples;
mod files;
mod mistakes;
mod page;
mod reloading;
mod renderer;
mod testing;
