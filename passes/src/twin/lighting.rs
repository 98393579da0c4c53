//! Twin of `shaders/include/lighting.glsl` and `shaders/include/surface.glsl`. Sources of the formulas stand there.

use super::radiance::{guard_alpha, guard_radiance};
use crate::scene::{AlphaMode, Material, Scene};
use glam::DVec3;

/// Share of light that any plain dielectric (refractive index 1.5) mirrors head-on.
const HEAD_ON_REFLECTANCE: f64 = 0.04;
/// Blinn-Phong exponent.
const SHININESS: f64 = 64.0;

/// No surface mirrors more than this share of the sun's colour, for any normal and any direction of view: the largest
/// value of `max(n · l, 0) · highlight(n, v, l)` over all unit vectors is 0.7986.
pub const LARGEST_HIGHLIGHT: f64 = 0.8;

/// The share of arriving light that is mirrored towards the camera. All three are unit vectors.
#[must_use]
pub fn highlight(normal: DVec3, to_camera: DVec3, to_light: DVec3) -> f64 {
    let halfway = (to_light + to_camera).normalize_or_zero();
    let grazing = (1.0 - to_camera.dot(halfway).clamp(0.0, 1.0)).powi(5);
    let tightness = (SHININESS + 8.0) / 8.0 * normal.dot(halfway).clamp(0.0, 1.0).powf(SHININESS);
    (HEAD_ON_REFLECTANCE + (1.0 - HEAD_ON_REFLECTANCE) * grazing) * tightness
}

/// Light that a surface reflects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReflectedLight {
    /// Scattered by a white surface.
    pub diffuse: DVec3,
    /// Mirrored by any surface.
    pub specular: DVec3,
}

/// The light that a surface reflects to the camera. Its `position` and unit `normal` are in the scene's own coordinates.
/// `sunlit` is the share of the sun's light that arrives there, 0 to 1.
#[must_use]
pub fn reflect_light(scene: &Scene, position: DVec3, normal: DVec3, sunlit: f64) -> ReflectedLight {
    let vector = |components: [f32; 3]| DVec3::from_array(components.map(f64::from));
    let to_sun = -vector(scene.sun.direction);
    let from_sun = vector(scene.sun.color) * (sunlit * normal.dot(to_sun).max(0.0));
    let nearest = scene.nearest_to_light();
    let from_points = scene.point_lights.iter().map(|light| {
        let towards = DVec3::from(light.position) - position;
        let facing = normal.dot(towards.normalize_or_zero()).max(0.0);
        vector(light.color) * (f64::from(light.intensity) * facing * light.falloff(towards.length(), nearest))
    });
    let to_camera = (scene.camera.position() - position).normalize_or_zero();
    ReflectedLight {
        diffuse: vector(scene.ambient) + from_sun + from_points.sum::<DVec3>(),
        specular: from_sun * highlight(normal, to_camera, to_sun),
    }
}

/// The colour of a lit surface, multiplied by its alpha, and that alpha.
#[must_use]
pub fn lit_surface(material: &Material, base_color: [f64; 4], reflected: &ReflectedLight) -> [f64; 4] {
    let [red, green, blue, alpha] = base_color;
    let alpha = if material.alpha == AlphaMode::Blend { alpha.clamp(0.0, 1.0) } else { 1.0 };
    let scattered = DVec3::new(red, green, blue) * reflected.diffuse * alpha;
    let emissive = DVec3::from_array(material.emissive.map(f64::from));
    let radiance = (scattered + reflected.specular + emissive).to_array().map(guard_radiance);
    [radiance[0], radiance[1], radiance[2], guard_alpha(alpha)]
}
