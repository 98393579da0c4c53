//! Textures of a pipeline: read from files beside it, checked without a GPU, sampled on real drivers as the file says.

use crate::testing::{Outcome, Place, Vulkan};
use image::{ImageBuffer, Rgb, Rgba, RgbaImage};

/// A picture of 5 × 3 texels that repeats and is mirrored over one of 16 × 8, and a table of 4 × 4 × 4.
const PIPELINE: &str = r#"Pipeline(
    version: 1,
    settings: [(name: "mirror", value: Bool(default: false))],
    textures: [
        (name: "tile", file: "pictures/tile.png", color_space: Linear),
        (name: "deep_tile", file: "pictures/deep.png", color_space: Linear),
        (name: "table", file: "pictures/table.png", color_space: Linear, shape: D3),
    ],
    images: [
        (name: "repeated", format: R8G8B8A8_UNORM, size: Fixed(16, 8)),
        (name: "mirrored", format: R8G8B8A8_UNORM, size: Fixed(16, 8)),
        (name: "looked_up", format: R16G16B16A16_SFLOAT, size: Fixed(16, 8)),
        (name: "deep", format: R16G16B16A16_UNORM, size: Fixed(16, 8)),
    ],
    passes: [
        (name: "repeat", draw: FullScreen("tile"), color: ["repeated"],
            sample: {"source": (image: "tile", filter: Nearest, address: Repeat)}),
        (name: "mirror", draw: FullScreen("tile"), color: ["mirrored"],
            sample: {"source": (image: "tile", filter: Nearest, address: Mirror)}),
        (name: "deep", draw: FullScreen("tile"), color: ["deep"],
            sample: {"source": (image: "deep_tile", filter: Nearest, address: Clamp)}),
        (name: "look_up", draw: FullScreen("look_up"), sample: {"source": "table"}, color: ["looked_up"]),
    ],
    outputs: ["repeated", "mirrored", "deep", (image: "looked_up", encoding: Linear)],
)"#;

/// Texels of the picture's own size, counted from a place before its upper left corner.
const TILE: &str = "#version 460
layout(set = 0, binding = 0) uniform sampler2D source;
layout(location = 0) out vec4 color;
void main() {
    color = texture(source, (gl_FragCoord.xy - vec2(7.0, 4.0)) / vec2(textureSize(source, 0)));
}";

/// The identity at texel centres, in red, green and blue.
const LOOK_UP: &str = "#version 460
layout(set = 0, binding = 0) uniform sampler3D source;
layout(location = 0) out vec4 color;
void main() {
    const vec3 value = vec3(gl_FragCoord.x / 16.0, gl_FragCoord.y / 8.0, 0.5);
    color = vec4(texture(source, (value * 3.0 + 0.5) / 4.0).rgb, 1.0);
}";

fn tile(x: u32, y: u32) -> [u8; 3] {
    [x, y, x * y].map(|value| u8::try_from(20 * value + 3).expect("small"))
}

fn place() -> Place {
    let place = Place::new();
    std::fs::create_dir(place.path("pictures")).expect("a folder");
    let eight: RgbaImage = ImageBuffer::from_fn(5, 3, |x, y| {
        let [red, green, blue] = tile(x, y);
        Rgba([red, green, blue, 255])
    });
    eight.save(place.path("pictures/tile.png")).expect("written");
    let sixteen: ImageBuffer<Rgb<u16>, Vec<u16>> =
        ImageBuffer::from_fn(5, 3, |x, y| Rgb(tile(x, y).map(|value| u16::from(value) * 251 + 1)));
    sixteen.save(place.path("pictures/deep.png")).expect("written");
    let table: ImageBuffer<Rgb<u8>, Vec<u8>> =
        ImageBuffer::from_fn(
            16,
            4,
            |x, y| Rgb([x % 4, y, x / 4].map(|value| u8::try_from(85 * value).expect("small"))),
        );
    table.save(place.path("pictures/table.png")).expect("written");
    place.file("textures.ron", PIPELINE);
    place.file("tile.frag", TILE);
    place.file("look_up.frag", LOOK_UP);
    place
}

fn run(place: &Place, vulkan: Vulkan) -> Option<Outcome> {
    let variables = vulkan.variables()?;
    let arguments = ["run", "textures.ron", "--scene", "spheres_and_cubes", "--size", "16x8", "--validate"];
    let outputs =
        ["-o", "repeated.png", "-o", "mirrored=mirrored.png", "-o", "deep=deep.png", "-o", "looked_up=table.exr"];
    Some(place.run_with(&variables, &[&arguments[..], &outputs].concat()))
}

/// The texel of a side of `size` texels that lies at `at`, which may lie beyond the edges.
fn repeated(at: i64, size: i64) -> u32 {
    u32::try_from(at.rem_euclid(size)).expect("inside")
}

