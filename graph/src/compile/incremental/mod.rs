//! Compiling frame after frame: what stayed the same is not found out again.

mod compiler;
mod difference;

pub use compiler::{Compiler, Reuse};
