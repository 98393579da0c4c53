//! Verdicts that variants share: those that agree on all settings and facts that the verdict depends on.
//!
//! An expansion reads settings and facts one after the other, and the values that it finds decide what it reads next. So the
//! verdicts form a tree: each node is a read, each branch a value of it, and each leaf a verdict.

use super::axis::{Axis, AxisSubject};
use super::checker::Verdict;
use framewright_graph::language::{Fact, Read};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The verdicts of all threads, by device.
#[derive(Debug)]
pub(crate) struct SharedDecisions(Vec<Mutex<Decisions>>);

impl SharedDecisions {
    /// None so far, for this number of devices.
    pub(super) fn of(devices: usize) -> SharedDecisions {
        SharedDecisions((0..devices).map(|_| Mutex::default()).collect())
    }

    /// The verdict on a variant, if it is known.
    pub(super) fn find(&self, device: usize, choice: &[usize]) -> Option<Verdict> {
        self.on(device).find(choice).cloned()
    }

    /// Adds the verdict on a variant, which reads these axes in this order.
    pub(super) fn add(&self, device: usize, choice: &[usize], reads: &[usize], verdict: Verdict) {
        self.on(device).add(choice, reads, verdict);
    }

    fn on(&self, device: usize) -> MutexGuard<'_, Decisions> {
        self.0[device].lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The verdicts on one device.
#[derive(Debug, Default)]
struct Decisions {
    root: Option<Node>,
}

#[derive(Debug)]
enum Node {
    /// The number of the axis that is read, and what follows from each of its values.
    Reads { axis: usize, branches: Vec<Option<Node>> },
    /// The verdict, on which no further axis has an influence.
    Known(Verdict),
}

impl Decisions {
    fn find(&self, choice: &[usize]) -> Option<&Verdict> {
        let mut node = self.root.as_ref()?;
        loop {
            match node {
                Node::Known(verdict) => return Some(verdict),
                Node::Reads { axis, branches } => node = branches.get(choice[*axis])?.as_ref()?,
            }
        }
    }

    fn add(&mut self, choice: &[usize], reads: &[usize], verdict: Verdict) {
        let mut node = &mut self.root;
        for axis in reads {
            let branches = match node.get_or_insert_with(|| Node::Reads { axis: *axis, branches: Vec::new() }) {
                Node::Reads { axis: known, branches } if known == axis => branches,
                // Another order of the same reads: they say nothing of this one.
                _ => return,
            };
            let value = choice[*axis];
            if branches.len() <= value {
                branches.resize_with(value + 1, || None);
            }
            node = &mut branches[value];
        }
        node.get_or_insert(Node::Known(verdict));
    }
}

/// The axes that were read, by their numbers, each once. What was read and doesn't vary has none. `settings`: names of the
/// document's settings.
pub(super) fn axes_of(reads: &[Read], settings: &[&str], axes: &[Axis]) -> Vec<usize> {
    let mut numbers = Vec::new();
    for read in reads {
        let is_read = |varied: &AxisSubject| match (read, varied) {
            (Read::Setting(at), AxisSubject::Setting(name)) => settings.get(*at) == Some(&name.as_str()),
            (Read::Fact(read), AxisSubject::Fact(fact)) => parts_of(*read).contains(fact),
            _ => false,
        };
        for (number, _) in axes.iter().enumerate().filter(|(_, axis)| is_read(&axis.varied)) {
            if !numbers.contains(&number) {
                numbers.push(number);
            }
        }
    }
    numbers
}

/// The facts that decide a fact.
fn parts_of(fact: Fact) -> Vec<Fact> {
    match fact {
        Fact::Lights => vec![Fact::Suns, Fact::PointLights],
        fact => vec![fact],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::base::{Code, Diagnostic};

    fn verdict(words: &str) -> Verdict {
        Err(vec![Diagnostic::nowhere(Code::OWN_MISTAKE, words)])
    }

    fn words(found: Option<Verdict>) -> Option<String> {
        found.map(|verdict| verdict.expect_err("a mistake")[0].message.clone())
    }

    #[test]
    fn variants_that_agree_on_what_was_read_share_a_verdict_and_others_do_not() {
        let known = SharedDecisions::of(2);
        known.add(0, &[0, 1, 0], &[1], verdict("one"));
        known.add(0, &[0, 0, 2], &[1, 2], verdict("two"));
        let find = |device: usize, choice: [usize; 3]| words(known.find(device, &choice));
        assert_eq!([find(0, [0, 1, 0]), find(0, [7, 1, 5])], [Some("one".to_owned()), Some("one".to_owned())]);
        assert_eq!([find(0, [3, 0, 2]), find(0, [3, 0, 1])], [Some("two".to_owned()), None]);
        assert_eq!([find(0, [0, 2, 0]), find(1, [0, 1, 0])], [None, None]);
        // The first verdict stays, and another order of reads says nothing.
        known.add(0, &[7, 1, 5], &[1], verdict("three"));
        known.add(0, &[0, 0, 1], &[2], verdict("four"));
        assert_eq!([find(0, [7, 1, 5]), find(0, [0, 0, 1])], [Some("one".to_owned()), None]);
    }

    #[test]
    fn the_number_of_lights_reads_both_of_its_parts_and_what_does_not_vary_is_no_axis() {
        let axis = |varied| Axis::new(varied, vec!["0".to_owned(), "1".to_owned()]);
        let axes =
            [AxisSubject::Fact(Fact::Suns), AxisSubject::Setting("b".to_owned()), AxisSubject::Fact(Fact::PointLights)]
                .map(axis);
        let reads = [Read::Setting(1), Read::Fact(Fact::Objects), Read::Fact(Fact::Lights), Read::Setting(0)];
        assert_eq!(axes_of(&reads, &["a", "b"], &axes), [1, 0, 2]);
    }
}
