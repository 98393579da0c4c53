//! Twin of `shaders/depth_of_field.frag` and `shaders/include/depth_of_field.glsl`.

/// A thin lens.
#[derive(Debug, Clone, Copy)]
pub struct Lens {
    /// The distance that is sharp, metres.
    pub focus: f64,
    /// The radius of the disc as which a point infinitely far away is seen, texels.
    pub spread: f64,
    /// The largest radius, texels.
    pub largest: i32,
}

impl Lens {
    /// The radius of the disc of a point, texels: `|1 - focus / distance|` of `spread`, where `nearness` is `1 / distance` in 1/m.
    #[must_use]
    pub fn disc_radius(&self, nearness: f64) -> f64 {
        (self.spread * (1.0 - self.focus * nearness).abs()).min(f64::from(self.largest))
    }

    /// What a texel of a picture shows: the mean of all light that is spread to it. `light` and `nearness` (1/m) are those of a
    /// texel, row by row, of a picture of this width and height.
    #[must_use]
    pub fn seen(&self, texel: [i32; 2], extent: [i32; 2], light: &[[f64; 3]], nearness: &[f64]) -> [f64; 3] {
        let index = |[x, y]: [i32; 2]| (y * extent[0] + x) as usize;
        let own = nearness[index(texel)];
        let (mut sum, mut shares) = ([0.0; 3], 0.0);
        for y in (texel[1] - self.largest).max(0)..=(texel[1] + self.largest).min(extent[1] - 1) {
            for x in (texel[0] - self.largest).max(0)..=(texel[0] + self.largest).min(extent[0] - 1) {
                let there = nearness[index([x, y])];
                let behind = if there < own { self.disc_radius(own) } else { f64::INFINITY };
                let away = f64::from(x - texel[0]).hypot(f64::from(y - texel[1]));
                let share = disc_share(self.disc_radius(there).min(behind), away);
                sum = [0, 1, 2].map(|channel| sum[channel] + share * light[index([x, y])][channel]);
                shares += share;
            }
        }
        sum.map(|channel| channel / shares)
    }
}

/// How much of the light of a disc of a radius falls on a texel so many texels away from its middle.
#[must_use]
pub fn disc_share(radius: f64, away: f64) -> f64 {
    (radius + 1.0 - away).clamp(0.0, 1.0) / (radius + 0.5).powi(2)
}
