//! Images and buffers may follow each other's properties, but not in a circle.

use crate::base::{Diagnostic, Span};
use crate::frame::Resource;
use crate::language::model::{Buffer, Bytes, Format, Image, ImageRef, Layers, Lifetime, Mips, Samples, Size};
use std::borrow::Cow;

/// A longer circle is not shown whole.
const MOST_SHOWN: usize = 10;

/// Images, then buffers, by one index.
struct All<'a> {
    images: &'a [Option<Cow<'a, Image>>],
    buffers: &'a [Option<Buffer>],
}

impl All<'_> {
    fn name(&self, at: usize) -> &str {
        let image = self.images.get(at).and_then(Option::as_ref).map(|image| &*image.name.text);
        let buffer = || self.buffers.get(at.checked_sub(self.images.len())?)?.as_ref().map(|buffer| &*buffer.name.text);
        image.or_else(buffer).unwrap_or_default()
    }

    fn index(&self, resource: Resource) -> usize {
        match resource {
            Resource::Image(image) => image.0 as usize,
            Resource::Buffer(buffer) => self.images.len() + buffer.0 as usize,
        }
    }
}

/// Reports every circle once, for each property that can follow.
pub(crate) fn find(images: &[Option<Cow<'_, Image>>], buffers: &[Option<Buffer>], errors: &mut Vec<Diagnostic>) {
    let all = All { images, buffers };
    let mut of_images = |what: &str, next: &dyn Fn(&Image) -> Option<ImageRef>| {
        let next = |at: usize| images.get(at)?.as_deref().and_then(next).map(|of| (of.index.0 as usize, of.span));
        along(&all, what, next, errors);
    };
    of_images("sizes", &|image| match image.size.value {
        Size::Like(of) | Size::Scaled { of: Some(of), .. } | Size::Dynamic { of: Some(of), .. } => Some(of),
        _ => None,
    });
    of_images("formats", &|image| match image.format.value {
        Format::Like(of) => Some(of),
        _ => None,
    });
    of_images("sample counts", &|image| match image.samples.value {
        Samples::Like(of) => Some(of),
        Samples::Count(_) => None,
    });
    of_images("mip levels", &|image| match image.mips.value {
        Mips::Like(of) => Some(of),
        _ => None,
    });
    of_images("layers", &|image| match image.layers.value {
        Layers::Like(of) => Some(of),
        _ => None,
    });
    let buffer = |at: usize| buffers.get(at.checked_sub(images.len())?)?.as_ref();
    let bytes = |at: usize| match buffer(at)?.bytes.value {
        Bytes::Like(of) => Some((all.index(Resource::Buffer(of.index)), of.span)),
        _ => None,
    };
    along(&all, "sizes", bytes, errors);
    let lifetime = |at: usize| {
        let of_image = images.get(at).and_then(Option::as_ref).map(|image| &image.lifetime.value);
        match of_image.or_else(|| buffer(at).map(|buffer| &buffer.lifetime.value))? {
            Lifetime::Like(of) => Some((all.index(of.resource), of.span)),
            _ => None,
        }
    };
    along(&all, "lifetimes", lifetime, errors);
}

/// Each follows at most one other, so a walk from each, ended where an earlier walk has been, finds every circle.
fn along(all: &All<'_>, what: &str, next: impl Fn(usize) -> Option<(usize, Span)>, errors: &mut Vec<Diagnostic>) {
    let mut walked_from = vec![usize::MAX; all.images.len() + all.buffers.len()];
    for start in 0..walked_from.len() {
        let mut path: Vec<(usize, (usize, Span))> = Vec::new();
        let mut at = start;
        while walked_from[at] == usize::MAX {
            walked_from[at] = start;
            let Some(to) = next(at) else { break };
            path.push((at, to));
            at = to.0;
        }
        let circle = path.iter().position(|(from, _)| *from == at && walked_from[at] == start);
        if let Some(first) = circle {
            report(all, what, &path[first..], errors);
        }
    }
}

fn report(all: &All<'_>, what: &str, circle: &[(usize, (usize, Span))], errors: &mut Vec<Diagnostic>) {
    let Some((start, to)) = circle.first() else { return };
    let most = circle.len().min(MOST_SHOWN);
    let mut path: Vec<String> = circle[..most].iter().map(|(from, _)| format!("`{}`", all.name(*from))).collect();
    if most < circle.len() {
        path.push("…".to_owned());
    }
    path.push(format!("`{}`", all.name(*start)));
    let message = format!("{what} follow each other in a circle: {}", path.join(" → "));
    let follows = |from: usize, to: usize| format!("`{}` follows `{}`", all.name(from), all.name(to));
    let mut diagnostic = Diagnostic::new(to.1, message).remark(follows(*start, to.0));
    for (from, to) in &circle[1..most] {
        diagnostic = diagnostic.label(to.1, follows(*from, to.0));
    }
    errors.push(diagnostic.help("one of them must stand on its own"));
}