fn mirrored(at: i64, size: i64) -> u32 {
    let at = at.rem_euclid(2 * size);
    u32::try_from(at.min(2 * size - 1 - at)).expect("inside")
}

fn clamped(at: i64, size: i64) -> u32 {
    u32::try_from(at.clamp(0, size - 1)).expect("inside")
}

fn draws_what_the_files_hold(vulkan: Vulkan) {
    let place = place();
    let Some(outcome) = run(&place, vulkan) else { return };
    let outcome = outcome.exits(0);
    assert!(outcome.out.contains("validation: silent; "), "{}", outcome.out);
    let open = |name: &str| image::open(place.path(name)).expect("a picture");
    let expected =
        |x: u32, y: u32, address: fn(i64, i64) -> u32| tile(address(i64::from(x) - 7, 5), address(i64::from(y) - 4, 3));
    for (file, address) in [("repeated.png", repeated as fn(i64, i64) -> u32), ("mirrored.png", mirrored)] {
        for (x, y, texel) in open(file).into_rgb8().enumerate_pixels() {
            // An image that no output declares is shown as a display shows it: encoded.
            assert_eq!(texel.0, expected(x, y, address).map(encoded), "{file} at {x}, {y}");
        }
    }
    for (x, y, texel) in open("deep.png").into_rgb8().enumerate_pixels() {
        let linear = expected(x, y, clamped).map(|value| f64::from(u16::from(value) * 251 + 1) / 65535.0);
        for (found, linear) in texel.0.into_iter().zip(linear) {
            let wanted = 255.0 * encode(linear);
            assert!((f64::from(found) - wanted).abs() < 0.51, "deep at {x}, {y}: {found} and {wanted}");
        }
    }
    for (x, y, texel) in open("table.exr").into_rgb32f().enumerate_pixels() {
        let wanted = [(f64::from(x) + 0.5) / 16.0, (f64::from(y) + 0.5) / 8.0, 0.5];
        for (found, wanted) in texel.0.into_iter().zip(wanted) {
            // Filters have 8 bits between texels, a third of the range apart; half floats have 11.
            assert!((f64::from(found) - wanted).abs() < 0.003, "table at {x}, {y}: {found} and {wanted}");
        }
    }
}

/// A share of 255 with the sRGB curve (IEC 61966-2-1).
fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

fn encoded(value: u8) -> u8 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let encoded = (255.0 * encode(f64::from(value) / 255.0)).round() as u8;
    encoded
}

