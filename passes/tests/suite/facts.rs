//! Claims about the facts of scenes (NU-6).

use framewright_graph::base::Sources;
use framewright_graph::frame::DrawList;
use framewright_graph::language::{FactValue, Facts};
use framewright_passes::draw::draw_order;
use framewright_passes::scene::{Scene, limits, text};
use framewright_passes::twin::cross_fade::{fade_threshold, fades_out};
use framewright_passes::twin::lighting::{LARGEST_HIGHLIGHT, highlight};
use framewright_passes::twin::radiance::LARGEST_HALF;
use framewright_passes::twin::sky::{sun_share, sunward_share};
use glam::DVec3;

fn scene(inside: &str) -> Scene {
    let file = format!("Scene(version: 1, camera: (position: (0, 1, 5), target: (0, 0, 0)), {inside})");
    text::read(&mut Sources::default(), "a.ron", "a.ron", file).unwrap_or_else(|wrong| panic!("{wrong:?}"))
}

/// A night without sun, with a white cube of 1 m around the origin.
fn night(more: &str) -> Scene {
    scene(&format!(
        "sun: (direction: (0, -1, 0), intensity: 0), ambient: (0, 0, 0),
         sky: (zenith: (0, 0, 0), horizon: (0, 0, 0), ground: (0, 0, 0)), {more}"
    ))
}

const WHITE_CUBE: &str = r#"materials: [(name: "white")], objects: [Cube(material: "white", size: 1)]"#;

fn peak(scene: &Scene) -> f64 {
    scene.facts().peak_radiance
}

fn is_close(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-6 * expected.max(1.0)
}

#[test]
fn what_is_assumed_without_a_scene_is_the_most_that_a_scene_may_hold() {
    let Facts { peak_radiance, point_lights, objects, triangles, .. } = Facts::UNKNOWN;
    assert_eq!(peak_radiance, LARGEST_HALF);
    assert_eq!(point_lights as usize, limits::POINT_LIGHTS);
    assert_eq!(objects as usize, limits::OBJECTS);
    assert_eq!(triangles, (limits::OBJECTS * (limits::INDICES / 3)) as u64);
}

#[test]
fn the_range_of_depth_is_the_size_of_all_that_there_is_in_near_distances() {
    // The camera stands at (0, 1, 5), and is part of it: 1 m wide, 1.5 m high and 5.5 m deep.
    let far = scene(WHITE_CUBE).facts().depth_range.expect("known");
    let size = DVec3::new(1.0, 1.5, 5.5).length();
    assert!(is_close(far, size / f64::from(0.1_f32)), "{far}");
    let near =
        WHITE_CUBE.to_owned() + r#", cameras: [(name: "macro", position: (0, 1, 1), target: (0, 0, 0), near: 0.001)]"#;
    let far = scene(&near).facts().depth_range.expect("known");
    assert!(is_close(far, size / f64::from(0.001_f32)), "{far}");
}

