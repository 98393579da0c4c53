//! What a compiler answers: SPIR-V, and the validator's verdict on it.

use serde::{Deserialize, Serialize};

/// A stage that was compiled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CompilerAnswer {
    /// SPIR-V.
    pub(crate) spirv: Vec<u32>,
    /// Whether it is valid.
    pub(crate) verdict: Verdict,
}

/// The validator's verdict on a module.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Verdict {
    /// There is no validator.
    None,
    /// It is valid, whatever the layout of its blocks takes.
    Valid,
    /// The validator doesn't know one of its words, as it says.
    Unknown(String),
    /// It isn't valid.
    Invalid(Finding),
}

/// What is wrong with a module.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Finding {
    /// The validator's words, with names in place of numbers.
    pub(crate) words: String,
    /// The file and line of what is wrong, if the module tells lines.
    pub(crate) place: Option<(String, u32)>,
    /// Words of GLSL that show it in the text, the likeliest first.
    pub(crate) named: Vec<String>,
}
