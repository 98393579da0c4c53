//! Pictures hold all of an image, or it is said what they leave out: layers, faces, slices, mip levels, components, stencil.

use crate::testing::{Outcome, Place, Vulkan};
use exr::prelude::FlatSamples;

/// A frame that leaves an image, as these passes fill it.
fn filled(image: &str, passes: &str, output: &str) -> String {
    format!(r#"Pipeline(version: 1, images: [(name: "o", {image})], passes: [{passes}], outputs: [{output}])"#)
}

/// Draws what fills an image, and writes its picture.
fn run(place: &Place, text: &str, file: &str) -> Option<Outcome> {
    let variables = Vulkan::LAVAPIPE.variables()?;
    place.file("p.ron", text);
    Some(place.run_with(&variables, &["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "4x2", "-o", file]))
}

fn pixels(place: &Place, file: &str) -> ([u32; 2], Vec<[u8; 3]>) {
    let picture = image::open(place.path(file)).expect("a picture").into_rgb8();
    ([picture.width(), picture.height()], picture.pixels().map(|pixel| pixel.0).collect())
}

/// The channels of an OpenEXR file: name and samples of the first texel, as bits of a word, and whether they are floats.
fn channels(place: &Place, file: &str) -> Vec<(String, u32, bool)> {
    let image = exr::prelude::read_first_flat_layer_from_file(place.path(file)).expect("an OpenEXR file");
    let first = |samples: &FlatSamples| match samples {
        FlatSamples::U32(words) => (words[0], false),
        FlatSamples::F32(floats) => (floats[0].to_bits(), true),
        FlatSamples::F16(halves) => (halves[0].to_f32().to_bits(), true),
    };
    let list = image.layer_data.channel_data.list.iter();
    list.map(|channel| {
        let (bits, float) = first(&channel.sample_data);
        (channel.name.to_string(), bits, float)
    })
    .collect()
}

#[test]
fn layers_faces_and_slices_stand_side_by_side() {
    let place = Place::new();
    let layers = r#"(name: "f", repeat: ("i", 3), fill: (to: (image: "o", layer: "i"), value: "i / 2"))"#;
    let unorm = r#"(image: "o", encoding: Unorm)"#;
    let text = filled("format: R8G8B8A8_UNORM, size: Output, layers: 3", layers, unorm);
    let Some(outcome) = run(&place, &text, "layers.png") else { return };
    outcome.exits(0);
    let (size, texels) = pixels(&place, "layers.png");
    assert_eq!(size, [12, 2]);
    assert_eq!([0, 4, 8, 12 + 11].map(|at| texels[at][0]), [0, 128, 255, 255]);
    let cube = r#"(name: "f", repeat: ("i", 6), fill: (to: (image: "o", layer: "i"), value: "i / 5"))"#;
    let text = filled("format: R16_SFLOAT, size: Fixed(4, 4), shape: Cube", cube, r#""o""#);
    run(&place, &text, "cube.png").expect("drawn").exits(0);
    let (size, texels) = pixels(&place, "cube.png");
    assert_eq!((size, texels[0][0], texels[23][0]), ([24, 4], 0, 255));
    let text = filled(
        "format: R8_UNORM, size: Fixed(4, 2), shape: D3(3)",
        r#"(name: "f", fill: (to: "o", value: 1.0))"#,
        r#""o""#,
    );
    run(&place, &text, "slices.png").expect("drawn").exits(0);
    assert_eq!(pixels(&place, "slices.png"), ([12, 2], vec![[255; 3]; 24]));
}

#[test]
fn what_a_picture_leaves_out_is_said() {
    let fill = |value: &str| format!(r#"(name: "f", fill: (to: "o", value: {value}))"#);
    let unorm = r#"(image: "o", encoding: Unorm)"#;
    let place = Place::new();
    for (image, value, output, file, note) in [
        ("format: R8G8B8A8_UNORM, size: Output", "(1.0, 0.0, 0.0, 0.5)", unorm, "a.png", Some("alpha is left out")),
        ("format: R8G8B8A8_UNORM, size: Output", "(1.0, 0.0, 0.0, 1.0)", unorm, "a.png", None),
        (
            "format: R8G8B8A8_UINT, size: Output",
            "(1, 2, 3, 4)",
            r#""o""#,
            "a.png",
            Some("the fourth component is left out"),
        ),
        ("format: R8G8B8A8_UINT, size: Output", "(1, 2, 3, 4)", r#""o""#, "a.exr", None),
        (
            "format: R8_UNORM, size: Fixed(8, 8), mips: 3",
            "1.0",
            unorm,
            "a.png",
            Some("of 3 mip levels there is the first"),
        ),
        ("format: D32_SFLOAT_S8_UINT, size: Output", "(0.5, 3)", r#""o""#, "a.exr", Some("the stencil is left out")),
        ("format: R16G16B16A16_SFLOAT, size: Output", "(2.0, 0.0, 0.0, 0.5)", r#""o""#, "a.exr", None),
    ] {
        let Some(outcome) = run(&place, &filled(image, &fill(value), output), file) else { return };
        let said = outcome.exits(0).err;
        let told: Vec<&str> = said.lines().filter(|line| line.contains("in its picture")).collect();
        assert_eq!(told.len(), usize::from(note.is_some()), "{image}: {said}");
        assert!(note.is_none_or(|note| told[0].contains(note)), "{image}: {said}");
    }
    // Two components are red and green.
    let text = filled("format: R8G8_UNORM, size: Output", &fill("(1.0, 0.5, 0.0, 0.0)"), unorm);
    run(&place, &text, "two.png").expect("drawn").exits(0);
    assert_eq!(pixels(&place, "two.png").1[0], [255, 128, 0]);
}

/// What `--dump` writes of an image that is no output.
#[test]
fn dumps_hold_as_much_as_outputs_and_say_what_they_leave_out() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    let by = |count: u32| {
        format!(
            r#"(name: "f", repeat: ("i", {count}), fill: (to: (image: "o", layer: "i"), value: "i / {}"))"#,
            count - 1
        )
    };
    let all = |value: &str| format!(r#"(name: "f", fill: (to: "o", value: {value}))"#);
    // The size of the picture, some of its texels by their places, as a display shows them, and the note.
    type Dump<'d> = (&'d str, String, &'d str, [u32; 2], &'d [(usize, u8)], Option<&'d str>);
    let dumps: [Dump<'_>; 9] = [
        ("format: R8_UNORM, size: Output, layers: 3", by(3), "a.png", [12, 2], &[(0, 0), (4, 188), (23, 255)], None),
        (
            "format: R8_UNORM, size: Fixed(4, 4), shape: Cube",
            by(6),
            "a.png",
            [24, 4],
            &[(0, 0), (4, 124), (95, 255)],
            None,
        ),
        (
            "format: R8_UNORM, size: Fixed(4, 2), shape: D3(3)",
            all("1.0"),
            "a.png",
            [12, 2],
            &[(0, 255), (23, 255)],
            None,
        ),
        (
            "format: R8_UNORM, size: Fixed(8, 8), mips: 3",
            all("1.0"),
            "a.png",
            [8, 8],
            &[(0, 255)],
            Some("of 3 mip levels there is the first"),
        ),
        (
            "format: R8_UNORM, size: Fixed(4, 4), layers: 2, mips: 2",
            all("1.0"),
            "a.png",
            [8, 4],
            &[(31, 255)],
            Some("of 2 mip levels there is the first"),
        ),
        (
            "format: R8G8B8A8_UNORM, size: Output",
            all("(1.0, 0.0, 0.0, 0.5)"),
            "a.png",
            [4, 2],
            &[(0, 255)],
            Some("alpha is left out, which isn't 1"),
        ),
        ("format: R16G16B16A16_SFLOAT, size: Output", all("(1.0, 0.0, 0.0, 0.5)"), "a.exr", [4, 2], &[(0, 255)], None),
        (
            "format: R16G16B16A16_SFLOAT, size: Fixed(4, 4), shape: Cube",
            by(6),
            "a.exr",
            [24, 4],
            &[(0, 0), (95, 255)],
            None,
        ),
        (
            "format: D32_SFLOAT_S8_UINT, size: Output",
            all("(0.5, 3)"),
            "a.exr",
            [4, 2],
            &[],
            Some("the stencil is left out"),
        ),
    ];
    for (image, passes, file, size, texels, note) in dumps {
        let text = format!(
            r#"Pipeline(version: 1, images: [(name: "o", {image}), (name: "screen", format: R8_UNORM, size: Output)],
                passes: [{passes}, (name: "show", fill: (to: "screen", value: 0.0))], outputs: ["screen"])"#
        );
        place.file("p.ron", text);
        let dump = format!("o={file}");
        let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "4x2", "--dump", &dump];
        let said = place.run_with(&variables, &run).exits(0).err;
        let told: Vec<&str> = said.lines().filter(|line| line.contains("in its picture")).collect();
        assert_eq!(told.len(), usize::from(note.is_some()), "{image}: {said}");
        assert!(note.is_none_or(|note| told[0].ends_with(note)), "{image}: {said}");
        if texels.is_empty() {
            continue;
        }
        let (found, all) = pixels(&place, file);
        assert_eq!(found, size, "{image}");
        for (at, light) in texels {
            assert_eq!(all[*at][0], *light, "{image}, texel {at}");
        }
    }
}

#[test]
fn integers_keep_their_values_in_openexr_files() {
    let place = Place::new();
    let float = |value: f32| (value.to_bits(), true);
    for (format, value, expected) in [
        ("R8_UINT", "200", (200, false)),
        ("R32_UINT", "16777217", (16_777_217, false)),
        ("R32_UINT", "4294967295", (u32::MAX, false)),
        ("R8_SINT", "-128", float(-128.0)),
        ("R16_SINT", "-32768", float(-32_768.0)),
        ("R32_SINT", "-5", float(-5.0)),
        ("R32_SINT", "16777217", (16_777_217, false)),
        ("R32_SINT", "-16777217", ((-16_777_217_i32).cast_unsigned(), false)),
    ] {
        let fill = format!(r#"(name: "f", fill: (to: "o", value: {value}))"#);
        let text = filled(&format!("format: {format}, size: Output"), &fill, r#""o""#);
        let Some(outcome) = run(&place, &text, "a.exr") else { return };
        let said = outcome.exits(0).err;
        assert_eq!(channels(&place, "a.exr"), [("Y".to_owned(), expected.0, expected.1)], "{format} {value}");
        let wraps = expected.0 > i32::MAX.cast_unsigned() && !expected.1 && format == "R32_SINT";
        assert_eq!(said.contains("negative integers are 2³² more"), wraps, "{format} {value}: {said}");
    }
    let four = r#"(name: "f", fill: (to: "o", value: (1, 65535, 3, 4)))"#;
    run(&place, &filled("format: R16G16B16A16_UINT, size: Output", four, r#""o""#), "a.exr").expect("drawn").exits(0);
    let told: Vec<(String, u32)> = channels(&place, "a.exr").into_iter().map(|(name, word, _)| (name, word)).collect();
    let expected = [("A", 4), ("B", 3), ("G", 65535), ("R", 1)].map(|(name, word)| (name.to_owned(), word));
    assert_eq!(told, expected);
}

#[test]
fn compare_says_what_it_does_not_compare() {
    let place = Place::new();
    let half = r#"(name: "f", fill: (to: "o", value: (0.5, 0.5, 0.5, 0.5)))"#;
    let text = filled("format: R16G16B16A16_SFLOAT, size: Output", half, r#""o""#);
    let Some(outcome) = run(&place, &text, "half.exr") else { return };
    outcome.exits(0);
    run(&place, &text.replace("0.5, 0.5)", "0.5, 1.0)"), "opaque.exr").expect("drawn").exits(0);
    let outcome = place.run(&["compare", "half.exr", "opaque.exr"]).exits(0);
    assert_eq!(outcome.err.trim(), "note: not compared of `half.exr`: channel A");
    // Images of two components are compared too.
    let two = filled("format: R16G16_SFLOAT, size: Output", half, r#""o""#);
    run(&place, &two, "two.exr").expect("drawn").exits(0);
    place.run(&["compare", "two.exr", "two.exr"]).exits(0).says("");
}

#[test]
fn compare_names_the_layers_of_a_file_that_it_leaves_out() {
    use exr::prelude::*;
    let place = Place::new();
    let layer = |name: &str, channels: &[&str], value: f32| {
        let channel = |name: &&str| AnyChannel::new(*name, FlatSamples::F32(vec![value; 16 * 16]));
        let channels: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels.iter().map(channel).collect();
        Layer::new((16, 16), LayerAttributes::named(name), Encoding::UNCOMPRESSED, AnyChannels::sort(channels))
    };
    let write = |file: &str, layers: Vec<Layer<AnyChannels<FlatSamples>>>| {
        let attributes = ImageAttributes::new(IntegerBounds::from_dimensions((16, 16)));
        Image::from_layers(attributes, layers).write().non_parallel().to_file(place.path(file)).expect("written");
    };
    let (colors, other) = (["R", "G", "B"], ["R", "G", "B", "id"]);
    write("one.exr", vec![layer("shown", &colors, 0.5)]);
    write("two.exr", vec![layer("shown", &colors, 0.5), layer("hidden", &colors, 0.75)]);
    write("three.exr", vec![layer("depth", &["Z"], 3.0), layer("shown", &other, 0.5), layer("hidden", &colors, 0.25)]);
    let compared = |reference: &str, test: &str| place.run(&["compare", reference, test, "--max-error", "0"]).exits(0);
    compared("one.exr", "one.exr").says("");
    compared("one.exr", "two.exr").says("note: not compared of `two.exr`: 1 of 2 layers");
    compared("three.exr", "one.exr").says("note: not compared of `three.exr`: channel id, 2 of 3 layers");
}
