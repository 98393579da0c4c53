//! Outputs of the frame.

use super::{Eye, Resource};
use crate::base::Span;
use crate::vulkan::{Encoding, Rotation, State};

/// An image or buffer that leaves the frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// The image or buffer.
    pub resource: Resource,
    /// Where it was named.
    pub span: Span,
    /// The state in which it is to be left; `None`: that of its last use, which the Plan says.
    pub after: Option<State>,
    /// The meaning of its numbers, which its format must be able to hold; `None`: the meaning that the format implies.
    pub encoding: Option<Encoding>,
    /// The eye that the output belongs to; `None`: both eyes share it, or there is one.
    pub eye: Option<Eye>,
    /// Its rotation when it leaves the frame; for flat colour images of one mip level. The image is drawn turned, and so
    /// are images that are drawn beside it or become it, where nothing else reads them.
    pub rotation: Rotation,
}

/// A plain output: named nowhere, left as its last use leaves it, numbers as the format has them, upright, and no eye's own.
impl From<Resource> for Output {
    fn from(resource: Resource) -> Output {
        let (after, encoding, eye) = (None, None, None);
        Output { resource, span: Span::NONE, after, encoding, eye, rotation: Rotation::Identity }
    }
}
