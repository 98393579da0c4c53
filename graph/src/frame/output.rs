//! What leaves the frame.

use super::{Eye, Resource};
use crate::base::Span;
use crate::vulkan::{Encoding, Rotation, State};

/// An image or buffer that leaves the frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// Which one.
    pub resource: Resource,
    /// Where it was named.
    pub span: Span,
    /// The state in which it is to be left; `None`: that of its last use, which the Plan says.
    pub after: Option<State>,
    /// What its numbers mean, which its format must be able to hold; `None`: what the format says.
    pub encoding: Option<Encoding>,
    /// The eye whose it is; `None`: both share it, or there is one.
    pub eye: Option<Eye>,
    /// By how much it is turned when it leaves the frame; of flat colour images of one mip level. It is drawn so, with
    /// whatever is drawn beside it or becomes it, where nothing else reads that.
    pub rotation: Rotation,
}

/// Just that: named nowhere, left as its last use leaves it, its numbers as the format has them, upright, and no eye's own.
impl From<Resource> for Output {
    fn from(resource: Resource) -> Output {
        let (after, encoding, eye) = (None, None, None);
        Output { resource, span: Span::NONE, after, encoding, eye, rotation: Rotation::Identity }
    }
}
