//! Outputs of the frame, in the Plan.

use super::Resource;
use crate::frame::Eye;
use crate::vulkan::Encoding;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// An image or a buffer that leaves the frame.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// The name of the pipeline's image or buffer, which only one output has. It may stand for another one: a resolved copy, or
    /// what a pass that is off passes on.
    pub name: Arc<str>,
    /// The image or buffer. It isn't transient.
    pub resource: Resource,
    /// The meaning of its numbers: declared, or implied by its format; `None`: unspecified.
    pub encoding: Option<Encoding>,
    /// Where the encoding happens, in the reader's words; `None` where there is none: numbers are as they are.
    pub encoded: Option<String>,
    /// The eye that the output belongs to; `None`: both eyes share it, or there is one.
    pub eye: Option<Eye>,
}

impl Output {
    /// An output without a stated encoding.
    #[must_use]
    pub fn new(name: &str, resource: Resource) -> Output {
        Output { name: name.into(), resource, encoding: None, encoded: None, eye: None }
    }
}
