//! `Like` and `Scaled` may follow from image to image, but not in a circle.

use super::Diagnostic;
use super::pipeline::{Format, Image, ImageRef, Samples, Size};

/// A longer circle is not shown whole.
const MOST_SHOWN: usize = 10;

/// Reports every circle once, for sizes, formats and sample counts.
pub(super) fn find(images: &[Option<Image>], errors: &mut Vec<Diagnostic>) {
    let size = |image: &Image| match image.size.value {
        Size::Like(of) | Size::Scaled { of: Some(of), .. } => Some(of),
        _ => None,
    };
    let format = |image: &Image| match image.format.value {
        Format::Like(of) => Some(of),
        _ => None,
    };
    let samples = |image: &Image| match image.samples.value {
        Samples::Like(of) => Some(of),
        Samples::Count(_) => None,
    };
    along(images, "sizes", size, errors);
    along(images, "formats", format, errors);
    along(images, "sample counts", samples, errors);
}

/// Each image follows at most one other, so a walk from each, ended where an earlier walk has been, finds every circle.
fn along(
    images: &[Option<Image>],
    what: &str,
    next: impl Fn(&Image) -> Option<ImageRef>,
    errors: &mut Vec<Diagnostic>,
) {
    let mut walked_from = vec![usize::MAX; images.len()];
    for start in 0..images.len() {
        let mut path: Vec<(usize, ImageRef)> = Vec::new();
        let mut at = start;
        while walked_from[at] == usize::MAX {
            walked_from[at] = start;
            let Some(to) = images[at].as_ref().and_then(&next) else { break };
            path.push((at, to));
            at = to.index.0 as usize;
        }
        let circle = path.iter().position(|(from, _)| *from == at && walked_from[at] == start);
        if let Some(first) = circle {
            report(images, what, &path[first..], errors);
        }
    }
}

fn report(images: &[Option<Image>], what: &str, circle: &[(usize, ImageRef)], errors: &mut Vec<Diagnostic>) {
    let name = |index: usize| images[index].as_ref().map_or("", |image| &image.name.text);
    let Some((start, to)) = circle.first() else { return };
    let most = circle.len().min(MOST_SHOWN);
    let mut path: Vec<String> = circle[..most].iter().map(|(from, _)| format!("`{}`", name(*from))).collect();
    if most < circle.len() {
        path.push("…".to_owned());
    }
    path.push(format!("`{}`", name(*start)));
    let message = format!("{what} follow each other in a circle: {}", path.join(" → "));
    let follows = |from: usize, to: &ImageRef| format!("`{}` follows `{}`", name(from), name(to.index.0 as usize));
    let mut diagnostic = Diagnostic::new(to.span, message).remark(follows(*start, to));
    for (from, to) in &circle[1..most] {
        diagnostic = diagnostic.label(to.span, follows(*from, to));
    }
    errors.push(diagnostic.help("one of them must stand on its own"));
}
