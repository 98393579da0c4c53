//! Lights of `KHR_lights_punctual`.

use super::document::{Document, follow};
use super::nodes::Placed;
use super::problem::{GltfError, Problem, at_most, within};
use crate::scene::model::{PointLight, Sun};
use crate::scene::notes::Notes;
use crate::scene::{defaults, limits};
use glam::DVec3;
use std::f64::consts::PI;

pub(super) struct Lights {
    pub(super) sun: Sun,
    pub(super) points: Vec<PointLight>,
    /// Whether the sun isn't the file's.
    pub(super) invented_sun: bool,
}

/// The lights of the scene; the default sun where the file has neither a directional nor a point light.
pub(super) fn read(document: &Document, placed: &[Placed<'_>], notes: &mut Notes) -> Result<Lights, GltfError> {
    let mut sun = None;
    let mut points = Vec::new();
    for Placed { number, node, to_world } in placed {
        let Some(reference) = &node.extensions.light else { continue };
        let light = follow(&document.lights, reference.light, "light", &format!("node {number}"))?;
        let at = format!("light {}", reference.light);
        let within = |what, is: f64| within(what, is, 0.0..=limits::RADIANCE, "0 to 1e9", &at);
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
                if sun.is_none() {
                    let direction = direction.as_vec3().to_array();
                    sun = Some(Sun { direction, color, shadows: true });
                } else {
                    notes.add(format!("{at}: only one directional light is used"));
                }
            }
            "point" => {
                let range = light.range.map(|range| within("its range", range)).transpose()?;
                if range == Some(0.0) {
                    continue;
                }
                let position = to_world.w_axis.truncate();
                if position.abs().max_element() > limits::COORDINATE {
                    let is = format!("{position:?}");
                    return Err(
                        Problem::OutOfRange { what: "its place in the world", is, expected: "at most 1e9 m" }.at(&at)
                    );
                }
                points.push(PointLight {
                    position: position.to_array(),
                    color: color.map(|part| part as f32),
                    intensity: intensity as f32,
                    range: range.map(|range| (range as f32).max(f32::MIN_POSITIVE)),
                    shadows: false,
                });
            }
            "spot" => notes.add(format!("{at}: spot lights are not used")),
            other => {
                let is = other.escape_debug().to_string();
                return Err(Problem::Word { what: "type", is, expected: "directional, point or spot" }.at(&at));
            }
        }
    }
    at_most("point lights", points.len() as u64, limits::POINT_LIGHTS as u64, "")?;
    let dark = Sun { direction: defaults::SUN.direction, color: [0.0; 3], shadows: false };
    let invented_sun = sun.is_none();
    let sun = sun.unwrap_or(if points.is_empty() { Sun { shadows: true, ..defaults::SUN } } else { dark });
    Ok(Lights { sun, points, invented_sun })
}
