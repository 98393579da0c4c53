//! Lights and sky.

/// Light from infinitely far away, the same everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sun {
    /// The way the light travels, a unit vector: straight down is `[0, -1, 0]`.
    pub direction: [f32; 3],
    /// Linear colour with the intensity multiplied in, each at least 0: what a white surface facing it gives. Black: no sun.
    pub color: [f32; 3],
    /// Whether objects in its light cast shadows.
    pub shadows: bool,
}

impl Sun {
    /// Whether it gives any light.
    #[must_use]
    pub fn shines(&self) -> bool {
        self.color.iter().any(|channel| *channel > 0.0)
    }
}

/// Light from a point, in all directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointLight {
    /// In the world, metres.
    pub position: [f64; 3],
    /// Linear colour, each at least 0.
    pub color: [f32; 3],
    /// Multiplies the colour, at least 0: the radiance that a white surface gives which faces the light 1 m away.
    pub intensity: f32,
    /// Distance in metres at which the light has faded to nothing; `None`: it reaches everywhere.
    pub range: Option<f32>,
    /// Whether objects in its light cast shadows.
    pub shadows: bool,
}

impl PointLight {
    /// Whether it gives any light.
    #[must_use]
    pub fn shines(&self) -> bool {
        self.intensity > 0.0 && self.color.iter().any(|channel| *channel > 0.0)
    }

    /// The share of `color · intensity` that arrives at a distance in metres: `1/d²`, and with a range
    /// `clamp(1 − (d/range)⁴, 0, 1)/d²` (glTF's KHR_lights_punctual recommends it). Distances below
    /// `nearest`, more than 0, count as that, so nothing is infinite; see [`Scene::nearest_to_light`](super::Scene::nearest_to_light).
    #[must_use]
    pub fn falloff(&self, distance: f64, nearest: f64) -> f64 {
        let distance = distance.max(nearest);
        let window = self.range.map_or(1.0, |range| (1.0 - (distance / f64::from(range)).powi(4)).clamp(0.0, 1.0));
        window / (distance * distance)
    }
}

/// The background: three linear colours. Towards a unit direction `d` the sky is
/// `mix(horizon, zenith, d.y)` above the horizon and `mix(horizon, ground, sqrt(−d.y))` below it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sky {
    /// Straight up.
    pub zenith: [f32; 3],
    /// At eye level.
    pub horizon: [f32; 3],
    /// Straight down.
    pub ground: [f32; 3],
}

impl Sky {
    /// The colour towards the unit direction `direction`.
    #[must_use]
    pub fn towards(&self, direction: [f64; 3]) -> [f64; 3] {
        let up = direction[1].clamp(-1.0, 1.0);
        let (end, share) = if up < 0.0 { (self.ground, (-up).sqrt()) } else { (self.zenith, up) };
        std::array::from_fn(|i| f64::from(self.horizon[i]) * (1.0 - share) + f64::from(end[i]) * share)
    }
}
