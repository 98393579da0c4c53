//! Images and buffers may follow each other's properties, but not in a circle.

use crate::base::{Code, Diagnostic, Span};
use crate::frame::Resource;
use crate::language::model::{Buffer, Bytes, Format, Image, ImageRef, Layers, Lifetime, Mips, Samples, Size};
use std::sync::Arc;

/// A longer circle is not shown whole.
const MOST_SHOWN: usize = 10;

/// Images, then buffers, by one index.
struct ResourceList<'a> {
    images: &'a [Option<Arc<Image>>],
    buffers: &'a [Option<Buffer>],
}

impl ResourceList<'_> {
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

/// The images or buffers that follow another in one property, by index: each with the other and where it is named.
type FollowEdges = Vec<(usize, (usize, Span))>;

/// Reports every circle once, for each property that can follow.
pub(crate) fn find(images: &[Option<Arc<Image>>], buffers: &[Option<Buffer>], errors: &mut Vec<Diagnostic>) {
    let all = ResourceList { images, buffers };
    let [mut sizes, mut formats, mut samples, mut mips, mut layers] = [const { FollowEdges::new() }; 5];
    let [mut bytes, mut lifetimes] = [const { FollowEdges::new() }; 2];
    let image = |of: ImageRef| (of.index.0 as usize, of.span);
    for (at, described) in images.iter().enumerate() {
        let Some(described) = described else { continue };
        if let Size::Like(of) | Size::Scaled { of: Some(of), .. } | Size::Dynamic { of: Some(of), .. } =
            described.size.value
        {
            sizes.push((at, image(of)));
        }
        if let Format::Like(of) = described.format.value {
            formats.push((at, image(of)));
        }
        if let Samples::Like(of) = described.samples.value {
            samples.push((at, image(of)));
        }
        if let Mips::Like(of) = described.mips.value {
            mips.push((at, image(of)));
        }
        if let Layers::Like(of) = described.layers.value {
            layers.push((at, image(of)));
        }
        if let Lifetime::Like(of) = described.lifetime.value {
            lifetimes.push((at, (all.index(of.resource), of.span)));
        }
    }
    for (at, described) in (images.len()..).zip(buffers) {
        let Some(described) = described else { continue };
        if let Bytes::Like(of) = described.bytes.value {
            bytes.push((at, (all.index(Resource::Buffer(of.index)), of.span)));
        }
        if let Lifetime::Like(of) = described.lifetime.value {
            lifetimes.push((at, (all.index(of.resource), of.span)));
        }
    }
    let properties = [
        ("sizes", sizes),
        ("formats", formats),
        ("sample counts", samples),
        ("mip levels", mips),
        ("layers", layers),
        ("sizes", bytes),
        ("lifetimes", lifetimes),
    ];
    properties.iter().filter(|(_, follows)| !follows.is_empty()).for_each(|(what, follows)| {
        along(&all, what, follows, errors);
    });
}

/// Each follows at most one other, so a walk from each, ended where an earlier walk has been, finds every circle.
fn along(all: &ResourceList<'_>, what: &str, follows: &FollowEdges, errors: &mut Vec<Diagnostic>) {
    let next = |at: usize| follows.binary_search_by_key(&at, |(from, _)| *from).ok().map(|found| follows[found].1);
    let mut walked_from = vec![usize::MAX; all.images.len() + all.buffers.len()];
    for (start, _) in follows {
        let mut path: Vec<(usize, (usize, Span))> = Vec::new();
        let mut at = *start;
        while walked_from[at] == usize::MAX {
            walked_from[at] = *start;
            let Some(to) = next(at) else { break };
            path.push((at, to));
            at = to.0;
        }
        let circle = path.iter().position(|(from, _)| *from == at && walked_from[at] == *start);
        if let Some(first) = circle {
            report(all, what, &path[first..], errors);
        }
    }
}

fn report(all: &ResourceList<'_>, what: &str, circle: &[(usize, (usize, Span))], errors: &mut Vec<Diagnostic>) {
    let Some((start, to)) = circle.first() else { return };
    let most = circle.len().min(MOST_SHOWN);
    let mut path: Vec<String> = circle[..most].iter().map(|(from, _)| format!("`{}`", all.name(*from))).collect();
    if most < circle.len() {
        path.push("…".to_owned());
    }
    path.push(format!("`{}`", all.name(*start)));
    let message = format!("{what} follow each other in a circle: {}", path.join(" → "));
    let follows = |from: usize, to: usize| format!("`{}` follows `{}`", all.name(from), all.name(to));
    let mut diagnostic = Diagnostic::new(Code::FOLLOWS_IN_CIRCLE, to.1, message).remark(follows(*start, to.0));
    for (from, to) in &circle[1..most] {
        diagnostic = diagnostic.label(to.1, follows(*from, to.0));
    }
    errors.push(diagnostic.help("one of them must stand on its own"));
}
