//! The C interface, tried by programs in C. `cargo test -p framewright-c --test suite programs::` runs those of one module.

mod header;
mod page;
mod programs;
mod testing;
mod viewer;
