//! How long contents live: from which values they start, how far back they are kept, in which states they come and go.

use crate::base::{Code, Diagnostic, Span};
use crate::frame::{Access, Frame, Image, Lifetime, Pass, TextureFile, format_problem};
use crate::vulkan::states::{StateTime, Subject, contradiction};
use crate::vulkan::{Layout, Shape, State};

/// Most frames that history goes back: as many as the checker of the Plan can follow around.
const MOST_HISTORY: u32 = 32;

/// The mistake in a lifetime, if there is one.
#[inline]
pub(super) fn check<'s>(lifetime: &Lifetime, span: Span, of: impl FnOnce() -> Subject<'s>) -> Option<Diagnostic> {
    if matches!(lifetime, Lifetime::Transient) { None } else { mistake(lifetime, span, of()) }
}

fn mistake(lifetime: &Lifetime, span: Span, of: Subject<'_>) -> Option<Diagnostic> {
    let wrong = |what: String| Diagnostic::new(Code::LIFETIME, span, format!("`{}` {what}", of.name));
    match lifetime {
        Lifetime::Transient => None,
        Lifetime::History { frames, .. } if *frames == 0 || *frames > MOST_HISTORY => {
            Some(wrong(format!("keeps {frames} frames; 1 to {MOST_HISTORY} are possible")))
        }
        Lifetime::Persistent { initial } | Lifetime::History { initial, .. } => {
            initial.problem(of.format).map(|what| wrong(format!("starts as {what}")))
        }
        Lifetime::Imported { before, after, .. } => {
            let after = after.and_then(|after| check_state(&after, span, of, StateTime::After));
            check_state(before, span, of, StateTime::Before).or(after)
        }
        Lifetime::File(file) => file_problem(file, of).map(wrong),
    }
}

/// Why nothing like that can come from a file.
fn file_problem(file: &TextureFile, of: Subject<'_>) -> Option<String> {
    let Some(format) = of.format else {
        return Some("is a buffer and comes from a file, which only images can".to_owned());
    };
    if file.path.is_empty() {
        Some("comes from a file without a name".to_owned())
    } else if of.samples > 1 {
        Some("comes from a file and is multisampled".to_owned())
    } else {
        format_problem(file, format).map(|why| format!("comes from a file and is {format}: {why}"))
    }
}

/// Why an image can't come from a file for its shape.
pub(super) fn shape_problem(image: &Image) -> Option<String> {
    let layered = image.layers > 1 || image.shape == Shape::Cube;
    let of_picture = matches!(&image.lifetime, Lifetime::File(file) if !file.stored);
    (of_picture && layered).then(|| "comes from a file and has layers".to_owned())
}

/// Why an image can't have its compressed format.
pub(super) fn compression_problem(image: &Image) -> Option<String> {
    let filled = matches!(image.lifetime, Lifetime::File(_) | Lifetime::Imported { .. });
    let what = || format!("is {}, a compressed format, and no pass can fill it", image.format);
    (image.format.is_compressed() && !filled).then(what)
}

/// Where a pass uses an image in a compressed format for anything but sampling it.
pub(super) fn misused_compression(frame: &Frame, pass: &Pass) -> Option<(Span, String)> {
    let others = pass.accesses().filter(|access| !matches!(access, Access::Sampled(_)));
    let mut images = others.filter_map(|access| Some((&frame.images[access.image_index()?.0 as usize], access.span())));
    let (image, span) = images.find(|(image, _)| image.format.is_compressed())?;
    let Image { name, format, .. } = image;
    Some((span, format!("does more with `{name}` than sample it: it is {format}, a compressed format")))
}

/// Where a pass uses an image that comes from a file for anything but sampling it.
pub(super) fn misused_file(frame: &Frame, pass: &Pass) -> Option<(Span, String)> {
    let others = pass.accesses().filter(|access| !matches!(access, Access::Sampled(_)));
    let images = others.filter_map(|access| Some((&frame.images[access.image_index()?.0 as usize], access.span())));
    let mut files = images.filter(|(image, _)| matches!(image.lifetime, Lifetime::File(_)));
    files
        .next()
        .map(|(image, span)| (span, format!("does more with `{}` than sample it: it comes from a file", image.name)))
}

/// The mistake in a state in which an image or buffer comes or goes, if there is one.
pub(super) fn check_state(state: &State, span: Span, of: Subject<'_>, when: StateTime) -> Option<Diagnostic> {
    if let Some((message, help)) = contradiction(state, of, when) {
        return Some(Diagnostic::new(Code::STATE_UNFIT, span, message).help(help));
    }
    let odd = of.format.is_none() && state.layout != Layout::Undefined;
    odd.then(|| {
        Diagnostic::new(Code::STATE_UNFIT, span, format!("`{}` is a buffer and has a layout", of.name))
            .help("write `UNDEFINED`")
    })
}
