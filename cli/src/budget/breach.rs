//! Bounds that a Plan is beyond, as mistakes with their places.

use super::bound::Bound;
use super::{Budget, Limit};
use crate::error::Error;
use crate::system::Exit;
use framewright_graph::base::{Code, Diagnostic, Place, Sources, Span};
use framewright_graph::dataflow::{Dataflow, Node};
use framewright_graph::plan::Plan;

impl Budget {
    /// Makes sure that a Plan is within all bounds.
    ///
    /// # Errors
    /// Its breaches.
    pub(crate) fn holds(&self, plan: &Plan, sources: &Sources) -> Result<(), Error> {
        let breaches = self.breaches(plan, sources);
        if breaches.is_empty() { Ok(()) } else { Err(Error::mistakes(sources.clone(), breaches, Exit::Found)) }
    }

    /// The mistakes of a Plan that is beyond a bound: each with the step that breaks it, and the limit.
    pub(crate) fn breaches(&self, plan: &Plan, sources: &Sources) -> Vec<Diagnostic> {
        let mut flow = None;
        let limits = self.limits.iter().filter(|limit| limit.is_for(plan));
        let bounds = limits.flat_map(|limit| limit.bounds.iter().map(move |bound| (limit, *bound)));
        bounds
            .filter_map(|(limit, (bound, most))| {
                let found = bound.of(plan);
                if found <= most {
                    return None;
                }
                let flow = flow.get_or_insert_with(|| Dataflow::of(plan));
                Some(breach(plan, flow, sources, limit, (bound, most, found)))
            })
            .collect()
    }
}

fn breach(
    plan: &Plan,
    flow: &Dataflow,
    sources: &Sources,
    limit: &Limit,
    (bound, most, found): (Bound, f64, f64),
) -> Diagnostic {
    let (words, unit) = bound.words();
    let number = |number: f64| if unit.is_empty() { number.to_string() } else { format!("{number:.2}") };
    let [found, most_words] = [found, most].map(number);
    let message = format!("the budget is exceeded: {words} {found}{unit}, and at most {most_words}{unit} are allowed");
    let told = |place: Option<&Place>, remark: String| match place.and_then(|place| span(sources, place)) {
        Some(place) => {
            Diagnostic::new(Code::OVER_BUDGET, place, &*message).remark(remark).label(limit.span, "the limit")
        }
        None => Diagnostic::new(Code::OVER_BUDGET, limit.span, &*message).remark(remark),
    };
    if let [first, rest @ ..] = &bound.hints(plan)[..] {
        let remark = rest.iter().fold(first.text.clone(), |all, hint| all + "; " + &hint.text);
        return told(first.at.as_ref(), remark);
    }
    let step = bound.broken_by(plan, most);
    let of_step = || flow.nodes.iter().filter(|node| Some(node.step.0 as usize) == step);
    // A resolve that a scope carries is not what its first pass says.
    let wanted = |node: &&Node| match bound {
        Bound::Resolves | Bound::ResolvedMib => node.kind.resolves(),
        _ => true,
    };
    let node = of_step().find(wanted).or_else(|| of_step().next());
    let how = if bound == Bound::MemoryMib { "most is alive in" } else { "the bound is passed in" };
    let mut remark = step.map_or_else(String::new, |step| format!("{how} step {step}"));
    if let Some(node) = node {
        remark += &format!(", `{}`", node.name);
        remark.extend(node.because.iter().map(|because| format!(": {because}")));
    }
    told(node.and_then(|node| node.at.as_ref()), remark)
}

/// A place of a Plan in the texts that it was made of: the rest of its line.
fn span(sources: &Sources, place: &Place) -> Option<Span> {
    let (number, file) =
        (0..).map_while(|at| Some((at, sources.file(at)?))).find(|(_, it)| *it.relative == *place.file)?;
    let lines = usize::try_from(place.line).ok()?.checked_sub(1)?;
    let start: usize = file.text.split_inclusive('\n').take(lines).map(str::len).sum();
    let line = file.text.get(start..)?.lines().next()?;
    let column = usize::try_from(place.column).ok()?.checked_sub(1)?;
    let skipped = line.char_indices().nth(column).map_or(line.len(), |(at, _)| at);
    let [start, end] = [start + skipped, start + line.trim_end().len()].map(u32::try_from);
    Some(Span::new(u32::try_from(number).ok()?, start.ok()?, end.ok()?))
}
