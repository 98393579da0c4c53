//! Mistakes in scene files: each is told with its place, and all of them at once.

use framewright_graph::base::{Sources, render};
use framewright_passes::scene::{AlphaMode, Scene, text};
use glam::DVec3;

fn read(text: &str) -> Result<Scene, String> {
    let mut sources = Sources::default();
    text::read(&mut sources, "s.ron", "s.ron", text.to_owned()).map_err(|mistakes| render(&sources, &mistakes))
}

/// A scene with one grey material and these objects and other fields.
fn scene(fields: &str, objects: &str) -> String {
    format!("Scene(version: 1, materials: [(name: \"grey\")],\n{fields}\nobjects: [\n{objects}\n])")
}

fn ball(fields: &str) -> String {
    scene("", &format!("Sphere(material: \"grey\", {fields})"))
}

/// Each mistake as `line:column message`, with ` / help` where there is some.
fn mistakes(text: &str) -> Vec<String> {
    let mut sources = Sources::default();
    let Err(mistakes) = text::read(&mut sources, "s.ron", "s.ron", text.to_owned()) else { return Vec::new() };
    mistakes
        .iter()
        .map(|mistake| {
            let place = mistake.labels.first().and_then(|label| sources.place(label.span));
            let place = place.map_or_else(String::new, |place| format!("{}:{} ", place.line, place.column));
            let help = mistake.help.as_ref().map_or_else(String::new, |help| format!(" / {help}"));
            format!("{place}{}{help}", mistake.message)
        })
        .collect()
}

