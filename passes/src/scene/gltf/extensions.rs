//! The extensions that a file uses.

use serde_json::Value;
use std::collections::BTreeMap;

/// Extensions that a file may require: those that are read.
pub(super) const READ: [&str; 2] = ["KHR_lights_punctual", "KHR_materials_emissive_strength"];

/// Extensions that are read, or have notes of their own.
const KNOWN: [&str; 3] = ["KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform"];

/// The extensions that aren't known, by name, with the elements that use them ("material 3").
#[derive(Debug, Default)]
pub(super) struct Extensions(pub(super) BTreeMap<String, Vec<String>>);

impl Extensions {
    /// Adds those that an element uses anywhere in it.
    pub(super) fn add_used(&mut self, element: &str, value: &Value) {
        match value {
            Value::Object(members) => {
                for (name, member) in members.iter().filter(|(name, _)| *name != "extras") {
                    if let (true, Value::Object(extensions)) = (name == "extensions", member) {
                        extensions.keys().for_each(|name| self.add(name, Some(element)));
                    }
                    self.add_used(element, member);
                }
            }
            Value::Array(values) => values.iter().for_each(|value| self.add_used(element, value)),
            Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
        }
    }

    /// Adds an extension, if it isn't known. No element need use one that the file lists.
    pub(super) fn add(&mut self, name: &str, element: Option<&str>) {
        if !KNOWN.contains(&name) {
            self.0.entry(name.to_owned()).or_default().extend(element.map(str::to_owned));
        }
    }
}
