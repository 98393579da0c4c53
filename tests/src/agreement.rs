//! How far a drawn picture agrees with the ray-caster.

use crate::raycast::texture::encode;
use crate::raycast::{Hit, RayCaster};
use framewright_passes::scene::Scene;
use glam::DVec2;
use std::fmt;

/// Steps of 255 by which a base colour may miss, beyond the range of base colours around it: rounding to eight bits on the
/// way into the texture's mip levels, out of its filter and into the picture.
const COLOR_TOLERANCE: f64 = 3.0;

/// Interior pixels of one kind. A pixel is interior if the ray-caster sees the same object (or none) at it and at its eight
/// neighbours: what happens at borders is a matter of sampling, not of right or wrong.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// How many there are.
    pub interior: usize,
    /// Pixels on which both see the same object.
    pub same_object: usize,
    /// Pixels on which the drawn base colour lies among the ray-cast ones of the pixel and its neighbours.
    pub same_color: usize,
}

impl Tally {
    /// Whether at least the share `share` agrees in both respects.
    #[must_use]
    pub fn agrees(&self, share: f64) -> bool {
        let needed = share * self.interior as f64;
        self.same_object as f64 >= needed && self.same_color as f64 >= needed
    }
}

/// The result of a comparison.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Agreement {
    /// Pixels that show an object.
    pub objects: Tally,
    /// Pixels that show none. Colours are not compared there.
    pub background: Tally,
    /// The first disagreements, in words.
    pub examples: Vec<String>,
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Agreement { objects, background, examples } = self;
        writeln!(f, "of {} pixels inside objects:", objects.interior)?;
        writeln!(f, "  {} show the right object, {} the right base colour", objects.same_object, objects.same_color)?;
        writeln!(f, "of {} pixels of background {} are empty", background.interior, background.same_object)?;
        examples.iter().try_for_each(|example| writeln!(f, "{example}"))
    }
}

/// Holds two drawn pictures of a scene against the ray-caster. Both are 8-bit RGBA, top row first: `objects` holds
/// object index + 1 in red + 256 · green (0: none), `colors` the sRGB-encoded base colour.
#[must_use]
pub fn agreement(scene: &Scene, [width, height]: [u32; 2], objects: &[u8], colors: &[u8]) -> Agreement {
    let caster = RayCaster::new(scene);
    // One pixel more on each side, so that pixels on the picture's border have neighbours too.
    let columns = width as usize + 2;
    let hits: Vec<Option<Hit>> = (0..columns * (height as usize + 2))
        .map(|at| {
            let pixel = DVec2::new((at % columns) as f64 - 0.5, (at / columns) as f64 - 0.5);
            caster.cast(&caster.camera_ray(pixel, [width, height]))
        })
        .collect();
    let mut found = Agreement::default();
    for at in 0..width as usize * height as usize {
        let (x, y) = (at % width as usize, at / width as usize);
        let around: Vec<Option<Hit>> = (0..9).map(|step| hits[(y + step / 3) * columns + x + step % 3]).collect();
        let object = around[4].map(|hit| hit.object);
        if around.iter().any(|hit| hit.map(|hit| hit.object) != object) {
            continue;
        }
        let pixel = 4 * at..4 * at + 4;
        let drawn_object = (u32::from(objects[pixel.start]) + 256 * u32::from(objects[pixel.start + 1])).checked_sub(1);
        let same_object = drawn_object == object;
        let same_color = is_among(&colors[pixel.clone()], &around);
        let tally = if object.is_some() { &mut found.objects } else { &mut found.background };
        tally.interior += 1;
        tally.same_object += usize::from(same_object);
        tally.same_color += usize::from(same_color);
        if !(same_object && same_color) && found.examples.len() < 5 {
            let [red, green, blue] = encoded(around[4]).map(f64::round);
            found.examples.push(format!(
                "({x}, {y}): object {drawn_object:?} instead of {object:?}, colour {:?} instead of [{red}, {green}, {blue}]",
                &colors[pixel][..3],
            ));
        }
    }
    found
}

/// Whether a drawn colour lies between the least and the greatest of the ray-cast ones, channel by channel.
fn is_among(drawn: &[u8], around: &[Option<Hit>]) -> bool {
    if around[0].is_none() {
        return true;
    }
    (0..3).all(|channel| {
        let values = around.iter().map(|hit| encoded(*hit)[channel]);
        let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        (low - COLOR_TOLERANCE..=high + COLOR_TOLERANCE).contains(&f64::from(drawn[channel]))
    })
}

/// A base colour as an 8-bit sRGB picture holds it, before rounding; black for none.
fn encoded(hit: Option<Hit>) -> [f64; 3] {
    let [red, green, blue, _] = hit.map_or([0.0; 4], |hit| hit.base_color);
    [red, green, blue].map(|linear| 255.0 * encode(linear.clamp(0.0, 1.0)))
}
