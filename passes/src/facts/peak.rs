//! An upper bound of the radiance that a pixel can show before any effect: the fact `scene.peak_radiance`.
//!
//! It holds for the lighting rule of [`crate::scene`], for highlights as the shipped shaders mirror the sun, and for what
//! is drawn in the usual order: opaque objects, sky, transparent objects blended over both. It holds from any place and in
//! any direction. Each channel is bounded by itself, in 64 bits; the fact is the largest channel, at most 65504.
//!
//! - **Sky**: the brightest of zenith, horizon and ground, and what the sun adds where it is seen
//!   ([`crate::twin::sky::sunward_share`]).
//! - **A surface**: its base colour times all light that can arrive, a highlight of 0.8 of the sun's colour
//!   ([`crate::twin::lighting::LARGEST_HIGHLIGHT`]), and what it emits. Its base colour is the factor times the brightest
//!   texel of its texture; filters and mip levels only average. Light is the ambient light, the sun at right angle, and each
//!   point light at right angle from its distance to the object's box, or to its nearest triangle if it is in the box.
//! - **Transparent surfaces** cover a share of what is behind, but their highlights and emitted light come on top undimmed.
//!   With `s` the most that a layer adds and `a` the least opacity, any number of layers add at most `s + s·(1 − a) + … =
//!   s/a`; and never more than all triangles of all such objects together.
//!
//! A bound of 1 or less proves that nothing is brighter than 1; one above 1 proves nothing. Sums are taken as if each light
//! reached a surface where it is nearest, all at once, so rooms full of lights are bounded loosely.

use crate::scene::{AlphaMode, Object, PointLight, Scene};
use crate::srgb;
use crate::twin::lighting::LARGEST_HIGHLIGHT;
use crate::twin::radiance::LARGEST_HALF;
use crate::twin::sky;
use glam::DVec3;

/// The bound, and what decides it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Peak {
    /// Linear, 0 to 65504.
    pub(super) radiance: f64,
    /// The index of the object that decides; `None`: the sky.
    pub(super) object: Option<usize>,
    /// How much of it transparent surfaces in front may add.
    pub(super) added: f64,
}

/// The extremes of a texture's texels.
#[derive(Clone, Copy)]
struct Extremes {
    brightest: DVec3,
    least_alpha: f64,
}

/// The bound for a scene.
pub(super) fn peak(scene: &Scene) -> Peak {
    let sun = vector(scene.sun.color);
    let textures: Vec<Extremes> = scene.textures.iter().map(|texture| extremes(&texture.rgba8)).collect();
    let to_sun = -vector(scene.sun.direction);
    let brightest_sky = vector(scene.sky.zenith).max(vector(scene.sky.horizon)).max(vector(scene.sky.ground));
    let sky = brightest_sky + sun * sky::sunward_share(to_sun.y);

    let nearest = scene.nearest_to_light();
    let mut candidates = vec![(None, sky)];
    // What transparent surfaces add at most: one of them, and all triangles together. Then their least opacity.
    let (mut most, mut all, mut opacity) = (DVec3::ZERO, DVec3::ZERO, 1.0_f64);
    for (number, object) in scene.objects.iter().enumerate() {
        let material = &scene.materials[object.material];
        let texture = material.base_color_texture.map(|texture| textures[texture]);
        let texture = texture.unwrap_or(Extremes { brightest: DVec3::ONE, least_alpha: 1.0 });
        let [red, green, blue, alpha] = material.base_color.map(f64::from);
        let scattered = DVec3::new(red, green, blue) * texture.brightest * arriving(scene, object, nearest);
        let undimmed = sun * LARGEST_HIGHLIGHT + vector(material.emissive);
        if material.alpha == AlphaMode::Blend {
            candidates.push((Some(number), scattered));
            most = most.max(undimmed);
            all += undimmed * (scene.meshes[object.mesh].indices.len() / 3) as f64;
            opacity = opacity.min(alpha * texture.least_alpha * object.shown_share());
        } else {
            candidates.push((Some(number), scattered + undimmed));
        }
    }
    // Where no layer adds light, 0 / 0 is avoided.
    let layers = DVec3::from_array(most.to_array().map(|most| if most > 0.0 { most / opacity } else { 0.0 }));
    let added = layers.min(all);
    let (object, radiance) = candidates
        .into_iter()
        .map(|(object, radiance)| (object, (radiance + added).max_element()))
        .fold((None, 0.0), |best, one| if one.1 > best.1 { one } else { best });
    Peak { radiance: radiance.min(LARGEST_HALF), object, added: added.max_element() }
}

/// All light that can arrive anywhere on an object. `nearest` is the scene's [`Scene::nearest_to_light`].
fn arriving(scene: &Scene, object: &Object, nearest: f64) -> DVec3 {
    let from_point = |light: &PointLight| {
        // A moving object may come as near as can be.
        let moves = !object.movement.is_none();
        let distance = if moves { 0.0 } else { distance(scene, object, DVec3::from(light.position)) };
        vector(light.color) * (f64::from(light.intensity) * light.falloff(distance, nearest))
    };
    let points = scene.point_lights.iter().filter(|light| light.shines()).map(from_point);
    vector(scene.ambient) + vector(scene.sun.color) + points.sum::<DVec3>()
}

/// At most the distance between a place and an object: to its box, or from within that to its nearest triangle.
fn distance(scene: &Scene, object: &Object, place: DVec3) -> f64 {
    let mesh = &scene.meshes[object.mesh];
    let bounds = mesh.bounds.transformed(object.transform);
    // The device places corners in 32 bits.
    let slack = place.abs().max_element().max(bounds.radius()) * f64::from(f32::EPSILON);
    let nearest = place.clamp(bounds.min, bounds.max);
    let distance = if nearest == place {
        let corner = |index: u32| object.transform.transform_point3(vector(mesh.positions[index as usize]));
        let triangles = mesh.indices.as_chunks::<3>().0.iter();
        triangles.map(|corners| to_triangle(place, corners.map(corner))).fold(f64::INFINITY, f64::min)
    } else {
        place.distance(nearest)
    };
    (distance - slack).max(0.0)
}

/// The distance from a place to a triangle (C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5: the plane
/// where the place lies over the triangle, else the nearest edge).
fn to_triangle(place: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = |from: DVec3, to: DVec3| normal.dot((to - from).cross(place - from)) >= 0.0;
    if normal != DVec3::ZERO && inside(a, b) && inside(b, c) && inside(c, a) {
        return (place - a).dot(normal.normalize()).abs();
    }
    let to_edge = |from: DVec3, to: DVec3| {
        let along = to - from;
        let length = along.length_squared();
        let share = if length > 0.0 { ((place - from).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
        place.distance(from + along * share)
    };
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

fn extremes(rgba8: &[u8]) -> Extremes {
    let texels = rgba8.as_chunks::<4>().0.iter();
    let [red, green, blue, alpha] = texels.fold([0, 0, 0, 255], |[r, g, b, a]: [u8; 4], texel| {
        [r.max(texel[0]), g.max(texel[1]), b.max(texel[2]), a.min(texel[3])]
    });
    let brightest = DVec3::from_array([red, green, blue].map(|byte| srgb::decode(f64::from(byte) / 255.0)));
    Extremes { brightest, least_alpha: f64::from(alpha) / 255.0 }
}

fn vector(components: [f32; 3]) -> DVec3 {
    DVec3::from_array(components.map(f64::from))
}