/// OpenEXR files of one component, as `run` writes them of numbers and integers, hold for a texture what was drawn.
#[test]
fn a_picture_of_one_component_that_run_wrote_is_read_back_as_a_texture() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let run = |pipeline: &str, images: &str, passes: &str, file: &str| {
        let text = format!("Pipeline(version: 1, {images}, passes: [{passes}], outputs: [\"o\"])");
        place.file(pipeline, text);
        let run = ["run", pipeline, "--scene", "spheres_and_cubes", "--size", "4x2", "-o", file];
        place.run_with(&variables, &run).exits(0);
        std::fs::read(place.path(file)).expect("written")
    };
    let image = |format: &str| format!(r#"images: [(name: "o", format: {format}, size: Output)]"#);
    // No number has all its bits in half of them.
    place.file(
        "numbers.frag",
        "#version 460\nlayout(location = 0) out float v;
        void main() { v = 1000.0 * gl_FragCoord.x + gl_FragCoord.y + 0.1; }",
    );
    place.file(
        "read.frag",
        "#version 460\nlayout(set = 0, binding = 0) uniform sampler2D t;\nlayout(location = 0) out float v;
        void main() { v = texelFetch(t, ivec2(gl_FragCoord.xy), 0).r; }",
    );
    let read_back = |file: &str| {
        let texture =
            format!(r#"textures: [(name: "t", file: "{file}", color_space: Linear, format: R32G32B32A32_SFLOAT)]"#);
        let passes = r#"(name: "f", draw: FullScreen("read"), sample: {"t": "t"}, color: ["o"])"#;
        run("read.ron", &format!("{texture}, {}", image("R32_SFLOAT")), passes, "read.exr")
    };
    let drawn = r#"(name: "f", draw: FullScreen("numbers"), color: ["o"])"#;
    let numbers = run("numbers.ron", &image("R32_SFLOAT"), drawn, "numbers.exr");
    assert!(read_back("numbers.exr") == numbers, "they are others");
    let filled = |value: &str| format!(r#"(name: "f", fill: (to: "o", value: {value}))"#);
    for (format, value) in [("R16_UINT", "65535"), ("R32_UINT", "1234567"), ("R8_SINT", "-7")] {
        run("whole.ron", &image(format), &filled(value), "whole.exr");
        let as_float = run("float.ron", &image("R32_SFLOAT"), &filled(value), "float.exr");
        assert!(read_back("whole.exr") == as_float, "{format}");
    }
}

#[test]
fn lavapipe_draws_what_the_files_hold_and_what_lies_beyond_their_edges() {
    draws_what_the_files_hold(Vulkan::LAVAPIPE_CURRENT);
}

#[test]
fn swiftshader_draws_what_the_files_hold_and_what_lies_beyond_their_edges() {
    draws_what_the_files_hold(Vulkan::SWIFTSHADER_CURRENT);
}

#[test]
fn textures_that_are_missing_damaged_or_outside_are_found_with_their_place_without_a_gpu() {
    let place = place();
    place.run(&["check", "textures.ron"]).exits(0);
    let whole = std::fs::read(place.path("pictures/deep.png")).expect("read");
    place.file("pictures/deep.png", &whole[..20]);
    std::fs::remove_file(place.path("pictures/table.png")).expect("removed");
    let answer = place.run(&["check", "textures.ron"]).exits(1);
    let answer = answer.mentions("error: `pictures/deep.png` is no picture that can be read: ");
    let answer = answer.mentions("--> textures.ron:6:35").mentions("error: `pictures/table.png` can't be read: ");
    answer.mentions("--> textures.ron:7:31");
    let outside = PIPELINE.replace("pictures/deep.png", "../deep.png").replace("pictures/table.png", "/table.png");
    place.file("textures.ron", outside);
    let answer = place.run(&["check", "textures.ron"]).exits(1);
    let answer = answer.mentions("error: `../deep.png` leads out of").mentions("error: `/table.png` leads out of");
    answer.mentions("help: give a folder that holds both; `--root` names it, or `--allow-outside` allows all");
}

#[test]
fn what_no_texture_can_be_used_for_is_said_where_it_stands() {
    let place = place();
    let drawn = PIPELINE.replace(r#"color: ["mirrored"]"#, r#"color: ["tile"]"#);
    let drawn = drawn.replace(r#"outputs: ["repeated", "mirrored", "#, r#"outputs: ["repeated", "table", "#);
    place.file("textures.ron", drawn);
    let answer = place.run(&["check", "textures.ron"]).exits(1);
    let answer = answer.mentions("error: `mirror` does more with `tile` than sample it: it comes from a file");
    let answer = answer.mentions("help: passes only sample a texture: declare an image and draw into that");
    answer
        .mentions("error: `table` is an output and comes from a file: no pass makes it")
        .mentions("--> textures.ron:");
}

#[test]
fn a_texture_that_was_changed_after_the_check_is_no_crash() {
    let place = place();
    let Some(outcome) = run(&place, Vulkan::LAVAPIPE) else { return };
    outcome.exits(0);
    let whole = std::fs::read(place.path("pictures/tile.png")).expect("read");
    // The header stays, the texels go.
    place.file("pictures/tile.png", &whole[..whole.len() - 20]);
    place.run(&["check", "textures.ron"]).exits(0);
    let Some(outcome) = run(&place, Vulkan::LAVAPIPE) else { return };
    let answer = outcome.exits(1).mentions("error: `pictures/tile.png` is no picture that can be read: ");
    answer.mentions("--> textures.ron:5:16");
}

#[test]
fn no_texture_is_written_over() {
    let place = place();
    let before = std::fs::read(place.path("pictures/tile.png")).expect("read");
    for answer in [
        place.run(&["inspect", "textures.ron", "-o", "pictures/tile.png"]),
        place.run(&["run", "textures.ron", "--scene", "spheres_and_cubes", "-o", "pictures/tile.png"]),
    ] {
        answer.exits(2).mentions("`pictures/tile.png` is the texture itself, which would be lost");
    }
    assert_eq!(std::fs::read(place.path("pictures/tile.png")).expect("read"), before);
}

#[test]
fn no_shader_is_written_over() {
    let place = place();
    let answer = place.run(&["inspect", "textures.ron", "-o", "look_up.frag"]);
    answer.exits(2).mentions("`look_up.frag` is a shader by its name, which would be lost");
    // Nor one that isn't read, because its pass is off.
    place.file("off.frag", LOOK_UP);
    let answer = place.run(&["inspect", "forward", "-o", "off.frag"]);
    answer.exits(2).mentions("`off.frag` is a shader by its name, which would be lost");
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let run = ["run", "textures.ron", "--scene", "spheres_and_cubes", "--report", "look_up.frag"];
    place.run_with(&variables, &run).exits(2).mentions("`look_up.frag` is a shader by its name, which would be lost");
    assert_eq!(std::fs::read_to_string(place.path("look_up.frag")).expect("read"), LOOK_UP);
}
