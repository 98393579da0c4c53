//! What a custom pass did and doesn't declare.

use framewright_graph::base::{Place, escape};
use std::fmt::{Display, Formatter, Result};

/// Something that the program recorded for a custom pass, and that the pipeline doesn't say of the pass. Names stand in it unescaped;
/// [`Display`] escapes them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BrokenPromise {
    /// The pass, or all passes that the program records in one rendering scope.
    pub passes: Vec<(String, Option<Place>)>,
    /// The image or buffer; several, if the validation layer doesn't tell which of them it means.
    pub resource: String,
    /// What the pass declares of it, in Vulkan's words; `None`: it doesn't name it.
    pub declared: Option<String>,
    /// What was done, in words.
    pub done: String,
}

impl Display for BrokenPromise {
    fn fmt(&self, to: &mut Formatter<'_>) -> Result {
        for (number, (pass, at)) in self.passes.iter().enumerate() {
            let before = if number == 0 { "pass" } else { ", or pass" };
            write!(to, "{before} `{}`", escape(pass))?;
            if let Some(at) = at {
                write!(to, " ({})", escape(&at.to_string()))?;
            }
        }
        match &self.declared {
            Some(declared) => write!(to, " declares `{}` as {declared}", escape(&self.resource))?,
            None => write!(to, " doesn't name `{}`", escape(&self.resource))?,
        }
        write!(to, ", and {}", escape(&self.done))
    }
}
