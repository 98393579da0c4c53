//! Light and lengths may be in any unit: a scene whose lights are all a thousand times as strong, or that is a thousand times as large
//! with its camera, is the same picture in every shipped pipeline.

use framewright_graph::base::Sources;
use framewright_passes::scene::{Scene, text};
use framewright_tests::render::{Setup, device, in_repository, render};
use std::error::Error;

const EXTENT: [u32; 2] = [96, 54];

/// A floor with things of every kind on it, lit by the sun, which casts shadows, and by a lamp close above a ball. All light is multiplied by
/// `light`, and all lengths by `length`.
fn scene(light: f64, length: f64) -> Result<Scene, Box<dyn Error>> {
    let at = |x: f64, y: f64, z: f64| format!("({:e}, {:e}, {:e})", x * length, y * length, z * length);
    let color = |r: f64, g: f64, b: f64| format!("({:e}, {:e}, {:e})", r * light, g * light, b * light);
    let (sun, lamp) = (1.4 * light, 0.02 * light * length * length);
    let strength = 6.0 * light;
    let file = format!(
        r##"Scene(version: 1, exposure: Auto,
            camera: (position: {camera}, target: {target}, fov: 45, near: {near:e}),
            sun: (direction: (-2, -2, 1), color: "#fff0d2", intensity: {sun:e}, shadows: true),
            ambient: {ambient},
            sky: (zenith: {zenith}, horizon: {horizon}, ground: {ground}),
            lights: [(position: {lamp_at}, color: "#ff8040", intensity: {lamp:e}, range: {range:e})],
            materials: [(name: "stone", color: "#c9b79c", texture: Checker(count: (12, 12), colors: ("#ffffff", "#a0a0a0"))),
                (name: "red", color: "#c2613f"), (name: "lamp", color: "#000000", emissive: "#ffffff", strength: {strength:e}),
                (name: "sieve", color: "#7a5a3c", texture: Dots(count: (5, 4), radius: 0.36), alpha: Mask(0.5), double_sided: true),
                (name: "glass", color: "#80c0ff", opacity: 0.4, alpha: Blend)],
            objects: [
                Plane(material: "stone", size: ({floor:e}, {floor:e})),
                Cube(material: "red", position: {columns}, size: {width:e}, repeat: Grid(count: (4, 2, 1), step: {step})),
                Sphere(material: "red", position: {ball}, radius: {radius:e}),
                Sphere(material: "lamp", position: {bulb}, radius: {small:e}),
                Cube(material: "sieve", position: {sieve}, size: {width:e}),
                Sphere(material: "glass", position: {glass}, radius: {radius:e}),
            ])"##,
        camera = at(3.0, 2.2, 5.0),
        target = at(0.0, 0.4, 0.0),
        near = 0.1 * length,
        ambient = color(0.2, 0.25, 0.34),
        zenith = color(0.05, 0.2, 0.62),
        horizon = color(0.62, 0.78, 1.0),
        ground = color(0.3, 0.28, 0.25),
        lamp_at = at(-0.8, 1.01, 1.2),
        range = 3.0 * length,
        floor = 16.0 * length,
        columns = at(-0.3, 0.7, -1.2),
        width = 0.7 * length,
        step = at(1.1, 0.7, 0.0),
        ball = at(-0.8, 0.5, 1.2),
        radius = 0.5 * length,
        bulb = at(1.6, 0.3, 0.4),
        small = 0.3 * length,
        sieve = at(0.5, 0.37, 1.8),
        glass = at(0.6, 0.5, 0.6),
    );
    let mut sources = Sources::default();
    text::read(&mut sources, "unit.ron", "unit.ron", file).map_err(|mistakes| format!("{mistakes:?}").into())
}

/// Settings and their values.
type Choices = Vec<(&'static str, &'static str)>;

/// The shipped pipelines, each with what is switched on in it.
fn pipelines() -> Result<Vec<(String, Choices)>, Box<dyn Error>> {
    let mut found = Vec::new();
    for file in std::fs::read_dir(in_repository("examples/pipelines"))? {
        let name = file?.file_name().to_string_lossy().into_owned();
        if let Some(stem) = name.strip_suffix(".ron") {
            let set: &[(&str, &str)] = match stem {
                "deferred" => &[("ambient_occlusion", "3.0"), ("shadow_size", "512"), ("overlay", "true")],
                "deferred_mobile" => &[("ambient_occlusion", "3.0"), ("shadows", "true"), ("bloom", "0.3")],
                "shadows" => &[("shadow_size", "512")],
                "image_quality" => &[("depth_stripes", "copied"), ("overlay", "true")],
                _ => &[],
            };
            found.push((format!("examples/pipelines/{name}"), set.to_vec()));
        }
    }
    found.sort();
    Ok(found)
}

/// Pixels of the outputs that are more than `apart` steps of 255 apart, and all pixels.
fn differing(one: &[Vec<[u8; 4]>], other: &[Vec<[u8; 4]>], apart: u8) -> (usize, usize) {
    let pairs = || one.iter().flatten().zip(other.iter().flatten());
    let far = pairs().filter(|(one, other)| one.iter().zip(*other).any(|(one, other)| one.abs_diff(*other) > apart));
    (far.count(), pairs().count())
}

fn demand_the_same(scales: &[(f64, f64)]) -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for (pipeline, set) in pipelines()? {
        let picture = |(light, length)| -> Result<Vec<Vec<[u8; 4]>>, Box<dyn Error>> {
            let scene = scene(light, length)?;
            let outputs = render(device, &Setup { pipeline: &pipeline, set: &set, scene: &scene, extent: EXTENT })?;
            Ok(outputs.into_iter().map(|output| output.bytes.as_chunks::<4>().0.to_vec()).collect())
        };
        let usual = picture((1.0, 1.0))?;
        let colors: std::collections::HashSet<_> = usual.iter().flatten().collect();
        assert!(colors.len() > 300, "{pipeline}: {} colours", colors.len());
        let white = usual.iter().flatten().filter(|pixel| pixel[..3] == [255; 3]).count();
        assert!(white * 5 < usual.iter().flatten().count(), "{pipeline}: {white} pixels are white");
        for scale in scales {
            let (differ, all) = differing(&usual, &picture(*scale)?, 2);
            // Corners of triangles are rounded anew, so a pixel at an edge may show either side.
            assert!(
                differ * 100 <= all,
                "{pipeline}: {differ} of {all} pixels differ with (light, length) × {scale:?}"
            );
        }
    }
    Ok(())
}

#[test]
fn lights_in_any_unit_are_the_same_picture_in_every_shipped_pipeline() -> Result<(), Box<dyn Error>> {
    demand_the_same(&[(1e-4, 1.0), (6830.0, 1.0), (1e6, 1.0)])
}

#[test]
fn lengths_in_any_unit_are_the_same_picture_in_every_shipped_pipeline() -> Result<(), Box<dyn Error>> {
    demand_the_same(&[(1.0, 1e-3), (1.0, 0.0254), (1.0, 1e4)])
}
