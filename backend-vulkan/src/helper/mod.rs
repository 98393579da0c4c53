//! Helper processes: GLSL is compiled, and drivers are tested, where a crash ends no more than a child process.
//!
//! The GLSL compiler has no bounds of its own: a few hundred bytes of nested macros overflow its stack, or keep it busy
//! forever. Drivers crash as well. A program that names a helper has both done in a child process, with limits on time,
//! memory and stack; its death is an error like any other, and the next shader gets a new one.
//!
//! A program can be its own helper: its `main` calls [`serve()`] before anything else, and it names itself by
//! [`Helper::this_program`]. Without a helper all of this happens in the program's own process, without limits.

mod serve;

pub use crate::process::{Helper, Limits, LongTest};
pub use serve::serve;
