//! The change log: changes that files made to a pipeline that they extend. Messages name the change that led to a mistake.

use crate::base::{Code, Diagnostic, Label, Span};
use crate::frame::change::{Action, Change, Kind};
use crate::language::model::RemovedPass;
use crate::ron::{Name, Tree};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// The change log: all changes, and the entries that they changed or removed.
#[derive(Debug, Clone, Default)]
pub(crate) struct ChangeLog {
    /// All changes, in the order in which they were made.
    pub(crate) changes: Vec<Change>,
    /// The entries that were changed.
    pub(crate) changed: Vec<ChangedEntry>,
    /// The entries that were removed.
    removed: Vec<RemovedEntry>,
    /// The last removal of a thing, by kind and name.
    last_removed: HashMap<(Kind, Arc<str>), usize>,
}

/// An entry that another file changes.
#[derive(Debug, Clone)]
pub(crate) struct ChangedEntry {
    /// The entry.
    pub(crate) entry: Span,
    /// Its name.
    pub(crate) name: Name,
    /// The change.
    pub(crate) by: Span,
}

/// An entry that is no longer there.
#[derive(Debug, Clone)]
pub(crate) struct RemovedEntry {
    pub(crate) kind: Kind,
    pub(crate) name: Name,
    /// Where it is removed.
    pub(crate) by: Span,
    /// The texts in a pass; empty for other entries.
    pub(crate) texts: Vec<Arc<str>>,
}

impl ChangeLog {
    /// Notes a change.
    pub(crate) fn did(&mut self, span: Span, action: Action) {
        self.changes.push(Change { span, action });
    }

    /// The removal of a thing of that name.
    pub(crate) fn removed(&self, kind: Kind, name: &str) -> Option<&RemovedEntry> {
        self.last_removed.get(&(kind, name.into())).map(|at| &self.removed[*at])
    }

    /// Notes a removal.
    pub(crate) fn remove(&mut self, removed: RemovedEntry) {
        self.last_removed.insert((removed.kind, removed.name.text.clone()), self.removed.len());
        self.removed.push(removed);
    }

    /// The passes that were removed.
    pub(crate) fn removed_passes(&self) -> impl Iterator<Item = RemovedPass> {
        let passes = self.removed.iter().filter(|removed| removed.kind == Kind::Pass);
        passes.map(|pass| RemovedPass { name: pass.name.text.clone(), span: pass.by, texts: pass.texts.clone() })
    }

    /// Adds the other place to mistakes in changed entries, and to mistakes in references to removed entries.
    pub(crate) fn tell(&self, tree: &Tree, errors: &mut [Diagnostic]) {
        if self.changed.is_empty() && self.removed.is_empty() {
            return;
        }
        let places = ChangeIndex::of(&self.changed);
        let removed: HashMap<(Kind, &str), Span> =
            self.removed.iter().map(|removed| ((removed.kind, &*removed.name.text), removed.by)).collect();
        for error in errors {
            let Some(primary) = error.labels.first().map(|label| label.span) else { continue };
            let changed = self.beside(&places, error);
            let named = tree.text_at(primary).trim_matches('"');
            let missed = missed(error.code).iter();
            let removed = missed.filter_map(|kind| removed.get(&(*kind, named))).max_by_key(|by| (by.file(), by.start));
            let removed = removed.map(|by| Label::new(*by, format!("`{named}` is removed here")));
            error.labels.extend(changed.into_iter().chain(removed));
        }
    }

    /// The second place of a mistake: the changed entry of a mistake in a change, the change of a mistake in a changed entry.
    fn beside(&self, places: &ChangeIndex, error: &Diagnostic) -> Option<Label> {
        let is_in = |within: Span| error.labels.iter().any(|label| holds(within, label.span));
        let in_changes = error.labels.iter().flat_map(|label| places.changes(&self.changed, label.span));
        let in_change = in_changes.filter(|at| !is_in(self.changed[*at].entry)).min();
        // The first change of the entry at each place of the mistake is enough.
        let in_entries = error.labels.iter().map(|label| places.entries(&self.changed, label.span));
        let mut in_entries = in_entries.map(|changes| changes.iter().find(|at| !is_in(self.changed[**at].by)));
        let in_entry = in_entries.find_map(|at| at.copied());
        let by_change = |at: usize| {
            let ChangedEntry { name, .. } = &self.changed[at];
            Label::new(name.span, format!("`{}` stands here", name.text))
        };
        let by_entry = |at: usize| Label::new(self.changed[at].by, "changed here");
        match (in_change, in_entry) {
            (Some(change), Some(entry)) if entry < change => Some(by_entry(entry)),
            (Some(change), _) => Some(by_change(change)),
            (None, entry) => entry.map(by_entry),
        }
    }
}

/// An index of changes by place: the numbers in [`ChangeLog::changed`], by the file and the first byte of the change and of
/// the changed entry. No change is within another change, and no entry within another entry.
struct ChangeIndex {
    by: BTreeMap<(Option<usize>, u32), Vec<usize>>,
    entries: BTreeMap<(Option<usize>, u32), Vec<usize>>,
}

impl ChangeIndex {
    fn of(changed: &[ChangedEntry]) -> ChangeIndex {
        let mut places = ChangeIndex { by: BTreeMap::new(), entries: BTreeMap::new() };
        for (at, ChangedEntry { entry, by, .. }) in changed.iter().enumerate() {
            places.by.entry((by.file(), by.start)).or_default().push(at);
            places.entries.entry((entry.file(), entry.start)).or_default().push(at);
        }
        places
    }

    /// The changes that `place` stands in.
    fn changes(&self, changed: &[ChangedEntry], place: Span) -> impl Iterator<Item = usize> {
        last(&self.by, place).iter().copied().filter(move |at| holds(changed[*at].by, place))
    }

    /// The changes of the entry that `place` stands in.
    fn entries(&self, changed: &[ChangedEntry], place: Span) -> &[usize] {
        let changes = last(&self.entries, place);
        let inside = changes.first().is_some_and(|at| holds(changed[*at].entry, place));
        if inside { changes } else { &[] }
    }
}

/// The changes that begin last before `place`, or with it.
fn last(places: &BTreeMap<(Option<usize>, u32), Vec<usize>>, place: Span) -> &[usize] {
    let before = places.range(..=(place.file(), place.start)).next_back();
    before.map_or(&[], |(_, numbers)| numbers)
}

/// The kinds of thing that a mistake misses.
fn missed(code: Code) -> &'static [Kind] {
    match code {
        // A setting of that name may have been meant.
        Code::UNKNOWN_SETTING | Code::TEXT_WITHOUT_QUOTES => &[Kind::Setting],
        Code::UNKNOWN_PRESET => &[Kind::Preset],
        Code::UNKNOWN_VIEW => &[Kind::View],
        Code::UNKNOWN_IMAGE => &[Kind::Image, Kind::Texture],
        Code::UNKNOWN_BUFFER => &[Kind::Buffer],
        Code::UNKNOWN_IMAGE_OR_BUFFER => &[Kind::Image, Kind::Texture, Kind::Buffer],
        Code::UNKNOWN_PASS => &[Kind::Pass],
        Code::UNKNOWN_VALUE => &[Kind::Setting, Kind::Image, Kind::Texture, Kind::Buffer],
        _ => &[],
    }
}

/// Whether `inner` stands within `outer`.
fn holds(outer: Span, inner: Span) -> bool {
    outer.file() == inner.file() && outer.start <= inner.start && inner.end <= outer.end
}
