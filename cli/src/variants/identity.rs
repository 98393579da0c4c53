//! Whether two Plans are the same, or the same but for values: by hashes of their JSON.

use framewright_graph::plan::{DeviceUsed, Plan};
use serde_json::Value;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// The hashes of a Plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Identity {
    /// The same for the same Plan.
    pub(crate) plan: u64,
    /// The same for Plans that differ in [`VALUES`] alone.
    pub(crate) shape: u64,
}

/// Fields that hold amounts: parameters, fill and clear values, counts of workgroups.
const VALUES: [&str; 3] = ["value", "clear", "groups"];

/// Finds the identities of Plans. Most Plans come many times, so each shape is hashed once.
#[derive(Default)]
pub(super) struct Identities {
    json: Vec<u8>,
    shapes: HashMap<u64, u64>,
}

impl Identities {
    /// The identity of a Plan. Its settings and the device's name don't count.
    pub(super) fn of(&mut self, plan: &Plan) -> Identity {
        let Plan {
            format_version: _,
            device,
            settings: _,
            changes: _,
            stereo,
            views,
            images,
            buffers,
            heaps,
            steps,
            outputs,
            notes,
            totals,
        } = plan;
        let DeviceUsed { name: _, exact_memory } = device;
        let counted = (exact_memory, stereo, views, images, buffers, heaps, steps, outputs, notes, totals);
        self.json.clear();
        // Neither can fail: every part of a Plan has a JSON form, in which numbers that aren't finite are null.
        let _ = serde_json::to_writer(&mut self.json, &counted);
        let plan = hash(&self.json);
        let shape = || hash(without_values(serde_json::to_value(&counted).unwrap_or_default()));
        Identity { plan, shape: *self.shapes.entry(plan).or_insert_with(shape) }
    }
}

fn hash(value: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

fn without_values(json: Value) -> Value {
    match json {
        Value::Array(elements) => elements.into_iter().map(without_values).collect(),
        Value::Object(members) => {
            let shape = members.into_iter().filter(|(name, _)| !VALUES.contains(&&**name));
            shape.map(|(name, member)| (name, without_values(member))).collect()
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn values_leave_the_shape_however_deep_they_stand() {
        let param = |name, value: f32, after| json!([{ "params": { "name": name, "value": [value], "after": after } }]);
        let shape = |json| hash(without_values(json));
        assert_eq!(shape(param("a", 1.0, 1)), shape(param("a", 2.0, 1)));
        assert_ne!(shape(param("a", 1.0, 1)), shape(param("b", 1.0, 1)));
        assert_ne!(shape(param("a", 1.0, 1)), shape(param("a", 1.0, 2)));
    }
}