#[test]
fn a_far_plane_bounds_the_range_of_depth() {
    let bounded = |far: f64| {
        let camera =
            format!(r#", cameras: [(name: "macro", position: (0, 1, 1), target: (0, 0, 0), near: 0.001, far: {far})]"#);
        scene(&(WHITE_CUBE.to_owned() + &camera)).facts().depth_range.expect("known")
    };
    // The other camera sees 58 near distances.
    let size = DVec3::new(1.0, 1.5, 5.5).length();
    assert!(is_close(bounded(2.0), 2.0 / f64::from(0.001_f32)), "{}", bounded(2.0));
    assert!(is_close(bounded(0.01), size / f64::from(0.1_f32)), "{}", bounded(0.01));
    assert!(is_close(bounded(1e6), size / f64::from(0.001_f32)), "{}", bounded(1e6));
}

#[test]
fn a_scene_without_light_shows_nothing() {
    assert_eq!(peak(&night(WHITE_CUBE)), 0.0);
    let facts = night(WHITE_CUBE).facts();
    assert_eq!((facts.suns, facts.point_lights), (0, 0));
    assert_eq!(facts.triangles, 12);
}

/// NU-6: what can't be brighter than 1 is known not to be.
#[test]
fn where_nothing_is_brighter_than_one_the_peak_is_at_most_one() {
    let dim = format!(
        "sun: (direction: (1, -1, 0), intensity: 0.2), ambient: (0.4, 0.4, 0.4),
         sky: (zenith: (0, 0, 0.1), horizon: (0.1, 0.1, 0.1), ground: (0.05, 0.05, 0.05)), {WHITE_CUBE}"
    );
    assert!(peak(&scene(&dim)) <= 1.0, "{}", peak(&scene(&dim)));
    assert_eq!(peak(&night(&WHITE_CUBE.replace("(name: \"white\")", "(name: \"white\", emissive: \"#ffffff\")"))), 1.0);
}

#[test]
fn the_peak_is_the_sky_towards_the_sun_or_the_brightest_surface() {
    let day = "sun: (direction: (0, -1, 0), color: \"#ffffff\", intensity: 2), ambient: (0.5, 0, 0),
        sky: (zenith: (0, 0, 0.25), horizon: (0, 0, 0), ground: (0, 0, 0))";
    let with = |inside: &str| peak(&scene(&format!("{day}, {inside}")));
    // The disc shows 4 and the glow 0.15 of the sun.
    assert!(is_close(with(WHITE_CUBE), 2.0 * 4.15 + 0.25));
    let lamp = r##"materials: [(name: "lamp", color: "#000000", emissive: "#ff0000", strength: 100)],
        objects: [Sphere(material: "lamp", radius: 1)]"##;
    assert!(is_close(with(lamp), 100.0 + 2.0 * LARGEST_HIGHLIGHT));
}

#[test]
fn point_lights_count_from_where_they_are_nearest() {
    let lit =
        |at: &str, more: &str| peak(&night(&format!("lights: [(position: {at}, intensity: 3{more})], {WHITE_CUBE}")));
    // The cube's top is at 0.5.
    assert!(is_close(lit("(0, 2.5, 0)", ""), 3.0 / 4.0));
    assert_eq!(lit("(0, 2.5, 0)", ", range: 1"), 0.0);
    assert_eq!(lit("(0, 2.5, 0)", ", color: \"#000000\""), 0.0);
    // Within the box the nearest triangle counts, not the box.
    assert!(is_close(lit("(0, 0.25, 0)", ""), 3.0 / 0.0625));
    // On a surface nothing is infinite, but more than can be stored.
    let touching = night(&format!("lights: [(position: (0, 0.5, 0), intensity: 1e6)], {WHITE_CUBE}"));
    assert_eq!(peak(&touching), LARGEST_HALF);
}

#[test]
fn textures_count_by_their_brightest_texel() {
    let checkered = r##"materials: [(name: "grey", color: (0.5, 0.5, 0.5),
        texture: Checker(count: (2, 2), colors: ("#000000", "#ff0000")))], objects: [Cube(material: "grey", size: 1)]"##;
    let lit = Scene { ambient: [1.0; 3], ..night(checkered) };
    assert!(is_close(peak(&lit), 0.5));
}

#[test]
fn what_is_in_front_and_transparent_adds_its_own_light_but_scatters_no_more_than_it_covers() {
    let panes = |opacity: &str, count: u32| {
        let inside = format!(
            r##"materials: [(name: "glass", opacity: {opacity}, alpha: Blend, emissive: "#ffffff", strength: 2)],
            objects: [Plane(material: "glass", size: (1, 1), repeat: Grid(count: (1, 1, {count}), step: (0, 0, 1)))]"##
        );
        peak(&night(&inside))
    };
    // Any number of layers: 2 + 2 · 0.5 + 2 · 0.25 + … is 4.
    assert!(is_close(panes("0.5", 1000), 4.0));
    // A plane has two triangles; no ray meets more.
    assert!(is_close(panes("0.5", 1), 4.0));
    assert!(is_close(panes("0", 3), 2.0 * 6.0));
    assert!(is_close(panes("1", 3), 2.0));
}

#[test]
fn no_surface_mirrors_more_than_the_largest_highlight() {
    let mut largest = 0.0_f64;
    for halves in 0..=300 {
        // The angle between light and halfway vector, and how far the normal leans from there towards the light.
        let half = std::f64::consts::FRAC_PI_2 * f64::from(halves) / 300.0;
        for leans in 0..200 {
            for turn in 0..4 {
                let lean = 0.003 * f64::from(leans);
                let turn = f64::from(turn) * 0.5;
                let (light, camera) =
                    (DVec3::new(half.sin(), half.cos(), 0.0), DVec3::new(-half.sin(), half.cos(), 0.0));
                let normal = DVec3::new(lean.sin() * turn.cos(), lean.cos(), lean.sin() * turn.sin());
                largest = largest.max(normal.dot(light).max(0.0) * highlight(normal, camera, light));
            }
        }
    }
    assert!(largest <= LARGEST_HIGHLIGHT && largest > 0.99 * LARGEST_HIGHLIGHT, "{largest}");
}

#[test]
fn no_direction_shows_more_of_the_sun_than_the_largest_share() {
    for sun in (-100..=100).map(|height| f64::from(height) / 100.0) {
        let largest = sunward_share(sun);
        let mut found = 0.0_f64;
        for step in 0..20_000 {
            // Up and down the circle through zenith and sun.
            let angle = std::f64::consts::TAU * f64::from(step) / 20_000.0;
            found = found.max(sun_share(angle.sin(), (angle - sun.asin()).cos()));
        }
        assert!(found <= largest, "a sun at {sun} shows {found}, more than {largest}");
        assert!(sun < 0.02 || found > 0.999 * largest, "a sun at {sun} shows only {found} of {largest}");
    }
}

