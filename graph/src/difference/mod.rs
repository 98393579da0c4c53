//! The differences between two Plans: what a change to a file, a setting or a device does to passes, resolves, barriers, memory
//! and bytes.
//!
//! Each Plan is described as a list of entries: passes, images, barriers and others, each with its fields as text. Entries of one
//! kind and name are compared with each other. Numbers of steps and offsets in memory are no part of it: they change with
//! everything that is inserted before them.

mod describe;
mod markdown;
mod steps;
mod text;

use crate::base::Place;
use crate::plan::{DeviceUsed, Plan, SettingUsed};
use describe::{Description, describe, figures};
use serde::Serialize;
use std::collections::BTreeMap;

pub use crate::plan::EntryKind as Kind;

/// The version of the JSON form of [`Differences`].
pub const FORMAT_VERSION: u32 = 1;

/// The differences between two Plans, the first called A and the second B.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Differences {
    /// [`FORMAT_VERSION`].
    pub format_version: u32,
    /// A.
    pub a: Side,
    /// B.
    pub b: Side,
    /// Sums, those that are equal too.
    pub totals: Vec<Figure>,
    /// The things that only one of them has, or that differ: kind by kind.
    pub entries: Vec<Entry>,
}

/// The frame that a Plan is for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Side {
    /// The name that the caller gave it.
    pub name: String,
    /// The device.
    pub device: DeviceUsed,
    /// The settings in force.
    pub settings: Vec<SettingUsed>,
}

/// A sum over each Plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Figure {
    /// Its name.
    pub name: &'static str,
    /// Whether it counts bytes.
    pub bytes: bool,
    /// In A.
    pub a: u64,
    /// In B.
    pub b: u64,
}

/// Something that only one Plan has, or that differs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Entry {
    /// Its kind.
    pub kind: Kind,
    /// Its name in words. Names from files stand between backticks, with control characters escaped.
    pub name: String,
    /// How it differs.
    #[serde(flatten)]
    pub change: Change,
    /// Why it is there, if the compiler inserted it.
    pub because: Option<String>,
    /// The line that says so or caused it.
    pub at: Option<Place>,
}

/// How an entry differs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case", tag = "change")]
pub enum Change {
    /// Only B has it.
    Added {
        /// Its fields.
        fields: Vec<Field>,
    },
    /// Only A has it.
    Removed {
        /// Its fields.
        fields: Vec<Field>,
    },
    /// Both have it.
    Changed {
        /// Those of its fields that differ.
        fields: Vec<Field>,
    },
}

/// A field of an entry.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// Its value in A; `None`: it has none.
    pub a: Option<String>,
    /// Its value in B.
    pub b: Option<String>,
}

impl Differences {
    /// Finds them. Each Plan has a name, such as that of its file.
    #[must_use]
    pub fn between((name_of_a, a): (&str, &Plan), (name_of_b, b): (&str, &Plan)) -> Differences {
        let side = |name: &str, plan: &Plan| Side {
            name: name.to_owned(),
            device: plan.device.clone(),
            settings: plan.settings.clone(),
        };
        let totals = figures(a).into_iter().zip(figures(b));
        let totals = totals.map(|((name, bytes, a), (_, _, b))| Figure { name, bytes, a, b });
        Differences {
            format_version: FORMAT_VERSION,
            a: side(name_of_a, a),
            b: side(name_of_b, b),
            totals: totals.collect(),
            entries: entries(describe(a), describe(b)),
        }
    }

    /// Whether nothing differs.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty() && self.a.device == self.b.device && self.totals.iter().all(|it| it.a == it.b)
    }
}

/// Entries of one kind and name are compared in their order; then those that only the passes of their steps tell apart.
fn entries(of_a: Vec<Description>, of_b: Vec<Description>) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut compare = |of_a: Vec<Description>, of_b: Vec<Description>, name: fn(&Description) -> &str| {
        let mut found: BTreeMap<(Kind, String), Vec<Description>> = BTreeMap::new();
        for one in of_a.into_iter().rev() {
            found.entry((one.kind, name(&one).to_owned())).or_default().push(one);
        }
        let mut left = Vec::new();
        for b in of_b {
            match found.get_mut(&(b.kind, name(&b).to_owned())).and_then(Vec::pop) {
                None => left.push(b),
                Some(a) => {
                    let name = name(&b).to_owned();
                    let fields = differing(a.fields, &b.fields);
                    if !fields.is_empty() {
                        entries.push(Entry { name, ..b.entry(|_| Change::Changed { fields }) });
                    }
                }
            }
        }
        (found.into_values().flat_map(|left| left.into_iter().rev()).collect(), left)
    };
    let (of_a, of_b) = compare(of_a, of_b, |one| &one.name);
    let (of_a, of_b) = compare(of_a, of_b, |one| one.of_itself.as_ref().unwrap_or(&one.name));
    let added = |b: Description| b.entry(|fields| Change::Added { fields: of_one(fields, |value| (None, value)) });
    let removed = |a: Description| a.entry(|fields| Change::Removed { fields: of_one(fields, |value| (value, None)) });
    entries.extend(of_b.into_iter().map(added));
    entries.extend(of_a.into_iter().map(removed));
    // Stable: what both have, then what only B has, then what only A has.
    entries.sort_by_key(|entry| entry.kind);
    entries
}

type Values = (Option<String>, Option<String>);

fn of_one(fields: Vec<(&'static str, String)>, values: impl Fn(Option<String>) -> Values) -> Vec<Field> {
    let field = |(name, value)| {
        let (a, b) = values(Some(value));
        Field { name, a, b }
    };
    fields.into_iter().map(field).collect()
}

/// The fields that differ, in their order.
fn differing(a: Vec<(&'static str, String)>, b: &[(&'static str, String)]) -> Vec<Field> {
    let mut fields = Vec::new();
    let in_b = |name: &str| b.iter().find(|(other, _)| *other == name).map(|(_, value)| value.clone());
    for (name, value) in &a {
        let (a, b) = (Some(value.clone()), in_b(name));
        if a != b {
            fields.push(Field { name, a, b });
        }
    }
    let new = b.iter().filter(|(name, _)| !a.iter().any(|(other, _)| other == name));
    fields.extend(new.map(|(name, value)| Field { name, a: None, b: Some(value.clone()) }));
    fields
}
