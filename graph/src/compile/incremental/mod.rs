//! Compiling frame after frame: results that stayed the same are not computed again.

mod compiler;
mod difference;

pub use compiler::{Compiler, Reuse};
