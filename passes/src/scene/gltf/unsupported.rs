//! What a file says that isn't drawn, one note for each kind of thing with what says it.

use super::document::Document;
use crate::scene::Notes;
use serde_json::Value;
use std::collections::BTreeMap;

/// Extensions that are read, or have notes of their own.
const KNOWN: [&str; 3] = ["KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform"];

/// The extensions of a file that aren't known, by name.
#[derive(Debug, Default)]
pub(super) struct Extensions(BTreeMap<String, Users>);

/// What says a thing.
#[derive(Debug, Default)]
struct Users {
    first: Option<String>,
    others: usize,
}

impl Users {
    fn add(&mut self, user: String) {
        match self.first {
            None => self.first = Some(user),
            Some(_) => self.others += 1,
        }
    }

    /// The first of them, and how many more there are; nothing if nothing says the thing.
    fn told(&self) -> Option<String> {
        let first = self.first.as_ref()?;
        Some(if self.others == 0 { first.clone() } else { format!("{first} and {} more", self.others) })
    }
}

impl Extensions {
    /// Finds extensions in an element of the file, `at` by its name.
    pub(super) fn used(&mut self, at: &str, value: &Value) {
        match value {
            Value::Object(members) => {
                for (name, member) in members.iter().filter(|(name, _)| *name != "extras") {
                    if let (true, Value::Object(extensions)) = (name == "extensions", member) {
                        self.named(at, extensions.keys());
                    }
                    self.used(at, member);
                }
            }
            Value::Array(values) => values.iter().for_each(|value| self.used(at, value)),
            Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
        }
    }

    /// Extensions that the file says it uses, though nothing in it may.
    pub(super) fn listed(&mut self, names: Vec<String>) {
        for name in names.into_iter().filter(|name| !KNOWN.contains(&name.as_str())) {
            self.0.entry(name).or_default();
        }
    }

    fn named<'n>(&mut self, at: &str, names: impl Iterator<Item = &'n String>) {
        for name in names.filter(|name| !KNOWN.contains(&name.as_str())) {
            self.0.entry(name.clone()).or_default().add(at.to_owned());
        }
    }
}

/// Notes each extension that isn't known, and factors that no shader looks at.
pub(super) fn note(document: &Document, notes: &mut Notes) {
    for (name, users) in &document.extensions.0 {
        let users = users.told().map_or_else(String::new, |users| format!(" ({users})"));
        notes.add(format!("the extension `{}` is not supported, and ignored{users}", name.escape_debug()));
    }
    let (mut metallic, mut rough) = (Users::default(), Users::default());
    for (number, material) in document.materials.iter().enumerate() {
        let pbr = &material.pbr_metallic_roughness;
        // Everything is drawn as what is no metal, and a material that says nothing is one.
        if pbr.metallic_factor.unwrap_or(1.0) != 0.0 {
            metallic.add(format!("material {number}"));
        }
        if pbr.roughness_factor.is_some() {
            rough.add(format!("material {number}"));
        }
    }
    for (which, users) in [("metallic factors, 1 where none is given,", metallic), ("roughness factors", rough)] {
        if let Some(users) = users.told() {
            notes.add(format!("{which} are ignored ({users})"));
        }
    }
}
