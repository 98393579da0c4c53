//! Copies, blits and fills as the file says them.

use super::fills;
use super::places::OfFile;
use super::resources::Resources;
use crate::base::Diagnostic;
use crate::frame::check::Checked;
use crate::frame::check::transfers::looks_beyond;
use crate::frame::{Pass, Work};
use crate::language::{Fill, Part};
use crate::ron::Spanned;

/// Lets a draw take the place of a blit that would look beyond the part of an image that a frame uses: a blit clamps at the image's
/// edge, and a draw at the part's.
pub(super) fn draw_part(of: &OfFile<'_>, lowered: &mut Pass, errors: &mut Vec<Diagnostic>) {
    let Some(why) = looks_beyond(of, lowered) else { return };
    let (Some([from, to]), [source, target]) = (lowered.moved_images(), &lowered.transfers[..]) else { return };
    let (Some(one), Some(other)) = (of.image(from), of.image(to)) else { return };
    if other.part(target.range) != other.whole() || other.layers > 1 || other.mips > 1 {
        let message = format!("{why}, and a blit would mix in texels beyond that part");
        let help =
            format!("draw it: `draw: FullScreen(\"copy\"), sample: {{\"source\": \"{}\"}}, color: […]`", one.name);
        return errors.push(Diagnostic::new(target.span, message).label(source.span, one.name.to_string()).help(help));
    }
    lowered.work = Work::Forward { from, to, because: why.clone() };
    lowered.transfers.clear();
    lowered.inserted = Some(why.into());
}

/// Reports a fill whose value doesn't fit.
pub(super) fn fill(resources: &Resources<'_>, to: &Part, value: Spanned<Fill>, errors: &mut Vec<Diagnostic>) {
    let name = match to {
        Part::Image(part) => resources.image(part.image.index).map(|image| &image.image.name),
        Part::Buffer(part) => resources.buffer(part.buffer.index).map(|buffer| &buffer.name),
    };
    let Some(name) = name else { return };
    if let Err((message, help)) = fills::typed(value.value, resources.filled(to)) {
        errors.push(Diagnostic::new(value.span, format!("`{name}` can't be filled: {message}")).help(help));
    }
}
