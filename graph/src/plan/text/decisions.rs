//! The settings and facts that decided about images and passes, as lines of the tree.

use super::outline::Outline;
use crate::frame::{DecidedBy, DecidedProperty, NamedValue, Property, Subject};
use crate::plan::Plan;
use crate::plan::names::ShownText;
use std::collections::HashMap;

/// The decisions of a Plan, by what they are about.
#[derive(Debug)]
pub(super) struct Decisions<'p>(HashMap<&'p Subject, Vec<&'p DecidedProperty>>);

impl<'p> Decisions<'p> {
    pub(super) fn of(plan: &'p Plan) -> Decisions<'p> {
        let mut all: HashMap<_, Vec<_>> = HashMap::new();
        for decided in plan.decided.iter() {
            all.entry(&decided.subject).or_default().push(decided);
        }
        Decisions(all)
    }

    /// A line for each decision about a subject.
    pub(super) fn about(&self, subject: &Subject) -> Vec<Outline> {
        self.lines(subject, |_| true)
    }

    /// A line for the decision about a property of a subject, if there is one.
    pub(super) fn about_one(&self, subject: &Subject, what: Property) -> Vec<Outline> {
        self.lines(subject, |decided| decided.what == what)
    }

    fn lines(&self, subject: &Subject, shows: impl Fn(&DecidedProperty) -> bool) -> Vec<Outline> {
        let decided = self.0.get(subject).into_iter().flatten();
        decided.filter(|decided| shows(decided)).map(|decided| Outline::detail(line(decided))).collect()
    }
}

/// "format: by scene.peak_radiance = 0.8", "samples: by view.allows_msaa = true, set by msaa = 4".
fn line(decided: &DecidedProperty) -> String {
    let DecidedBy { facts, settings } = &*decided.by;
    let list = |values: &[NamedValue]| {
        let shown =
            values.iter().map(|NamedValue { name, value }| format!("{} = {}", ShownText(name), ShownText(value)));
        shown.collect::<Vec<_>>().join(", ")
    };
    let by = [("by", facts), ("set by", settings)];
    let by = by.iter().filter(|(_, values)| !values.is_empty());
    let by: Vec<String> = by.map(|(word, values)| format!("{word} {}", list(values))).collect();
    format!("{}: {}", decided.what.word(), by.join("; "))
}