#[test]
fn a_mistake_looks_like_one_in_a_pipeline() {
    let said = read(&scene("", "Sphere(material: \"gray\", radius: 1)")).expect_err("a mistake");
    let expected = "\
error: there is no material named `gray` [E0217]
 --> s.ron:4:18
  |
4 | Sphere(material: \"gray\", radius: 1)
  |                  ^^^^^^
  |
  = help: did you mean `grey`?";
    assert_eq!(said.trim_end(), expected);
}

#[test]
fn the_example_in_the_documentation_is_a_scene() {
    let documentation = include_str!("../../../src/scene/text/mod.rs");
    let example = documentation.split("```").nth(1).expect("an example").trim_start_matches("ron");
    let example: String = example.lines().map(|line| line.trim_start_matches("//!")).collect::<Vec<_>>().join("\n");
    let scene = read(&example).unwrap_or_else(|said| panic!("{said}"));
    assert_eq!((scene.objects.len(), scene.materials.len(), scene.textures.len()), (6, 4, 2));
}

#[test]
fn files_that_are_no_scene() {
    let first = |text: &str| mistakes(text).into_iter().next().unwrap_or_default();
    assert_eq!(first(""), "1:1 the file is empty / a scene begins with `Scene(version: 1,`");
    assert_eq!(first("\u{feff}Scene()"), first("Scene()"), "a byte order mark is no part of the text");
    assert_eq!(first("Scene()"), "1:1 the scene lacks the fields `version`, `materials` and `objects`");
    let pipeline = first("Pipeline(version: 1)");
    assert_eq!(pipeline, "1:1 expected `Scene(…)`, found `Pipeline`");
    let old = "1:16 this file is written in version 2 of the scene format / this program reads version 1";
    assert_eq!(first("Scene(version: 2, materials: [], objects: [])"), old);
    assert_eq!(
        first("Scene(version: 1, materials: ["),
        "1:31 the file ends in the middle of a value / is a bracket or a quote left open?"
    );
    let deep = format!("Scene(version: 1, materials: {}", "[".repeat(100_000));
    assert!(first(&deep).contains("brackets are nested too deeply"), "{}", first(&deep));
    assert_eq!(first("Scene(version: 1, materials: [], objects: [])"), "1:43 a scene without objects needs a camera");
}

#[test]
fn unknown_fields_and_words_suggest_near_ones() {
    assert_eq!(
        mistakes(&ball("radius: 1, positon: (0, 0, 0)")),
        ["4:37 `Sphere(material: \"…\", radius: 0.5)` has no field `positon` / did you mean `position`?"]
    );
    assert_eq!(
        mistakes(&scene("", "Shpere(material: \"grey\", radius: 1)")),
        ["4:1 `Shpere` is not a shape / did you mean `Sphere`?"]
    );
    let alpha = "Scene(version: 1, materials: [(name: \"a\", alpha: Masked(0.5))], objects: [])";
    assert_eq!(mistakes(alpha)[0], "1:50 `Masked` is not what alpha does / did you mean `Mask`?");
}

#[test]
fn numbers_must_be_finite_and_in_range() {
    assert_eq!(mistakes(&ball("radius: 0")), ["4:34 the radius is 0; expected 0.000001 to 1000000000"]);
    assert_eq!(mistakes(&ball("radius: -1")), ["4:34 the radius is -1; expected 0.000001 to 1000000000"]);
    assert_eq!(mistakes(&ball("radius: NaN")), ["4:34 expected a finite number, found `NaN`"]);
    assert_eq!(mistakes(&ball("radius: -inf")), ["4:34 expected a finite number, found `-inf`"]);
    assert_eq!(
        mistakes(&ball("radius: 1e999")),
        ["4:34 this number is too large / 64-bit floating point reaches about 1.79e308"]
    );
    assert_eq!(
        mistakes(&ball("radius: 1, position: (0, 1e12, 0)")),
        ["4:51 the position is 1000000000000; expected -1000000000 to 1000000000"]
    );
    assert_eq!(mistakes(&ball("radius: \"1\"")), ["4:34 expected a number, found a text in quotes"]);
    assert_eq!(
        mistakes(&ball("radius: 1, position: 3")),
        ["4:47 expected the position as `(x, y, z)`, found a number"]
    );
    let flat = mistakes(&scene("", "Cube(material: \"grey\", size: (1, 0, 1))"));
    assert_eq!(flat, ["4:34 the size is 0; expected 0.000001 to 1000000000"]);
}

#[test]
fn colours_say_how_they_are_written() {
    let said = |color: &str| {
        let text = format!(
            "Scene(version: 1, materials: [(name: \"a\", color: {color})], objects: [Plane(material: \"a\", size: 1)])"
        );
        mistakes(&text)
    };
    assert_eq!(said("\"#ff8000\""), [""; 0]);
    let web = "write `\"#rrggbb\"` with six hexadecimal digits, or `(red, green, blue)` from 0 to 1";
    assert_eq!(said("\"red\""), [format!("1:50 `red` is not a colour / {web}")]);
    assert_eq!(said("\"#+f8000\""), [format!("1:50 `#+f8000` is not a colour / {web}")]);
    assert_eq!(said("(0, 2, 0)"), ["1:54 the colour is 2; expected 0 to 1"]);
    assert_eq!(said("3"), ["1:50 expected the colour as `(red, green, blue)` or `\"#rrggbb\"`, found a number"]);
}

#[test]
fn names_are_given_once() {
    let text = "Scene(version: 1, materials: [\n(name: \"a\"),\n(name: \"a\"),\n], objects: [\n\
                Sphere(name: \"b\", material: \"a\", radius: 1),\nSphere(name: \"b\", material: \"a\", radius: 1),\n])";
    assert_eq!(
        mistakes(text),
        ["3:8 `a` is the name of more than one material", "6:14 `b` is the name of more than one object"]
    );
    let control = mistakes("Scene(version: 1, materials: [(name: \"a\u{7}\")], objects: [])");
    assert_eq!(control, ["1:40 the name of a material holds the control character \\u{7}"]);
}

#[test]
fn counts_are_bounded() {
    let grid = |count: &str| mistakes(&ball(&format!("radius: 1, repeat: Grid(count: {count}, step: (1, 1, 1))")));
    assert_eq!(grid("(0, 1, 1)"), ["4:58 the count is 0; expected 1 to 250000"]);
    assert_eq!(grid("(1.5, 1, 1)"), ["4:58 expected a whole number, found `1.5`"]);
    assert_eq!(grid("(1000, 1000, 1)"), ["4:57 this grid has 1000000 objects / at most 250000 are allowed"]);
    let many = "Cube(material: \"grey\", size: 1, repeat: Ring(count: 200000, radius: 9)),\n".repeat(1000);
    assert_eq!(
        mistakes(&scene("", &many)),
        ["5:1 with these the scene has 400000 objects / at most 250000 are allowed"]
    );
    let lights = format!("lights: [{}],", "(position: (0, 0, 0)),".repeat(4097));
    assert_eq!(mistakes(&scene(&lights, "")), ["2:9 the scene has 4097 lights / at most 4096 are allowed"]);
}

#[test]
fn cameras_are_known_by_their_names_and_the_first_one_is_the_default() {
    let front = "(name: \"front\", position: (0, 0, 9), target: (0, 0, 0))";
    let top = "(name: \"top\", position: (0, 9, 0), target: (0, 0, 0), up: (0, 0, -1))";
    let plain = "camera: (position: (9, 0, 0), target: (0, 0, 0)),";
    let read = |fields: &str| read(&scene(fields, "")).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let named = read(&format!("cameras: [{front}, {top}],"));
    assert_eq!(named.camera_named(None), named.camera_named(Some("front")));
    assert_eq!(named.camera_named(Some("top")).map(|camera| camera.position()), Some(DVec3::new(0.0, 9.0, 0.0)));
    assert_eq!(named.camera_named(Some("side")), None);
    let beside = read(&format!("{plain} cameras: [{front}],"));
    assert_eq!(beside.camera_named(None).map(|camera| camera.position()), Some(DVec3::new(9.0, 0.0, 0.0)));
    assert_eq!(beside.cameras.len(), 1);
    let twice = mistakes(&scene(&format!("cameras: [{front}, {front}],"), ""));
    assert_eq!(twice.len(), 1, "{twice:?}");
    assert!(twice[0].starts_with("2:"), "{twice:?}");
}

#[test]
fn cameras_and_suns_need_a_direction() {
    let camera = "camera: (position: (0, 1, 0), target: (0, 1, 0)),";
    let help = "position and target must differ, and the view must not run along `up`";
    let place = "2:39 this leaves the camera's direction open";
    assert_eq!(mistakes(&scene(camera, "")), [format!("{place} / {help}")]);
    assert_eq!(
        mistakes(&scene("camera: (position: (0, 9, 0), target: (0, 1, 0)),", "")),
        [format!("{place} / {help}")]
    );
    let sun = mistakes(&scene("sun: (direction: (0, 0, 0)),", "Plane(material: \"grey\", size: 1)"));
    assert_eq!(sun, ["2:18 the sun's direction has no length, so it points nowhere"]);
    let wide = mistakes(&scene("camera: (position: (0, 9, 0), target: (1, 1, 0), fov: 180),", ""));
    let short = mistakes(&scene("camera: (position: (0, 9, 0), target: (1, 1, 0), near: 2, far: 2),", ""));
    let help = "a far plane lies behind the near plane; without `far` the camera sees infinitely far";
    assert_eq!(short, [format!("2:64 the far distance (2) isn't greater than the near distance (2) / {help}")]);
    assert_eq!(wide, ["2:55 the field of view is 180; expected 1 to 170"]);
}

#[test]
fn all_mistakes_are_told_at_once_in_the_order_of_the_file() {
    let text = scene(
        "sun: (direction: (0, 0, 0)), ambient: (1, 1),",
        "Sphere(material: \"grey\", radius: 0, position: (inf, 0, 0)),\nCube(material: \"gren\", size: (1, 1)),",
    );
    let told = mistakes(&text);
    let places: Vec<&str> = told.iter().filter_map(|mistake| mistake.split(' ').next()).collect();
    assert_eq!(places, ["2:18", "2:39", "4:34", "4:48", "5:16", "5:30"], "{told:#?}");
}

#[test]
fn objects_stand_where_the_file_says() {
    let text = scene(
        "",
        "Cube(material: \"grey\", position: (10, 0, 0), size: (2, 4, 6), rotation: (0, 90, 0)),\n\
         Plane(material: \"grey\", size: (4, 2), rotation: (90, 0, 0)),\n\
         Sphere(material: \"grey\", position: (0, 5, 0), radius: 1, repeat: Grid(count: (2, 1, 2), step: (4, 0, 6))),\n\
         Sphere(material: \"grey\", radius: 1, repeat: Ring(count: 4, radius: 3, start: 90)),",
    );
    let scene = read(&text).unwrap_or_else(|said| panic!("{said}"));
    let at =
        |object: usize, x: f64, y: f64, z: f64| scene.objects[object].transform.transform_point3(DVec3::new(x, y, z));
    let near = |is: DVec3, x: f64, y: f64, z: f64| assert!(is.abs_diff_eq(DVec3::new(x, y, z), 1e-5), "{is}");
    near(at(0, 0.5, 0.5, 0.0), 10.0, 2.0, -1.0);
    near(at(0, 0.0, 0.0, 0.5), 13.0, 0.0, 0.0);
    near(at(1, 0.5, 0.0, 0.5), 2.0, -1.0, 0.0);
    let middles: Vec<DVec3> = (2..10).map(|object| at(object, 0.0, 0.0, 0.0)).collect();
    let grid = [(-2.0, -3.0), (2.0, -3.0), (-2.0, 3.0), (2.0, 3.0)];
    for (middle, (x, z)) in middles.iter().zip(grid) {
        near(*middle, x, 5.0, z);
    }
    let ring = [(3.0, 0.0), (0.0, -3.0), (-3.0, 0.0), (0.0, 3.0)];
    for (middle, (x, z)) in middles[4..].iter().zip(ring) {
        near(*middle, x, 0.0, z);
    }
    assert_eq!(scene.meshes.len(), 3, "spheres share a mesh");
}

#[test]
fn materials_are_what_the_file_says() {
    let text = "Scene(version: 1, materials: [
        (name: \"a\", color: \"#ff8000\", opacity: 0.5, alpha: Blend),
        (name: \"b\", color: (0.25, 0.5, 1), alpha: Mask(0.25), double_sided: true, texture: Dots(count: (2, 3), radius: 0.25)),
        (name: \"c\", emissive: (1, 0.5, 0), strength: 8, alpha: Opaque(), texture: Dots(count: (2, 3), radius: 0.25)),
        (name: \"d\", texture: Checker(count: (2, 2), colors: (\"#010203\", \"#ffffff\"))),
    ], objects: [Cube(material: [\"a\", \"b\", \"c\", \"d\"], size: 1, repeat: Grid(count: (5, 1, 1), step: (2, 0, 0)))])";
    let scene = read(text).unwrap_or_else(|said| panic!("{said}"));
    let [a, b, c, d] = &scene.materials[..] else { panic!("four materials") };
    assert_eq!((a.base_color[0], a.base_color[2], a.base_color[3], a.alpha), (1.0, 0.0, 0.5, AlphaMode::Blend));
    assert!((a.base_color[1] - 0.215_861).abs() < 1e-5, "sRGB 128 is {} linear", a.base_color[1]);
    assert_eq!((b.base_color, b.alpha), ([0.25, 0.5, 1.0, 1.0], AlphaMode::Mask { cutoff: 0.25 }));
    assert_eq!((b.double_sided, c.double_sided), (true, false));
    assert_eq!((c.emissive, c.alpha), ([8.0, 4.0, 0.0], AlphaMode::Opaque));
    assert_eq!((b.base_color_texture, c.base_color_texture, d.base_color_texture), (Some(0), Some(0), Some(1)));
    let (dots, checker) = (&scene.textures[0], &scene.textures[1]);
    let alpha = |x: u32, y: u32| dots.rgba8[4 * (y * dots.width + x) as usize + 3];
    assert_eq!((dots.width, dots.height), (128, 192));
    assert_eq!((alpha(0, 0), alpha(32, 32), alpha(32 + 18, 32), alpha(32 + 14, 32)), (255, 0, 255, 0));
    assert_eq!(checker.rgba8[..4], [1, 2, 3, 255]);
    let materials: Vec<usize> = scene.objects.iter().map(|object| object.material).collect();
    assert_eq!(materials, [0, 1, 2, 3, 0], "copies take them by turns");
}

#[test]
fn cameras_and_objects_move_and_spin_as_the_file_says() {
    let text = scene(
        "camera: (position: (0, 0, 9), target: (0, 0, 0), velocity: (3, 0, 0), spin: (0, 90, 0)),
         cameras: [(name: \"still\", position: (0, 0, 9), target: (0, 0, 0))],",
        "Sphere(material: \"grey\", position: (0, 2, 0), radius: 1, velocity: (0, -1, 0), spin: (0, 0, 180)),
         Cube(material: \"grey\", size: 1)",
    );
    let scene = read(&text).unwrap_or_else(|said| panic!("{said}"));
    assert!(scene.moves());
    assert_eq!(scene.at(0), scene, "the first frame shows what the file says");
    // Two seconds: six metres, half a turn; two metres down, a whole turn.
    let later = scene.at(120);
    let near = |is: DVec3, x: f64, y: f64, z: f64| assert!(is.abs_diff_eq(DVec3::new(x, y, z), 1e-5), "{is}");
    near(later.camera.position(), 6.0, 0.0, 9.0);
    near(later.camera.transform.transform_vector3(DVec3::NEG_Z), 0.0, 0.0, 1.0);
    let ball = later.objects[0].transform;
    near(ball.transform_point3(DVec3::ZERO), 0.0, 0.0, 0.0);
    near(ball.transform_vector3(DVec3::X), 2.0, 0.0, 0.0);
    near(scene.at(30).objects[0].transform.transform_vector3(DVec3::X), 0.0, 2.0, 0.0);
    assert_eq!(later.objects[1], scene.objects[1]);
    assert_eq!(later.cameras, scene.cameras);
    assert!(!read(&ball_at_rest()).unwrap_or_else(|said| panic!("{said}")).moves());
}

fn ball_at_rest() -> String {
    ball("radius: 1, velocity: (0, 0, 0)")
}

#[test]
fn movements_that_cannot_be_are_told() {
    let told = mistakes(&ball("radius: 1, velocity: (1, 2), spin: (0, 1e9, 0)"));
    let [first, second] = &told[..] else { panic!("{told:#?}") };
    assert!(first.contains("the velocity as `(x, y, z)`"), "{first}");
    assert!(second.contains("the spin is 1000000000; expected -36000 to 36000"), "{second}");
}
