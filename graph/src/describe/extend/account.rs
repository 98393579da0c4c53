//! What files did to a pipeline: for those who look into it, and for messages that would make no sense otherwise.

use super::super::Diagnostic;
use super::super::diagnostic::Label;
use super::super::pipeline::{Name, RemovedPass};
use super::super::tree::Tree;
use crate::change::{Action, Change, Kind};
use crate::source::Span;
use std::sync::Arc;

/// All that was done.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Account {
    /// In the order in which it was done.
    pub(in super::super) changes: Vec<Change>,
    /// What was changed.
    pub(super) changed: Vec<Changed>,
    /// What was removed.
    pub(super) removed: Vec<Removed>,
}

/// An entry that another file changes.
#[derive(Debug, Clone)]
pub(super) struct Changed {
    /// The entry.
    pub(super) entry: Span,
    /// Its name.
    pub(super) name: Name,
    /// The change.
    pub(super) by: Span,
}

/// An entry that is no longer there.
#[derive(Debug, Clone)]
pub(in super::super) struct Removed {
    pub(super) kind: Kind,
    pub(super) name: Name,
    /// Where it is removed.
    pub(super) by: Span,
    /// Of a pass: the texts that it holds.
    pub(super) texts: Vec<Arc<str>>,
}

impl Account {
    /// Something was done.
    pub(super) fn did(&mut self, span: Span, action: Action) {
        self.changes.push(Change { span, action });
    }

    /// The removal of a thing of that name.
    pub(super) fn removed(&self, kind: Kind, name: &str) -> Option<&Removed> {
        self.removed.iter().rev().find(|removed| removed.kind == kind && *removed.name.text == *name)
    }

    /// The passes that were removed.
    pub(in super::super) fn removed_passes(&self) -> impl Iterator<Item = RemovedPass> {
        let passes = self.removed.iter().filter(|removed| removed.kind == Kind::Pass);
        passes.map(|pass| RemovedPass { name: pass.name.text.clone(), span: pass.by, texts: pass.texts.clone() })
    }

    /// Adds to mistakes in entries that were changed, or in what refers to removed ones, the other place.
    pub(in super::super) fn tell(&self, tree: &Tree, errors: &mut [Diagnostic]) {
        if self.changed.is_empty() && self.removed.is_empty() {
            return;
        }
        for error in errors {
            let Some(primary) = error.labels.first().map(|label| label.span) else { continue };
            let has = |within: Span| error.labels.iter().any(|label| holds(within, label.span));
            let named = tree.text_at(primary).trim_matches('"');
            let changed = self.changed.iter().find_map(|changed| match (has(changed.by), has(changed.entry)) {
                (true, false) => Some((changed.name.span, format!("`{}` stands here", changed.name.text))),
                (false, true) if holds(changed.entry, primary) => Some((changed.by, "changed here".to_owned())),
                _ => None,
            });
            let removed = self.removed.iter().rev().find(|removed| *removed.name.text == *named);
            let removed = removed.map(|removed| (removed.by, format!("`{named}` is removed here")));
            let labels = changed.into_iter().chain(removed).map(|(span, text)| Label { span, text });
            error.labels.extend(labels.collect::<Vec<_>>());
        }
    }
}

/// Whether `inner` stands within `outer`.
fn holds(outer: Span, inner: Span) -> bool {
    outer.file() == inner.file() && outer.start <= inner.start && inner.end <= outer.end
}
