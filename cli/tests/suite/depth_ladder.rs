//! A pass samples multisampled depth, one value a texel: what it finds, and what that takes (IQ-10 to IQ-15).

use crate::testing::{Place, Vulkan};

/// Three ways to draw depth: opaque, perforated and fading objects, and then what is there as a picture.
const PIPELINE: &str = r#"Pipeline(
    version: 1,
    settings: [
        (name: "msaa", value: OneOf(default: 4, of: [1, 4])),
        (name: "by_hand", value: Bool(default: false)),
        (name: "quality", value: OneOf(default: "DepthOnly", of: ["DepthOnly", "SampleZero", "Min", "Max", "Average"])),
    ],
    images: [
        (name: "color", format: R16G16B16A16_SFLOAT, size: Output, samples: "msaa"),
        (name: "depth", format: Depth, size: Like("color"), samples: Like("color"), resolve: "quality"),
        (name: "seen", format: R32G32B32A32_SFLOAT, size: Output),
    ],
    passes: [
        (name: "opaque", draw: Objects(Opaque), shader: "lit",
            color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
        (name: "masked", draw: Objects(Masked), shader: "lit_masked", color: ["color"], depth: "depth"),
        (name: "sky", draw: Sky, color: ["color"], depth: (image: "depth", write: false)),
        (name: "look", when: "!by_hand", draw: FullScreen("depth_as_color"), sample: {"depth": "depth"}, color: ["seen"]),
        (name: "work_out", when: "by_hand", draw: FullScreen("samples_as_color"), sample: {"depth": Samples("depth")},
            params: {"least": "quality == 'Min'", "greatest": "quality == 'Max'", "mean": "quality == 'Average'"},
            color: ["seen"]),
    ],
    outputs: ["seen"],
)"#;

const SHADER: &str = "#version 460
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(location = 0) out vec4 color;
void main() {
    color = vec4(texelFetch(depth, ivec2(gl_FragCoord.xy), 0).r);
}
";

/// The value that each mode has to find, worked out from the samples.
const BY_HAND: &str = "#version 460
layout(set = 0, binding = 0) uniform sampler2DMS depth;
layout(set = 0, binding = 1) uniform params { bool least; bool greatest; bool mean; };
layout(location = 0) out vec4 color;
void main() {
    const ivec2 texel = ivec2(gl_FragCoord.xy);
    float found = texelFetch(depth, texel, 0).r;
    for (int number = 1; number < textureSamples(depth); ++number) {
        const float other = texelFetch(depth, texel, number).r;
        found = least ? min(found, other) : greatest ? max(found, other) : mean ? found + other : found;
    }
    color = vec4(mean ? found / float(textureSamples(depth)) : found);
}
";

/// Instances, turned and mirrored faces, holes by a texture, and fading either way.
const SCENE: &str = r#"Scene(
    version: 1,
    camera: (position: (0, 2, 9), target: (0, 0.5, 0), fov: 40),
    materials: [
        (name: "plain", color: (1, 1, 1)),
        (name: "sieve", color: (1, 1, 1), texture: Dots(count: (20, 10), radius: 0.34), alpha: Mask(0.5), double_sided: true),
        (name: "lattice", color: (1, 1, 1), texture: Dots(count: (4, 4), radius: 0.4), alpha: Mask(0.5)),
    ],
    objects: [
        Plane(name: "floor", material: "plain", size: (30, 30)),
        Sphere(name: "ring", material: "plain", position: (0, 0.4, 0), radius: 0.4, repeat: Ring(count: 9, radius: 2.5, start: 12)),
        Sphere(name: "sieve", material: "sieve", position: (-1.2, 1.1, 1.5), radius: 1.1, rotation: (14, 0, 8)),
        Cube(name: "lattice", material: "lattice", position: (1.6, 0.9, 1.2), size: 1.7, rotation: (0, 28, 0)),
        Cube(name: "fading", material: "plain", position: (0.2, 1.2, 2.5), size: 1.2, rotation: (20, 30, 0), cross_fade: 0.4),
        Sphere(name: "coming", material: "plain", position: (0.2, 1.2, 2.5), radius: 0.8, cross_fade: -0.4),
        Sphere(name: "fading sieve", material: "sieve", position: (2.6, 1.0, 2.8), radius: 0.8, cross_fade: 0.7),
    ],
)"#;

