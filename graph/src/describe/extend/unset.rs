//! A setting that is removed: presets and views that are there choose nothing for it any more.

use super::super::leaf::Leaf;
use super::draft::Draft;
use super::entry::{Entry, Value};
use super::keyed::Keyed;
use crate::change::Kind;

/// Takes a setting out of `set` of all presets and views.
pub(super) fn everywhere(draft: &mut Draft<'_>, setting: &str) {
    for kind in [Kind::Preset, Kind::View] {
        draft.list_mut(kind).entries.iter_mut().flatten().for_each(|entry| within(entry, setting));
    }
}

fn within(entry: &mut Entry<'_>, setting: &str) {
    let Some(set) = entry.fields().find("set") else { return };
    if let Value::Plain(of) = *set
        && let Some(entries) = of.entries()
    {
        *set = Value::Map { of, entries: Keyed::new(entries, Leaf::words) };
    }
    if let Value::Map { entries, .. } = set {
        entries.take(setting);
    }
}
