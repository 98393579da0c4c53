//! A setting that is removed: presets and views that are there choose nothing for it any more.

use super::draft::Draft;
use super::entry::{Entry, Value};
use crate::change::Kind;

/// Takes a setting out of `set` of all presets and views.
pub(super) fn everywhere(draft: &mut Draft<'_>, setting: &str) {
    for kind in [Kind::Preset, Kind::View] {
        draft.list_mut(kind).entries.iter_mut().flatten().for_each(|entry| within(entry, setting));
    }
}

fn within(entry: &mut Entry<'_>, setting: &str) {
    let leaf = entry.leaf;
    let written = || leaf.fields().into_iter().flatten().map(|(name, value)| (name, Value::Plain(value))).collect();
    let fields = entry.fields.get_or_insert_with(written);
    let Some((_, set)) = fields.iter_mut().find(|(field, _)| field.text() == "set") else { return };
    if let Value::Plain(of) = *set
        && let Some(entries) = of.entries()
    {
        *set = Value::Map { of, entries: entries.collect() };
    }
    if let Value::Map { entries, .. } = set {
        entries.retain(|(key, _)| key.plain() != Some(setting));
    }
}