#[test]
fn what_fades_is_drawn_with_what_has_holes_and_what_is_transparent_fades_by_its_opacity() {
    let fading = |alpha: &str, share: f64| {
        night(&format!(
            r#"materials: [(name: "a", alpha: {alpha})], objects: [Cube(material: "a", size: 1, cross_fade: {share})]"#
        ))
    };
    let lists = |scene: &Scene| {
        [DrawList::Opaque, DrawList::Masked, DrawList::Transparent].map(|list| draw_order(scene, list).len())
    };
    for (alpha, share, expected, is_fact) in [
        ("Opaque", 1.0, [1, 0, 0], false),
        ("Opaque", 0.3, [0, 1, 0], true),
        ("Opaque", -0.3, [0, 1, 0], true),
        ("Mask(0.5)", 1.0, [0, 1, 0], false),
        ("Mask(0.5)", 0.0, [0, 1, 0], true),
        ("Blend", 0.3, [0, 0, 1], false),
    ] {
        let scene = fading(alpha, share);
        assert_eq!(lists(&scene), expected, "{alpha} at {share}");
        let facts = scene.facts();
        assert_eq!(facts.has_cross_fade, is_fact, "{alpha} at {share}");
        assert_eq!(facts.has_opaque, expected[0] == 1, "{alpha} at {share}");
        assert_eq!(facts.has_alpha_clip, alpha.starts_with("Mask"), "{alpha} at {share}");
    }
}

#[test]
fn every_share_of_a_fade_is_seen_in_that_share_of_the_pixels_and_its_negative_in_the_others() {
    let pixels = || (0..8).flat_map(|y| (0..8).map(move |x| [x, y]));
    let mut thresholds: Vec<f64> = pixels().map(fade_threshold).collect();
    thresholds.sort_by(f64::total_cmp);
    let expected: Vec<f64> = (0..64).map(|order| (f64::from(order) + 0.5) / 64.0).collect();
    assert_eq!(thresholds, expected);
    for step in 0..=64 {
        let share = f64::from(step) / 64.0;
        assert_eq!(pixels().filter(|pixel| !fades_out(share, *pixel)).count(), step as usize);
        let complementary = |pixel: &[u32; 2]| step == 0 || fades_out(share, *pixel) != fades_out(-share, *pixel);
        assert!(pixels().all(|pixel| complementary(&pixel)), "{share}");
    }
}

#[test]
fn shadows_are_cast_by_a_light_that_shines_where_something_stands_in_it() {
    let cast = |sun: &str, alpha: &str| {
        scene(&format!(
            r#"sun: (direction: (0, -1, 0), {sun}), materials: [(name: "a", alpha: {alpha})],
            objects: [Cube(material: "a", size: 1)]"#
        ))
        .facts()
        .casts_shadows
    };
    assert!(cast("shadows: true", "Opaque") && cast("shadows: true", "Mask(0.5)"));
    assert!(!cast("shadows: true", "Blend") && !cast("shadows: true, intensity: 0", "Opaque"));
    assert!(!cast("intensity: 1", "Opaque"));
}

#[test]
fn every_fact_is_explained_and_the_explanation_has_its_value() {
    let scene = night(WHITE_CUBE);
    let facts = scene.facts();
    for found in scene.explained() {
        assert_eq!(found.value, facts.value(found.fact));
        assert!(!found.because.ends_with('.'));
    }
    assert!(scene.explained().iter().any(|found| found.value == FactValue::Integer(12)));
}

#[test]
fn the_size_is_between_that_of_the_scene_and_of_what_stands_in_it() {
    // A floor of 200 m under five balls of 1 m is hardly a larger scene than one of 20 m.
    let with_floor = |side: f64| {
        scene(&format!(
            r#"materials: [(name: "white")], objects: [Plane(material: "white", size: ({side}, {side})),
                Sphere(material: "white", radius: 1, repeat: Grid(count: (5, 1, 1), step: (3, 0, 0)))]"#
        ))
        .facts()
        .size
    };
    // The radius of the box around a ball of 1 m is √3 m.
    let expected = |side: f64| (DVec3::new(side, 2.0, side).length() * 0.5 * 3.0_f64.sqrt()).sqrt();
    assert!(is_close(with_floor(20.0), expected(20.0)), "{}", with_floor(20.0));
    assert!(is_close(with_floor(200.0), expected(200.0)), "{}", with_floor(200.0));
    // One thing alone is as large as it is.
    assert!(is_close(scene(WHITE_CUBE).facts().size, 3.0_f64.sqrt() * 0.5));
    assert_eq!(scene("materials: [], objects: []").facts().size, 1.0);
}
