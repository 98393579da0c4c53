//! Temporary.
#![allow(dead_code)]
#[path = "suite/cadence.rs"]
mod cadence;
#[path = "suite/codes.rs"]
mod codes;
#[path = "suite/reference/mod.rs"]
mod reference;
#[path = "suite/testing/mod.rs"]
mod testing;
