//! Passes that wait for each other: moving one up doesn't help where the other needs it.

use super::accesses::{self, Use};
use super::writers::Writers;
use crate::base::{Code, Diagnostic, Span};
use crate::expand::passes::State;
use crate::expand::resources::Resources;
use crate::frame::Resource;
use std::collections::{HashMap, VecDeque};

/// A longer circle is not shown whole.
const MOST_SHOWN: usize = 10;

/// A dependency of a pass on a part that another pass writes.
#[derive(Clone, Copy)]
pub(in crate::expand) struct Need {
    /// The pass that needs it.
    pub(in crate::expand) pass: usize,
    pub(in crate::expand) resource: Resource,
    pub(in crate::expand) span: Span,
    /// The pass that writes it.
    pub(super) writer: usize,
}

/// The circle that contains `first`, a read of a part that a pass further below writes; `None` if that pass doesn't depend
/// on the reader.
pub(in crate::expand) fn circle(
    resources: &Resources<'_>,
    states: &[State],
    writers: &Writers,
    first: Need,
) -> Option<Vec<Need>> {
    let mut found: HashMap<usize, Need> = HashMap::new();
    let mut queue = VecDeque::from([first.writer]);
    while let Some(at) = queue.pop_front() {
        let runs = states.get(at).map_or(&[][..], State::runs);
        let uses = runs.iter().flat_map(|pass| accesses::uses(resources, pass)).filter(|used| used.reads);
        let (targets, others): (Vec<Use>, Vec<Use>) = uses.partition(|used| used.attaches);
        for Use { resource, span, .. } in others.into_iter().chain(targets) {
            let Some(writer) = writers.last_before(resource, at).filter(|writer| *writer >= first.pass) else {
                continue;
            };
            let need = Need { pass: at, resource, span, writer };
            if writer == first.pass {
                return Some(path(first, need, &found));
            }
            if writer != first.writer && !found.contains_key(&writer) {
                found.insert(writer, need);
                queue.push_back(writer);
            }
        }
    }
    None
}

/// From the first need to the one that closes the circle.
fn path(first: Need, last: Need, found: &HashMap<usize, Need>) -> Vec<Need> {
    let mut path = vec![last];
    let mut at = last.pass;
    while let Some(need) = found.get(&at) {
        path.push(*need);
        at = need.pass;
    }
    path.push(first);
    path.reverse();
    path
}

/// The circle in words, with its places.
pub(super) fn report(resources: &Resources<'_>, circle: &[Need]) -> Diagnostic {
    let name = |at: usize| &*resources.pipeline.passes[at].name.text;
    let most = circle.len().min(MOST_SHOWN);
    let mut path: Vec<String> = circle[..most].iter().map(|need| format!("`{}`", name(need.pass))).collect();
    if most < circle.len() {
        path.push("…".to_owned());
    }
    path.extend(circle.first().map(|need| format!("`{}`", name(need.pass))));
    let remark = |need: &Need| {
        let below = if need.writer > need.pass { " further below" } else { "" };
        let resource = &resources.name(need.resource).text;
        format!("`{}` reads `{resource}`, which `{}` writes{below}", name(need.pass), name(need.writer))
    };
    let message = format!("passes wait for each other in a circle: {}", path.join(" → "));
    let mut labels = circle[..most].iter().map(|need| (need.span, remark(need)));
    let (span, text) = labels.next().unwrap_or((Span::NONE, String::new()));
    let mut diagnostic = Diagnostic::new(Code::PASSES_IN_CIRCLE, span, message).remark(text);
    for (span, text) in labels {
        diagnostic = diagnostic.label(span, text);
    }
    let Some(Need { resource, .. }) = circle.first() else { return diagnostic };
    let start = &resources.name(*resource).text;
    let kind = if matches!(resource, Resource::Image(_)) { "image" } else { "buffer" };
    diagnostic.help(format!(
        "let one of them read what the frame before left: say `lifetime: History` of `{start}`, and `({kind}: \"{start}\", previous: 1)` here"
    ))
}
