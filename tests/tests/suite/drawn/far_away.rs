//! A scene a million metres from its origin, with fractions that 32 bits don't hold there, is drawn as near its origin: places are
//! kept in 64 bits from the file to the difference to the camera.

use framewright_graph::base::Sources;
use framewright_passes::scene::{Scene, text};
use framewright_tests::render::{Setup, device, render};
use std::error::Error;

const EXTENT: [u32; 2] = [160, 90];

/// A scene around a place. A million metres from 0 the 32-bit floats are 6 cm apart.
fn around(x: f64, y: f64, z: f64) -> Result<Scene, Box<dyn Error>> {
    let at = |dx: f64, dy: f64, dz: f64| format!("({:.7}, {:.7}, {:.7})", x + dx, y + dy, z + dz);
    let file = format!(
        "Scene(version: 1,
            camera: (position: {}, target: {}, fov: 50, near: 0.05),
            sun: (direction: (-0.4, -1, -0.6), color: (1, 0.9, 0.8)),
            lights: [(position: {}, color: (1, 0.2, 0.1), intensity: 0.4, range: 2.5)],
            materials: [(name: \"floor\", color: (0.5, 0.5, 0.5)), (name: \"red\", color: (0.8, 0.1, 0.1)),
                (name: \"glass\", color: (0.2, 0.5, 0.9), opacity: 0.4, alpha: Blend)],
            objects: [
                Plane(material: \"floor\", position: {}, size: (6, 6)),
                Cube(material: \"red\", position: {}, size: 0.03, rotation: (10, 20, 30),
                    repeat: Grid(count: (9, 3, 9), step: (0.0712345, 0.0712345, 0.0712345))),
                Sphere(material: \"glass\", position: {}, radius: 0.2113),
            ])",
        at(0.0123457, 0.6123457, 1.0345679),
        at(0.0, 0.1, 0.0),
        at(0.4321, 0.5432, 0.3217),
        at(0.0, -0.0271, 0.0),
        at(0.0112233, 0.1314151, 0.0161718),
        at(0.2019181, 0.2716151, 0.4141211),
    );
    let mut sources = Sources::default();
    text::read(&mut sources, "far.ron", "far.ron", file).map_err(|mistakes| format!("{mistakes:?}").into())
}

#[test]
fn a_scene_a_million_metres_away_is_drawn_as_near_its_origin() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let picture = |scene: &Scene| -> Result<Vec<[u8; 4]>, Box<dyn Error>> {
        let setup = Setup { pipeline: "examples/pipelines/forward.ron", set: &[("msaa", "1")], scene, extent: EXTENT };
        let outputs = render(device, &setup)?;
        Ok(outputs[0].bytes.as_chunks::<4>().0.to_vec())
    };
    let near = picture(&around(0.0, 0.0, 0.0)?)?;
    let colors: std::collections::HashSet<_> = near.iter().collect();
    assert!(colors.len() > 200, "{} colours", colors.len());
    for (x, y, z) in [(1e6, 0.0, 0.0), (-1e6, 1e6, 1e6)] {
        let far = picture(&around(x, y, z)?)?;
        // 64 bits hold places to 10⁻¹⁰ m there: what is drawn differs by at most a rounding of 32 bits near the camera.
        let differ = near
            .iter()
            .zip(&far)
            .filter(|(near, far)| near.iter().zip(*far).any(|(near, far)| near.abs_diff(*far) > 1));
        let differ = differ.count();
        assert!(differ <= 4, "({x}, {y}, {z}): {differ} of {} pixels differ", near.len());
    }
    Ok(())
}
