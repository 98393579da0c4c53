//! Light in any unit: what a file's light is multiplied by when it is read.

use super::fixtures::builder::Builder;
use super::fixtures::shapes;
use framewright_graph::base::{Diagnostic, Sources};
use framewright_passes::scene::{Scene, gltf, text};
use serde_json::json;

/// A glowing box, lit by `lights`, each times `factor`; their intensity is in lux and candela.
fn gltf_lit(lights: &[serde_json::Value], emissive: f64) -> Scene {
    let mut file = Builder::default();
    let glowing = file.material(json!({
        "emissiveFactor": [1.0, 0.5, 0.25],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": emissive}},
    }));
    file.extension("KHR_materials_emissive_strength");
    let primitive = file.primitive(&shapes::cube(), Some(glowing));
    let mesh = file.mesh("box", vec![primitive]);
    file.root(json!({"mesh": mesh}));
    for light in lights {
        let light = file.light(light.clone());
        file.root(json!({"translation": [1.5, 2.0, 0.5], "extensions": {"KHR_lights_punctual": {"light": light}}}));
    }
    gltf::read_glb(&file.finish(), None).unwrap_or_else(|wrong| panic!("{wrong}"))
}

fn read(inside: &str) -> Result<Scene, Vec<Diagnostic>> {
    let file = format!(
        r#"Scene(version: 1, {inside}, materials: [(name: "white", emissive: (0.001, 0.001, 0.001))],
            objects: [Cube(material: "white", size: 1)])"#
    );
    text::read(&mut Sources::default(), "a.ron", "a.ron", file)
}

fn scene(inside: &str) -> Scene {
    read(inside).unwrap_or_else(|wrong| panic!("{wrong:?}"))
}

fn sun(color: [f32; 3]) -> f64 {
    let [red, green, blue] = color.map(f64::from);
    0.2126 * red + 0.7152 * green + 0.0722 * blue
}

fn is_close(one: f64, other: f64) -> bool {
    (one - other).abs() <= 1e-5 * other.abs()
}

/// Every number of the light in it.
fn light(scene: &Scene) -> Vec<f32> {
    let sky = [scene.sky.zenith, scene.sky.horizon, scene.sky.ground];
    let emissive = scene.materials.iter().map(|material| material.emissive);
    let colors = emissive.chain(sky).chain([scene.sun.color, scene.ambient]);
    colors.flatten().chain(scene.point_lights.iter().map(|light| light.intensity)).collect()
}

fn demand_the_same_light(one: &Scene, other: &Scene) {
    for (one, other) in light(one).into_iter().zip(light(other)) {
        assert!(is_close(one.into(), other.into()), "{one} is not {other}");
    }
}

#[test]
fn a_sun_in_lux_is_as_bright_as_any_other_and_so_is_all_else_beside_it() {
    let lit = |factor: f64| {
        gltf_lit(
            &[
                json!({"type": "directional", "intensity": 6830.0 * factor, "color": [1.0, 0.9, 0.7]}),
                json!({"type": "point", "intensity": 1000.0 * factor}),
            ],
            100.0 * factor,
        )
    };
    let day = lit(1.0);
    assert!(is_close(sun(day.sun.color), 1.0), "{:?}", day.sun.color);
    // Of a lux a white surface shows 1/π.
    let white = 6830.0 / std::f64::consts::PI * sun([1.0, 0.9, 0.7]);
    assert!(is_close(day.exposure, white.recip()) && is_close(day.facts().exposure, white.recip()), "{}", day.exposure);
    assert!(is_close(f64::from(day.point_lights[0].intensity), 1000.0 / std::f64::consts::PI / white));
    assert!(is_close(f64::from(day.materials[0].emissive[0]), 100.0 / white), "{:?}", day.materials[0].emissive);
    // What no light of the file decides is as on any day.
    let default = gltf_lit(&[], 1.0);
    assert_eq!((default.exposure, default.materials[0].emissive[0]), (1.0, 1.0));
    assert_eq!((day.ambient, day.sky), (default.ambient, default.sky));
    for factor in [1e-6, 1e-3, 30.0, 1e3] {
        demand_the_same_light(&lit(factor), &day);
    }
}

#[test]
fn lamps_in_candela_are_as_bright_as_any_other_where_there_is_no_sun() {
    let lit = |factor: f64| gltf_lit(&[json!({"type": "point", "intensity": 40.0 * factor, "range": 9.0})], factor);
    for factor in [1e-6, 1e-3, 1e3, 1e6] {
        demand_the_same_light(&lit(factor), &lit(1.0));
    }
    assert!((0.01..100.0).contains(&lit(1.0).point_lights[0].intensity));
}

#[test]
fn auto_makes_the_light_of_a_text_of_any_unit_the_same() {
    let lit = |factor: f64| {
        scene(&format!(
            "exposure: Auto, sun: (direction: (0, -1, 0), intensity: {:e}), ambient: ({:e}, {:e}, 0), sky: (zenith: (0, 0, {:e}), \
             horizon: (0, {:e}, 0), ground: (0, 0, 0)), lights: [(position: (0, 2, 0), intensity: {:e})]",
            4.0 * factor,
            0.1 * factor,
            0.2 * factor,
            0.3 * factor,
            0.4 * factor,
            5.0 * factor,
        ))
    };
    let one = lit(1.0);
    assert!(is_close(sun(one.sun.color), 1.0) && is_close(one.exposure, 0.25), "{one:?}");
    for factor in [1e-6, 1e-3, 7.0, 1e3, 1e6] {
        let mut other = lit(factor);
        other.materials[0].emissive = one.materials[0].emissive;
        demand_the_same_light(&other, &one);
    }
}

#[test]
fn a_text_that_says_nothing_is_drawn_as_it_is_unless_it_would_be_nothing_but_white_or_black() {
    let lit = |sun: f64, more: &str| {
        scene(&format!(
            "sun: (direction: (0, -1, 0), intensity: {sun:e}), ambient: (0, 0, 0),
             sky: (zenith: (0, 0, 0), horizon: (0, 0, 0), ground: (0, 0, 0)) {more}"
        ))
    };
    for usual in [0.0, 0.01, 1.0, 63.0] {
        assert_eq!(lit(usual, "").exposure, 1.0, "{usual}");
    }
    for beyond in [65.0, 6830.0, 1e8, 1e-3, 1e-6] {
        let lit = lit(beyond, "");
        assert!(is_close(sun(lit.sun.color), 1.0), "{beyond}: {:?}", lit.sun.color);
    }
    // An exposure that the file gives counts.
    assert_eq!(lit(6830.0, ", exposure: 1").sun.color, [6830.0; 3]);
    assert_eq!(lit(6830.0, ", exposure: 0.001").exposure, 0.001);
    // One thing that is seen is enough for night to stay night.
    let night = scene("sun: (direction: (0, -1, 0), intensity: 0.001), ambient: (0.0, 0.0, 0.0)");
    assert_eq!(night.exposure, 1.0, "the sky of a day");
}

#[test]
fn an_exposure_is_a_number_above_0_or_auto() {
    for wrong in ["0", "-1", "1e13", "\"Auto\"", "Auto(1)", "Automatic", "[1]"] {
        let mistakes = read(&format!("exposure: {wrong}")).expect_err(wrong);
        assert_eq!(mistakes.len(), 1, "{wrong}: {mistakes:?}");
    }
}
