//! Notes about extensions and material factors that are ignored: one for each, with the elements that have it.

use super::document::Document;
use super::notes::Notes;

/// Adds a note for each extension that isn't known, and for each factor that no shader reads.
pub(super) fn note(document: &Document, notes: &mut Notes) {
    for (name, elements) in &document.extensions.0 {
        let elements = first_and_count(elements).map_or_else(String::new, |elements| format!(" ({elements})"));
        notes.add(format!("the extension `{}` is not supported, and ignored{elements}", name.escape_debug()));
    }
    let (mut metallic, mut rough) = (Vec::new(), Vec::new());
    for (number, material) in document.materials.iter().enumerate() {
        let Some(material) = material else { continue };
        let pbr = &material.pbr_metallic_roughness;
        // All materials are drawn as non-metals; glTF's default factor is 1, a metal.
        if pbr.metallic_factor.unwrap_or(1.0) != 0.0 {
            metallic.push(format!("material {number}"));
        }
        if pbr.roughness_factor.is_some() {
            rough.push(format!("material {number}"));
        }
    }
    for (factors, materials) in [("metallic factors, 1 where none is given,", metallic), ("roughness factors", rough)] {
        if let Some(materials) = first_and_count(&materials) {
            notes.add(format!("{factors} are ignored ({materials})"));
        }
    }
}

/// The first element, and how many more there are; `None` without elements.
fn first_and_count(elements: &[String]) -> Option<String> {
    match elements {
        [] => None,
        [only] => Some(only.clone()),
        [first, others @ ..] => Some(format!("{first} and {} more", others.len())),
    }
}
