//! Uses that a custom pass declares: the stages, accesses and layout of what the program records.

use super::{Access, Effect, Image, Pass, Resource};
use crate::base::Span;
use crate::vulkan::{State, Subresources};

/// How the commands that the program records use an image or buffer that their pass names. Without it they are taken for any
/// commands.
#[derive(Debug, Clone, PartialEq)]
pub struct DeclaredUse {
    /// The image or buffer, which the pass names elsewhere: there stands whether it is read and written.
    pub resource: Resource,
    /// The part of an image. What the pass names of the image lies in it, or shares nothing with it.
    pub range: Subresources,
    /// How many frames ago: 0 is this frame.
    pub frames_ago: u32,
    /// Where it is declared.
    pub span: Span,
    /// The stages and accesses, and the layout of an image during the pass; buffers have none: `UNDEFINED`.
    pub state: State,
}

impl DeclaredUse {
    /// All of an image or buffer of this frame; no file declares it.
    #[must_use]
    pub const fn new(resource: Resource, state: State) -> DeclaredUse {
        DeclaredUse { resource, range: Subresources::WHOLE, frames_ago: 0, span: Span::NONE, state }
    }

    /// Whether it is of the image or buffer of an access that the program's commands make. Attachments are accessed by the
    /// rendering scope.
    pub(crate) fn is_of(&self, access: &Access<'_>) -> bool {
        !access.attaches() && (self.resource, self.frames_ago) == (access.resource(), access.frames_ago())
    }

    /// Whether it is of all of what an access touches. `image`: the image, if it is one.
    pub(crate) fn covers(&self, touched: &Effect, image: Option<&Image>) -> bool {
        image.is_none_or(|image| image.part(self.range).contains(image.part(touched.range)))
    }

    /// Whether it is of a part of what an access touches. `image`: the image, if it is one.
    pub(crate) fn meets(&self, touched: &Effect, image: Option<&Image>) -> bool {
        image.is_none_or(|image| image.overlap(self.range, touched.range))
    }
}

impl Pass {
    /// The use that the pass declares of what one of its accesses touches, if it declares one. `image`: the image, if it is
    /// one.
    pub(crate) fn declared_use(&self, access: &Access<'_>, image: Option<&Image>) -> Option<&DeclaredUse> {
        let mut declared = self.uses.iter().filter(|declared| declared.is_of(access));
        declared.find(|declared| {
            let mut covers = false;
            access.for_each_effect(self, image, |touched| covers |= declared.covers(&touched, image));
            covers
        })
    }
}
