//! Depth of field is held against its twin (NU-5), and does what it is for.

use framewright_graph::base::Sources;
use framewright_passes::scene::{Scene, load, text};
use framewright_passes::twin::depth_of_field::Lens;
use framewright_tests::render::{Setup, device, in_repository, render, rgb};
use std::error::Error;

const PIPELINE: &str = "tests/pipelines/depth_of_field.ron";
const EXTENT: [u32; 2] = [96, 60];

/// A picture's light, its depth, and what was seen of it.
pub(super) struct Seen {
    pub(super) extent: [i32; 2],
    pub(super) light: Vec<[f64; 3]>,
    pub(super) depth: Vec<f64>,
    pub(super) seen: Vec<[f64; 3]>,
}

impl Seen {
    /// Holds each texel against the twin, and counts those that the lens changed.
    pub(super) fn demand_the_twin(&self, near: f64, lens: Lens, case: &str) -> usize {
        let nearness: Vec<f64> = self.depth.iter().map(|depth| depth / near).collect();
        let brightest = self.light.iter().flatten().copied().fold(1.0, f64::max);
        let mut changed = 0;
        for (at, found) in self.seen.iter().enumerate() {
            let at = at as i32;
            let texel = [at % self.extent[0], at / self.extent[0]];
            let expected = lens.seen(texel, self.extent, &self.light, &nearness);
            // Distances are rounded to 32 bits, and up to 121 texels add up.
            let near = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= 2e-5 * brightest);
            assert!(near, "{case}, {texel:?}: {found:?} instead of {expected:?}");
            let before = self.light[at as usize];
            changed += usize::from(found.iter().zip(before).any(|(found, before)| (found - before).abs() > 0.02));
        }
        changed
    }
}

fn scene() -> Result<Scene, Box<dyn Error>> {
    Ok(load(&in_repository("examples/scenes/passing.ron"))?)
}

fn seen(scene: &Scene, set: &[(&str, &str)]) -> Result<Option<Seen>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let outputs = render(device, &Setup { pipeline: PIPELINE, set, scene, extent: EXTENT })?;
    let [light, depths, seen] = [0, 1, 2].map(|output| rgb(&outputs[output]));
    let depth = depths.into_iter().map(|[depth, ..]| depth).collect();
    Ok(Some(Seen { extent: EXTENT.map(u32::cast_signed), light, depth, seen }))
}

#[test]
fn a_lens_sees_what_its_twin_sees() -> Result<(), Box<dyn Error>> {
    let scene = scene()?;
    for (focus, spread, largest) in [(9.0, 0.06, 5), (2.0, 0.02, 3), (1e6, 1e-6, 4), (9.0, 1.0, 2)] {
        let set =
            [("focus", &*format!("{focus}")), ("spread", &format!("{spread}")), ("largest", &format!("{largest}"))];
        let Some(seen) = seen(&scene, &set)? else { return Ok(()) };
        let lens = Lens { focus, spread: spread * f64::from(EXTENT[1]), largest };
        let changed = seen.demand_the_twin(f64::from(scene.camera.near), lens, &format!("focus {focus}"));
        assert!(changed > 300, "focus {focus}, spread {spread}: {changed} texels changed");
    }
    Ok(())
}

#[test]
fn without_spread_or_reach_all_is_sharp() -> Result<(), Box<dyn Error>> {
    let scene = scene()?;
    for (spread, largest) in [("0.0", "5"), ("0.5", "0")] {
        let Some(seen) = seen(&scene, &[("spread", spread), ("largest", largest)])? else { return Ok(()) };
        assert!(seen.seen == seen.light, "spread {spread}, at most {largest} texels");
    }
    Ok(())
}

/// The front of a cube is in focus and faces the camera; the light of a lamp behind it goes up to its edges and no further.
#[test]
fn nothing_behind_bleeds_over_what_is_sharp() -> Result<(), Box<dyn Error>> {
    let file = "Scene(version: 1,
        camera: (position: (0, 0, 10), target: (0, 0, 0), fov: 42),
        materials: [(name: \"grey\", color: \"#404040\"), (name: \"lamp\", color: \"#000000\", emissive: \"#ffffff\", strength: 9)],
        objects: [
            Cube(name: \"cube\", material: \"grey\", position: (0, 0, 0), size: 2),
            Cube(name: \"lamp\", material: \"lamp\", position: (0, 0, -20), size: (8, 8, 1)),
        ])";
    let scene = text::read(&mut Sources::default(), "front.ron", "front.ron", file.to_owned())
        .map_err(|mistakes| format!("{mistakes:?}"))?;
    let focus = 9.0;
    let Some(seen) = seen(&scene, &[("focus", "9.0"), ("spread", "0.1")])? else { return Ok(()) };
    let distance = |depth: f64| f64::from(scene.camera.near) / depth;
    let (mut edge, mut blurred) = (0, 0);
    for (at, (found, light)) in seen.seen.iter().zip(&seen.light).enumerate() {
        let changed = found.iter().zip(light).any(|(found, light)| (found - light).abs() > 0.01);
        if (distance(seen.depth[at]) - focus).abs() < 0.01 {
            assert!(!changed, "texel {at}: {light:?} became {found:?}");
            edge += usize::from(distance(seen.depth[at + 1]) > 2.0 * focus);
        } else {
            blurred += usize::from(changed);
        }
    }
    assert!(edge > 5 && blurred > 50, "{edge} texels at an edge, {blurred} blurred");
    Ok(())
}
