//! What custom passes declare, held against what was recorded: by the contents that they leave, and by what the validation layer finds.

use crate::base::{BrokenPromise, Error};
use crate::gpu::{Gpu, Message};
use crate::prepare::{DeclaredUse, WatchedStep, declared_uses, numbered_titles, watch_list};
use crate::record::{PassWatch, UntouchedTexels};
use framewright_graph::plan::Plan;
use std::sync::Arc;

/// The promises of a Plan's custom passes.
pub(super) struct Promises {
    pub(super) steps: Arc<[WatchedStep]>,
    declared: Vec<DeclaredUse>,
    /// The labels of the Plan's steps.
    titles: Vec<String>,
    untouched: UntouchedTexels,
    /// How many messages of the layer were heard.
    heard: usize,
    /// What was found and not told yet.
    broken: Vec<BrokenPromise>,
}

impl Promises {
    /// Those of `plan`.
    pub(super) fn new(gpu: &Gpu, plan: &Plan) -> Result<Promises, Error> {
        let heard = gpu.instance.validation.as_ref().map_or(0, |it| it.messages.list().len());
        let steps = watch_list(plan, &|queue| gpu.queues.families.family(queue).index)?.into();
        Ok(Promises {
            steps,
            declared: declared_uses(plan),
            titles: numbered_titles(plan).collect(),
            untouched: UntouchedTexels::default(),
            heard,
            broken: Vec::new(),
        })
    }

    /// Looks at what a frame that was waited for left, and at what the layer has said since it was asked last.
    pub(super) fn look(&mut self, gpu: &Gpu, watch: Option<&PassWatch>) -> Result<(), Error> {
        if let Some(watch) = watch {
            self.broken.extend(watch.broken(&mut self.untouched)?);
        }
        let Some(validation) = &gpu.instance.validation else { return Ok(()) };
        let said = validation.messages.list();
        for message in said.iter().skip(self.heard).filter(|it| it.is_finding()) {
            for promise in broken_by(&self.declared, &self.titles, message) {
                if !self.broken.contains(&promise) {
                    self.broken.push(promise);
                }
            }
        }
        self.heard = said.len();
        Ok(())
    }

    /// Has what an executor before found and didn't tell. What the layer said meanwhile was looked at by both.
    pub(super) fn take_over(&mut self, before: &mut Promises) {
        for promise in std::mem::take(&mut before.broken) {
            if !self.broken.contains(&promise) {
                self.broken.push(promise);
            }
        }
    }

    /// What was found, which is told once.
    pub(super) fn told(&mut self) -> Result<(), Error> {
        match std::mem::take(&mut self.broken) {
            promises if promises.is_empty() => Ok(()),
            promises => Err(Error::BrokenPromises { promises }),
        }
    }
}

/// The declared uses that a message of the layer is about: those of what its text names, at the step that was recorded or before it; where
/// it names nothing of that kind, those of the step. A message about a step of another Plan is about none.
fn broken_by(declared: &[DeclaredUse], titles: &[String], message: &Message) -> Vec<BrokenPromise> {
    let labels = message.at.as_deref().unwrap_or_default();
    let step = step_of(titles, labels);
    if step.is_none() && labels.split(", ").any(|label| label.starts_with("step ")) {
        // Another executor recorded it.
        return Vec::new();
    }
    let done = format!("the validation layer finds: {}", message.located());
    let is_named = |it: &&DeclaredUse| message.text.contains(&format!("[{}]", it.name));
    let reached = |it: &&DeclaredUse| step.is_none_or(|step| it.step <= step);
    let of_step = |it: &&DeclaredUse| Some(it.step) == step;
    let named: Vec<_> = declared.iter().filter(is_named).filter(reached).collect();
    let of = match named.iter().any(of_step) || named.is_empty() {
        true if named.is_empty() => declared.iter().filter(of_step).collect(),
        true => named.into_iter().filter(of_step).collect(),
        false => named,
    };
    let promise = |it: &DeclaredUse| BrokenPromise {
        passes: vec![(it.pass.clone(), it.at.clone())],
        resource: it.name.clone(),
        declared: Some(it.said.clone()),
        done: done.clone(),
    };
    of.into_iter().map(promise).collect()
}

/// The number of the step whose label is among these. The program may have put its own around it, and a pass has one within.
fn step_of(titles: &[String], labels: &str) -> Option<usize> {
    titles.iter().position(|title| {
        labels.match_indices(&**title).any(|(at, _)| {
            let (before, behind) = (&labels[..at], &labels[at + title.len()..]);
            (before.is_empty() || before.ends_with(", ")) && (behind.is_empty() || behind.starts_with(", "))
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{MessageKind, Severity};

    fn declared(step: usize, pass: &str, name: &str) -> DeclaredUse {
        DeclaredUse { step, pass: pass.to_owned(), at: None, name: name.to_owned(), said: "COPY".to_owned() }
    }

    /// DO-8: a hazard is a promise of the pass that was recorded, or of those before it that declare what it names.
    #[test]
    fn do_8_a_finding_is_led_back_to_declarations() {
        let all = [declared(1, "first", "mask"), declared(2, "second", "mask"), declared(2, "second", "list")];
        let titles = ["step 0: draw", "step 1: first", "step 2: second", "step 3: show"].map(str::to_owned);
        let said = |text: &str, at: Option<&str>| {
            let (severity, kind) = (Severity::Error, MessageKind::Validation);
            let (id, text, at) = ("SYNC".to_owned(), text.to_owned(), at.map(str::to_owned));
            let broken = broken_by(&all, &titles, &Message { severity, kind, id, text, at });
            broken.into_iter().map(|it| format!("{} {}", it.passes[0].0, it.resource)).collect::<Vec<_>>()
        };
        assert_eq!(said("of VkImage 0x7[mask]", Some("step 2: second")), ["second mask"]);
        assert_eq!(said("of VkImage 0x7[mask]", Some("step 3: show")), ["first mask", "second mask"]);
        assert_eq!(said("of VkImage 0x7[mask]", Some("step 1: first, own")), ["first mask"]);
        assert_eq!(said("of VkImage 0x7[mask]", None), ["first mask", "second mask"]);
        assert_eq!(said("a scope is open", Some("step 2: second")), ["second mask", "second list"]);
        assert_eq!(said("of VkImage 0x7[mask]", Some("mine, step 1: first, own")), ["first mask"]);
        for others in ["step 2: third", "step 2: secondary, own", "step 4: own"] {
            assert_eq!(said("of VkImage 0x7[mask]", Some(others)), [""; 0], "{others}");
        }
        assert_eq!(said("of VkImage 0x7[masks]", Some("step 0: draw")), [""; 0]);
    }
}
