//! Copies, blits and fills as the file says them.

use crate::base::{Code, Diagnostic, Span};
use crate::expand::resources::{Resources, fills, parts};
use crate::frame::check::images::Declaration;
use crate::frame::check::transfers::looks_beyond;
use crate::frame::check::{CheckContext, Place};
use crate::frame::{Buffer, BufferIndex, Image, ImageIndex, Pass, Work};
use crate::language::{self, Fill, Part};
use crate::ron::Spanned;

/// A pass of the file, and everything that it names.
pub(super) struct FilePass<'a> {
    pub(in crate::expand) resources: &'a Resources<'a>,
    pub(in crate::expand) pass: &'a language::Pass,
}

impl CheckContext for FilePass<'_> {
    const OF_FILE: bool = true;

    fn image(&self, index: ImageIndex) -> Option<&Image> {
        self.resources.image(index).map(|image| &image.image)
    }

    fn buffer(&self, index: BufferIndex) -> Option<&Buffer> {
        self.resources.buffer(index)
    }

    fn span(&self, place: Place) -> Span {
        use language::Work::{Blit, Copy};
        match (place, &self.pass.work) {
            (Place::Image(image, property), _) => self.resources.declared(image).at(property).0,
            (Place::PartOfSide(at), Copy { from, to } | Blit { from, to, .. }) => match [from, to][at] {
                Part::Image(part) => parts::place(part),
                Part::Buffer(part) => part.buffer.span,
            },
            (Place::Filter, Blit { filter: Some(filter), .. }) => filter.span,
            _ => self.pass.name.span,
        }
    }
}

/// Lets a draw take the place of a blit that would look beyond the part of an image that a frame uses: a blit clamps at the image's
/// edge, and a draw at the part's.
pub(super) fn draw_part(of: &FilePass<'_>, lowered: &mut Pass, errors: &mut Vec<Diagnostic>) {
    let Some(why) = looks_beyond(of, lowered) else { return };
    let (Some([from, to]), [source, target]) = (lowered.moved_images(), &lowered.transfers[..]) else { return };
    let (Some(one), Some(other)) = (of.image(from), of.image(to)) else { return };
    if other.part(target.range) != other.whole() || other.layers > 1 || other.mips > 1 {
        let message = format!("{why}, and a blit would mix in texels beyond that part");
        let help =
            format!("draw it: `draw: FullScreen(\"copy\"), sample: {{\"source\": \"{}\"}}, color: […]`", one.name);
        return errors.push(
            Diagnostic::new(Code::BLIT_OF_PART, target.span, message)
                .label(source.span, one.name.to_string())
                .help(help),
        );
    }
    lowered.work = Work::Forward { from, to, because: why.clone() };
    lowered.transfers.clear();
    lowered.inserted = Some(why.into());
}

/// Reports a fill whose value doesn't fit.
pub(in crate::expand) fn fill(
    resources: &Resources<'_>,
    to: &Part,
    value: Spanned<Fill>,
    errors: &mut Vec<Diagnostic>,
) {
    let name = match to {
        Part::Image(part) => resources.image(part.image.index).map(|image| &image.image.name),
        Part::Buffer(part) => resources.buffer(part.buffer.index).map(|buffer| &buffer.name),
    };
    let Some(name) = name else { return };
    if let Err((message, help)) = fills::typed(value.value, resources.filled(to)) {
        errors.push(
            Diagnostic::new(Code::FILL_UNFIT, value.span, format!("`{name}` can't be filled: {message}")).help(help),
        );
    }
}
