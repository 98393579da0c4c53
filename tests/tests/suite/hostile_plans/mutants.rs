//! Changes to the JSON form of a Plan.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// A changed Plan, and how it came about.
pub(super) struct Mutant {
    pub(super) how: String,
    pub(super) text: String,
}

/// Fields for readers alone: no change of them changes what is drawn.
const EXPLANATIONS: [&str; 16] = [
    "after",
    "needed_by",
    "hazard",
    "cause",
    "because",
    "merged",
    "notes",
    "decided",
    "changes",
    "settings",
    "chosen",
    "encoded",
    "encoding",
    "hand_overs",
    "allows",
    "totals",
];

/// Numbers that something may stumble over.
const NUMBERS: [u64; 12] = [0, 1, 2, 3, 7, 64, 4096, 65_536, 1_000_000_000, 0xffff_fffe, 0xffff_ffff, u64::MAX];

/// The values that stand under each name in some Plans.
#[derive(Default)]
pub(super) struct Vocabulary(BTreeMap<String, BTreeMap<String, Value>>);

/// Whether a field explains something, and nothing more.
fn explains(path: &str) -> bool {
    path.split('/').any(|part| EXPLANATIONS.contains(&part))
}

/// The name of the field that a path leads to or into.
fn field(path: &str) -> &str {
    path.rsplit('/').find(|part| part.parse::<u32>().is_err()).unwrap_or_default()
}

impl Vocabulary {
    /// Adds all values of a Plan.
    pub(super) fn add(&mut self, plan: &Value) {
        for (path, value) in places(plan) {
            if !explains(&path) && !value.is_number() {
                self.0.entry(field(&path).to_owned()).or_default().insert(value.to_string(), value.clone());
            }
        }
    }

    /// Other values for a place.
    fn others(&self, path: &str, value: &Value) -> Vec<Value> {
        let seen = self.0.get(field(path)).into_iter().flat_map(BTreeMap::values).filter(|other| *other != value);
        let mut others: Vec<Value> = seen.take(12).cloned().collect();
        match value {
            Value::Bool(truth) => others.push((!truth).into()),
            Value::Number(number) => {
                let near = number.as_u64().into_iter().flat_map(|it| [it.saturating_sub(1), it + 1, 2 * it]);
                others.extend(NUMBERS.into_iter().chain(near).map(Value::from));
                others.extend([-1.0, 0.5, 1e30, -3e38].map(Value::from));
            }
            Value::String(text) => {
                others.extend(["", "a\u{0}b\n\u{202e}`<", "../../etc/passwd", "/dev/zero"].map(Value::from));
                others.push("long".repeat(5000).into());
                // Flags, one less and one more.
                let flags: Vec<&str> = text.split(" | ").collect();
                let without = |at: usize| [&flags[..at], &flags[at + 1..]].concat().join(" | ");
                others.extend((0..flags.len()).map(|at| without(at).into()));
                let more = self.0.get(field(path)).into_iter().flat_map(BTreeMap::values).filter_map(Value::as_str);
                let more: BTreeSet<&str> = more.flat_map(|text| text.split(" | ")).collect();
                let more = more.into_iter().filter(|flag| !flag.is_empty() && !flags.contains(flag));
                others.extend(more.map(|flag| format!("{text} | {flag}").into()));
            }
            Value::Array(list) => {
                others.push(Vec::<Value>::new().into());
                if let [first, rest @ ..] = &list[..] {
                    others.push(rest.to_vec().into());
                    others.push([&list[..], std::slice::from_ref(first)].concat().into());
                    others.push(list.iter().rev().cloned().collect::<Vec<_>>().into());
                }
            }
            Value::Object(_) => others.push(Value::Null),
            Value::Null => {}
        }
        let mut told = BTreeSet::from([value.to_string()]);
        others.retain(|other| told.insert(other.to_string()));
        others
    }

    /// Every change of one place, then every change of all equal values under one name at once.
    pub(super) fn mutants(&self, name: &str, plan: &Value) -> Vec<(String, Vec<String>, Value)> {
        let mut all = Vec::new();
        let mut alike: BTreeMap<(String, String), (Value, Vec<String>)> = BTreeMap::new();
        for (path, value) in places(plan) {
            if explains(&path) {
                continue;
            }
            for other in self.others(&path, &value) {
                all.push((format!("{name}{path}"), vec![path.clone()], other));
            }
            let key = (field(&path).to_owned(), value.to_string());
            alike.entry(key).or_insert_with(|| (value, Vec::new())).1.push(path);
        }
        for ((field, _), (value, paths)) in alike.into_iter().filter(|(_, (_, paths))| paths.len() > 1) {
            for other in self.others(&format!("/{field}"), &value) {
                all.push((format!("{name}: all `{field}` {}", short(&value)), paths.clone(), other));
            }
        }
        all
    }
}

/// A Plan with another value in some places.
pub(super) fn changed(plan: &Value, (how, paths, value): (String, Vec<String>, Value)) -> Mutant {
    let mut plan = plan.clone();
    for path in &paths {
        // The change of a list may have taken others away.
        if let Some(place) = plan.pointer_mut(path) {
            *place = value.clone();
        }
    }
    Mutant { how: format!("{how} → {}", short(&value)), text: plan.to_string() }
}

fn short(value: &Value) -> String {
    value.to_string().chars().take(160).collect()
}

/// Every place in a JSON text, with the path to it; the whole is none.
fn places(plan: &Value) -> Vec<(String, Value)> {
    fn walk(value: &Value, path: &str, found: &mut Vec<(String, Value)>) {
        if !path.is_empty() {
            found.push((path.to_owned(), value.clone()));
        }
        match value {
            Value::Array(list) => (0..).zip(list).for_each(|(at, one)| walk(one, &format!("{path}/{at}"), found)),
            Value::Object(fields) => fields.iter().for_each(|(name, one)| walk(one, &format!("{path}/{name}"), found)),
            _ => {}
        }
    }
    let mut found = Vec::new();
    walk(plan, "", &mut found);
    found
}
