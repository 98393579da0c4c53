//! Light in any unit: what a file's light is multiplied by, so that the picture shows it.
//!
//! A file may give its lights in lux and candela, or in a unit of its own. What a screen can show is the same for all of them. So
//! light is exposed here, before anything is drawn: images of half floats hold it, and effects that know white from black do as they
//! do in any other scene. Twice the light in the file is the same picture.

use super::model::{Bounds, PointLight, Sky, Sun};
use super::{Scene, limits};
use crate::srgb;
use glam::DVec3;

/// Where a text file says nothing, this much light and more is taken to be in a unit of its own: a white surface in it would
/// show as nothing but white, whatever tone mapping there is.
const BRIGHTEST: f64 = 64.0;
/// The same of less light than this, which would show as nothing but black.
const DARKEST: f64 = 1.0 / 256.0;

fn luminance(color: [f32; 3]) -> f64 {
    srgb::luminance(color.map(f64::from))
}

/// The lights that a file has.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lights<'s> {
    pub(super) sun: Option<&'s Sun>,
    pub(super) points: &'s [PointLight],
    pub(super) ambient: Option<[f32; 3]>,
    /// Around all objects.
    pub(super) bounds: Option<Bounds>,
}

impl Lights<'_> {
    /// The luminance of a white surface in the strongest of them: one that faces the sun, or a point light from where the middle of the
    /// scene is. 0 without light.
    fn key(self) -> f64 {
        let sun = self.sun.map_or(0.0, |sun| luminance(sun.color));
        let (middle, radius) = self.bounds.map_or((DVec3::ZERO, 1.0), |bounds| (bounds.center(), bounds.radius()));
        let from_point = |light: &PointLight| {
            // Surfaces lie around the middle.
            let distance = (DVec3::from(light.position).distance_squared(middle) + 0.25 * radius * radius).sqrt();
            let distance = light.range.map_or(distance, |range| distance.min(0.5 * f64::from(range)));
            luminance(light.color) * f64::from(light.intensity) / (distance * distance)
        };
        let points =
            self.points.iter().filter(|light| light.shines()).map(from_point).filter(|light| light.is_finite());
        let key = points.fold(sun, f64::max);
        // Ambient light is the rest of another light, unless there is none.
        if key > 0.0 { key } else { self.ambient.map_or(0.0, luminance) }
    }

    /// What all light of the file is multiplied by, so that a white surface in the strongest shows 1.
    pub(super) fn exposure(self) -> f64 {
        let key = self.key();
        if key > 0.0 { key.recip() } else { 1.0 }
    }

    /// The same where all of it is beyond what a screen can show; else 1. `others` shine by themselves: sky and surfaces.
    pub(super) fn exposure_if_beyond(self, others: impl Iterator<Item = [f32; 3]>) -> f64 {
        let key = self.key();
        let brightest = others.chain(self.ambient).map(luminance).fold(key, f64::max);
        if key > BRIGHTEST || brightest < DARKEST { self.exposure() } else { 1.0 }
    }
}

/// The three colours of a sky.
pub(super) fn colors(sky: &Sky) -> [[f32; 3]; 3] {
    [sky.zenith, sky.horizon, sky.ground]
}

/// What of a scene's light was invented, since its file says nothing of it: it is right for any exposure.
#[derive(Debug, Clone, Copy)]
pub(super) struct InventedLight {
    pub(super) sun: bool,
    pub(super) ambient: bool,
    pub(super) sky: bool,
}

impl Scene {
    /// The scene with all light of its file multiplied by `exposure`.
    pub(super) fn exposed(mut self, exposure: f64, invented: InventedLight) -> Scene {
        self.exposure = exposure;
        if exposure == 1.0 {
            return self;
        }
        let times = |channel: &mut f32| *channel = (f64::from(*channel) * exposure).min(limits::RADIANCE) as f32;
        let all = |color: &mut [f32; 3]| color.iter_mut().for_each(times);
        if !invented.sun {
            all(&mut self.sun.color);
        }
        if !invented.ambient {
            all(&mut self.ambient);
        }
        if !invented.sky {
            [&mut self.sky.zenith, &mut self.sky.horizon, &mut self.sky.ground].into_iter().for_each(all);
        }
        self.point_lights.iter_mut().for_each(|light| times(&mut light.intensity));
        self.materials.iter_mut().for_each(|material| all(&mut material.emissive));
        self
    }
}
