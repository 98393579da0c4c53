//! A pipeline with all that its compiler asks for, as data. A page carries it, and this crate as a module of WebAssembly: so a browser
//! compiles the pipeline anew, offline, for other choices and other texts.
//!
//! ```text
//! files, settings, pictures ─┐
//! shaders ─► recorder ─► Subject ─► planned ─► Plan ─► view, differences
//!                       Choices ──┘
//! ```
//!
//! It reads no file and knows no shader compiler: what a subject doesn't carry is a mistake that says so.

mod answer;
#[cfg(target_arch = "wasm32")]
mod exports;
mod files;
mod planning;
mod shaders;
mod subject;
mod view;

pub use answer::answer;
pub use planning::{Refusal, SubjectPlan};
pub use shaders::{ShaderRecorder, ShaderTable};
pub use subject::{Choices, FORMAT, NamedProfile, PathUse, Subject, TextFile};
pub use view::{MOST_NODES, PlanView};
