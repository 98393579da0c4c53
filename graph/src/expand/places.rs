//! Where a file says what a mistake in the frame is about.

use super::parts;
use super::resources::Resources;
use crate::base::Span;
use crate::frame::check::images::Declaration;
use crate::frame::check::{Checked, Place, Property};
use crate::frame::{Buffer, BufferIndex, Image, ImageIndex};
use crate::language::{self, Part, Pass};

/// A pass of the file, and everything that it names.
pub(super) struct OfFile<'a> {
    pub(super) resources: &'a Resources<'a>,
    pub(super) pass: &'a Pass,
}

impl Checked for OfFile<'_> {
    const OF_FILE: bool = true;

    fn image(&self, index: ImageIndex) -> Option<&Image> {
        self.resources.image(index).map(|image| &image.image)
    }

    fn buffer(&self, index: BufferIndex) -> Option<&Buffer> {
        self.resources.buffer(index)
    }

    fn span(&self, place: Place) -> Span {
        let OfFile { resources, pass } = self;
        let side = |at: usize| pass.work.sides().map(|sides| sides[at]);
        let found = match place {
            Place::Image(image, property) => Some(resources.declared(image).span(property)),
            Place::Buffer(buffer) => resources.buffer(buffer).map(|buffer| buffer.span),
            Place::Side(at) => side(at).map(|part| part.resource().span),
            Place::PartOfSide(at) => side(at).map(|part| match part {
                Part::Image(part) => parts::place(part),
                Part::Buffer(part) => part.buffer.span,
            }),
            Place::Filter => pass.work.filter().map(|filter| filter.span),
        };
        found.unwrap_or(pass.name.span)
    }
}

impl Declaration for language::Image {
    fn span(&self, property: Property) -> Span {
        match property {
            Property::Format => self.format.span,
            Property::Size => self.size.span,
            Property::Shape => self.shape.span,
            Property::Mips => self.mips.span,
            Property::Layers => self.layers.span,
            Property::Samples => self.samples.span,
            Property::Lifetime => self.lifetime.span,
        }
    }

    fn because(&self, property: Property) -> &str {
        match property {
            Property::Format => self.format.remark(),
            Property::Size => self.size.remark(),
            Property::Shape => self.shape.remark(),
            Property::Mips => self.mips.remark(),
            Property::Layers => self.layers.remark(),
            Property::Samples => self.samples.remark(),
            Property::Lifetime => "",
        }
    }

    fn outlives_frame(&self) -> bool {
        !matches!(self.lifetime.value, language::Lifetime::Transient)
    }
}
