//! Lights of `KHR_lights_punctual`.

use super::document::{self, Document, follow};
use super::nodes::PlacedNode;
use super::notes::Notes;
use super::problem::{GltfError, Problem, at_most_in_all, leave_out, within};
use crate::scene::model::{PointLight, Sun};
use crate::scene::{defaults, limits};
use glam::{DMat4, DVec3};
use std::f64::consts::PI;

pub(super) struct Lights {
    pub(super) sun: Sun,
    pub(super) points: Vec<PointLight>,
    /// Whether the sun isn't the file's.
    pub(super) invented_sun: bool,
}

/// The lights of the scene; the default sun where the file has neither a directional nor a point light.
///
/// # Errors
/// Those of the file as a whole.
pub(super) fn read(document: &Document, placed: &[PlacedNode<'_>], notes: &mut Notes) -> Result<Lights, GltfError> {
    let mut sun = None;
    let mut points = Vec::new();
    for PlacedNode { number, node, to_world } in placed {
        let Some(reference) = &node.extensions.light else { continue };
        let at = format!("light {}", reference.light);
        let found = follow(&document.lights, reference.light, "light", &format!("node {number}"));
        match found.and_then(|found| light(found, *to_world, &at)) {
            Ok(Light::Sun(found)) => match sun {
                None => sun = Some(found),
                Some(_) => notes.add(format!("{at}: only one directional light is used")),
            },
            Ok(Light::Point(found)) => points.push(found),
            Ok(Light::Spot) => notes.add(format!("{at}: spot lights are not used")),
            Ok(Light::Dark) => {}
            Err(error) => leave_out(error, &at, notes)?,
        }
    }
    at_most_in_all("point lights", points.len() as u64, limits::POINT_LIGHTS as u64, "")?;
    let dark = Sun { direction: defaults::SUN.direction, color: [0.0; 3], shadows: false };
    let invented_sun = sun.is_none();
    let sun = sun.unwrap_or(if points.is_empty() { Sun { shadows: true, ..defaults::SUN } } else { dark });
    Ok(Lights { sun, points, invented_sun })
}

/// A light of the file.
enum Light {
    Sun(Sun),
    Point(PointLight),
    /// It is not used.
    Spot,
    /// It reaches nowhere.
    Dark,
}

fn light(light: &document::Light, to_world: DMat4, at: &str) -> Result<Light, GltfError> {
    let within = |what, is: f64| within(what, is, 0.0..=limits::RADIANCE, "0 to 1e9", at);
    let mut color = light.color.unwrap_or([1.0; 3]);
    for part in &mut color {
        *part = within("its colour", *part)?;
    }
    // In glTF a white surface scatters 1/π of the light that arrives; here it is 1.
    let intensity = within("its intensity", light.intensity.unwrap_or(1.0))? / PI;
    match light.kind.as_str() {
        "directional" => {
            let direction = (-to_world.z_axis.truncate()).try_normalize().unwrap_or(DVec3::NEG_Y);
            let color = color.map(|part| (part * intensity).min(limits::RADIANCE) as f32);
            Ok(Light::Sun(Sun { direction: direction.as_vec3().to_array(), color, shadows: true }))
        }
        "point" => {
            let range = light.range.map(|range| within("its range", range)).transpose()?;
            if range == Some(0.0) {
                return Ok(Light::Dark);
            }
            let position = to_world.w_axis.truncate();
            if position.abs().max_element() > limits::COORDINATE {
                let is = format!("{position:?}");
                let expected = "at most 1e9 m";
                return Err(Problem::OutOfRange { what: "its place in the world", is, expected }.at(at));
            }
            Ok(Light::Point(PointLight {
                position: position.to_array(),
                color: color.map(|part| part as f32),
                intensity: intensity as f32,
                range: range.map(|range| (range as f32).max(f32::MIN_POSITIVE)),
                shadows: false,
            }))
        }
        "spot" => Ok(Light::Spot),
        other => {
            let is = other.escape_debug().to_string();
            Err(Problem::Word { what: "type", is, expected: "directional, point or spot" }.at(at))
        }
    }
}