fn place() -> Place {
    let place = Place::new();
    place.file("p.ron", PIPELINE);
    place.file("depth_as_color.frag", SHADER);
    place.file("samples_as_color.frag", BY_HAND);
    place.file("s.ron", SCENE);
    place
}

const DRIVERS: [(&str, Vulkan); 2] =
    [("lavapipe", Vulkan::LAVAPIPE_CURRENT), ("swiftshader", Vulkan::SWIFTSHADER_CURRENT)];

/// Runs the pipeline and returns the depth that the pass saw, texel by texel, and what was said.
fn seen(place: &Place, (name, vulkan): (&str, Vulkan), set: &[&str]) -> Option<(Vec<u8>, String)> {
    let file = format!("{name}_{}.exr", set.join("_").replace('=', "_"));
    let variables = vulkan.variables()?;
    let mut arguments = vec!["run", "p.ron", "--scene", "s.ron", "--size", "160x120", "--validate", "-o", &file];
    set.iter().for_each(|set| arguments.extend(["--set", set]));
    let said = place.run_with(&variables, &arguments).exits(0).out;
    assert!(said.contains("validation: silent; "), "{said}");
    Some((std::fs::read(place.path(&file)).expect("it is written"), said))
}

#[test]
fn iq_12_and_13_depth_drawn_again_is_bit_for_bit_that_of_one_sample_on_both_drivers() {
    let place = place();
    for driver in DRIVERS {
        let Some((drawn_once, _)) = seen(&place, driver, &["msaa=1"]) else { return };
        let Some((drawn_again, _)) = seen(&place, driver, &["msaa=4"]) else { return };
        assert!(drawn_once == drawn_again, "{}", driver.0);
    }
}

/// IQ-10: nothing is averaged unless the file says so; IQ-14: a mode gives its value, whether a draw or the device resolves.
#[test]
fn iq_14_each_mode_finds_what_the_samples_say_on_both_drivers() {
    let place = place();
    for driver in DRIVERS {
        let mut all = Vec::new();
        for quality in ["quality=SampleZero", "quality=Min", "quality=Max", "quality=Average"] {
            let Some((resolved, _)) = seen(&place, driver, &[quality]) else { return };
            let Some((worked_out, _)) = seen(&place, driver, &[quality, "by_hand=true"]) else { return };
            assert!(resolved == worked_out, "{quality} on {}", driver.0);
            assert!(!all.contains(&resolved), "{quality} on {} is another mode", driver.0);
            all.push(resolved);
        }
    }
}

/// Neither driver has more than sample zero, and lavapipe says that it averages.
#[test]
fn iq_14_a_drivers_lie_is_found_and_kept_in_its_profile() {
    let place = place();
    for ((name, vulkan), refuted) in DRIVERS.into_iter().zip(["refuted_depth_resolve: [\n        AVERAGE,\n    ]", ""])
    {
        let Some(variables) = vulkan.variables() else { return };
        let file = format!("{name}.ron");
        place.run_with(&variables, &["devices", "--save", &file, "--device", "0"]).exits(0);
        let profile = std::fs::read_to_string(place.path(&file)).expect("it is written");
        assert!(profile.contains("depth_resolve: [\n        SAMPLE_ZERO,\n    ]"), "{name}");
        assert_eq!(profile.contains("refuted_depth_resolve"), !refuted.is_empty(), "{name}");
        assert!(profile.contains(refuted), "{name}");
    }
}

#[test]
fn the_listing_shows_what_is_drawn_again_before_its_reader_with_its_draws() {
    let place = place();
    let Some((_, said)) = seen(&place, DRIVERS[0], &["msaa=4"]) else { return };
    let row = |name: &str| {
        let cells = said.lines().filter(|line| line.starts_with('|')).map(|line| line.split('|').map(str::trim));
        let mut rows = cells.map(Iterator::collect::<Vec<_>>).enumerate();
        let found = rows.find(|(_, cells)| cells.get(2) == Some(&name));
        found.map(|(at, cells)| (at, cells[3].to_owned())).unwrap_or_else(|| panic!("{name} in {said}"))
    };
    assert_eq!((row("opaque (depth only)").1, row("masked (depth only)").1), (row("opaque").1, row("masked").1));
    assert!(row("masked (depth only)").0 < row("look").0, "{said}");
}
