//! A pipeline file says *what* a frame is made of; this crate finds out *how*: no GPU, no unsafe code.
//!
//! ```text
//! pipeline.ron ─► describe ─► expand ─► compile ─► Plan ─► verify
//! ```

pub mod amount;
pub mod change;
pub mod compile;
pub mod describe;
pub mod device;
pub mod encoding;
pub mod expand;
pub mod expression;
pub mod facts;
pub mod file_path;
pub mod format;
pub mod frame;
pub mod heap_size;
pub mod interface;
pub mod jitter;
pub mod plan;
pub mod read_files;
pub mod root;
pub mod rotation;
pub mod source;
mod states;
pub mod texture;
pub mod verify;
pub mod view;
pub mod vocabulary;
