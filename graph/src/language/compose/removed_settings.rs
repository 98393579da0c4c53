//! Settings that are removed: presets and views that name them choose nothing for them any more.

use super::draft::Draft;
use super::entry::{Entry, Value};
use super::keyed_fields::KeyedFields;
use crate::frame::change::Kind;
use crate::ron::Leaf;
use std::collections::HashSet;
use std::sync::Arc;

/// Takes removed settings, unless they are declared again, out of `set` of all presets and views.
pub(crate) fn everywhere(draft: &mut Draft<'_>, removed: &HashSet<Arc<str>>) {
    let settings = draft.list_mut(Kind::Setting);
    let gone: HashSet<Arc<str>> = removed.iter().filter(|name| settings.find(name).is_none()).cloned().collect();
    if gone.is_empty() {
        return;
    }
    for kind in [Kind::Preset, Kind::View] {
        draft.list_mut(kind).entries.iter_mut().flatten().for_each(|entry| within(entry, &gone));
    }
}

fn within(entry: &mut Entry<'_>, gone: &HashSet<Arc<str>>) {
    // An entry that is no preset stays as it is: the mistake is reported later.
    if entry.leaf.fields().is_none() {
        return;
    }
    let Some(set) = entry.fields().find("set") else { return };
    if let Value::Plain(of) = *set
        && let Some(entries) = of.entries()
    {
        *set = Value::Map { of, entries: KeyedFields::new(entries, Leaf::words) };
    }
    if let Value::Map { entries, .. } = set {
        let named = entries.pairs().filter_map(|(key, _)| key.plain()).filter(|key| gone.contains(*key));
        let named: Vec<String> = named.map(str::to_owned).collect();
        for name in named {
            entries.take(&name);
        }
    }
}
