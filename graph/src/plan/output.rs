//! What leaves the frame, as the Plan says it.

use super::Resource;
use crate::frame::Eye;
use crate::vulkan::Encoding;
use serde::{Deserialize, Serialize};

/// An image or a buffer that leaves the frame.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Which one. It isn't transient.
    pub resource: Resource,
    /// What its numbers mean: declared, or what its format says; `None`: nothing is said of them.
    pub encoding: Option<Encoding>,
    /// Where the encoding happens, in the reader's words; `None` where there is none: numbers are as they are.
    pub encoded: Option<String>,
    /// The eye whose it is; `None`: both share it, or there is one.
    pub eye: Option<Eye>,
}

impl From<Resource> for Output {
    /// An output of whose numbers nothing is said.
    fn from(resource: Resource) -> Output {
        Output { resource, encoding: None, encoded: None, eye: None }
    }
}
