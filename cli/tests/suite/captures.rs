//! Every image after every pass that wrote it: as files, and on the page (IN-2).

use crate::testing::browser::Browser;
use crate::testing::{Place, Vulkan, shipped_pipelines};
use framewright_tests::sweep;
use serde_json::Value;

const SMALL: [&str; 4] = ["--scene", "spheres_and_cubes", "--size", "96x54"];

fn listed(place: &Place, folder: &str) -> Vec<Value> {
    let text = std::fs::read_to_string(place.path(folder).join("images.json")).expect("the list");
    let list: Value = serde_json::from_str(&text).expect("JSON");
    list["images"].as_array().expect("a list").clone()
}

#[test]
fn captures_leave_every_picture_as_it_is_and_the_last_one_is_the_picture() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    for name in sweep::of("captures of shipped pipelines", shipped_pipelines(), 4) {
        let place = Place::new();
        let run = |more: &[&str]| {
            place.run_with(&variables, &[&["run", &*name][..], &SMALL, &["--frames", "2"], more].concat()).exits(0)
        };
        run(&["-o", "alone.png"]);
        run(&["-o", "beside.png", "--dump-all", "all", "--validate"]);
        let read = |file: &str| std::fs::read(place.path(file)).expect("written");
        assert_eq!(read("alone.png"), read("beside.png"), "{name}");
        let images = listed(&place, "all");
        let plan = place.run(&["inspect", &name, "--scene", "spheres_and_cubes", "--format", "json"]).exits(0).out;
        let plan: Value = serde_json::from_str(&plan).expect("JSON");
        let output = plan["outputs"][0]["resource"]["image"].as_u64().expect("an image");
        let output = &plan["images"][usize::try_from(output).expect("fits")]["name"];
        // An image that a pass which is off passes on has the name of the one that was drawn.
        let last = images.iter().rev().find(|image| image["image"] == *output).or(images.last()).expect("a capture");
        let last = place.path("all").join(last["file"].as_str().expect("a file"));
        let [captured, drawn] =
            [last, place.path("alone.png")].map(|path| image::open(path).expect("a picture").into_rgb8());
        let far = captured.pixels().zip(drawn.pixels()).filter(|(a, b)| (0..3).any(|at| a[at].abs_diff(b[at]) > 1));
        assert_eq!(far.count(), 0, "{name}");
        assert_eq!(place.path("all").read_dir().expect("a folder").count(), images.len() + 1, "{name}");
    }
}

#[test]
fn multisampled_images_are_captured_resolved_and_both_eyes_side_by_side() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    place.run(&["new", "first"]).exits(0);
    let run = |more: &[&str]| place.run_with(&variables, &[&["run"][..], more, &SMALL].concat()).exits(0);
    run(&["first.ron", "--dump-all", "all", "--dump", "color=color.exr"]);
    let images = listed(&place, "all");
    let told: Vec<[&str; 2]> =
        images.iter().map(|one| ["pass", "image"].map(|name| one[name].as_str().expect("a name"))).collect();
    assert_eq!(told, [["opaque", "color"], ["opaque", "depth"], ["sky", "color"], ["tone_map", "screen"]]);
    let dumped = std::fs::read(place.path("color.exr")).expect("dumped");
    let captured =
        std::fs::read(place.path("all").join(images[2]["file"].as_str().expect("a file"))).expect("captured");
    assert!(dumped == captured, "the last version of an image is what `--dump` writes");
    for stereo in ["multi-pass", "double-wide", "instanced"] {
        run(&["forward", "--stereo", stereo, "--dump-all", stereo]);
        let widest = listed(&place, stereo).iter().map(|one| one["size"][0].as_u64().expect("a width")).max();
        assert_eq!(widest, Some(if stereo == "multi-pass" { 96 } else { 192 }), "{stereo}");
    }
}

#[test]
fn thumbnails_on_the_page_are_the_dumped_images() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    place.run_with(&variables, &[&["run", "forward"][..], &SMALL, &["--dump-all", "all"]].concat()).exits(0);
    let page = ["--format", "html", "--capture=full", "-o", "page.html"];
    place.run_with(&variables, &[&["inspect", "forward"][..], &SMALL, &page].concat()).exits(0);
    let images = listed(&place, "all");
    browser.open_file(&place.path("page.html"), "#view=pictures");
    assert_eq!(browser.count("document.querySelectorAll('figure canvas').length"), images.len());
    for (at, image) in images.iter().enumerate() {
        let names = format!("[DATA.captures[{at}].pass, DATA.captures[{at}].image].join()");
        let expected = ["pass", "image"].map(|name| image[name].as_str().expect("a name")).join(",");
        assert_eq!(browser.text(&names), expected);
        let file = image["file"].as_str().expect("a file");
        if !file.ends_with(".png") {
            continue;
        }
        // Small pictures aren't shrunk: the canvas holds the very pixels of the file.
        let picture = image::open(place.path("all").join(file)).expect("a picture").into_rgb8();
        let pixels = format!(
            "(() => {{ const canvas = document.querySelectorAll('figure canvas')[\
             [...document.querySelectorAll('figure')].findIndex((one) => one.dataset.key === 'pass:' + DATA.captures[{at}].pass + '\\u0001image:' + DATA.captures[{at}].image)]; \
             return [...canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data]; }})()"
        );
        let pixels = browser.ask(&pixels);
        let pixels: Vec<u8> =
            pixels.as_array().expect("bytes").iter().map(|byte| byte.as_u64().expect("a byte") as u8).collect();
        let far =
            picture.pixels().zip(pixels.chunks_exact(4)).filter(|(a, b)| (0..3).any(|at| a[at].abs_diff(b[at]) > 1));
        assert_eq!((pixels.len(), far.count()), (picture.len() / 3 * 4, 0), "{file}");
    }
    // The controls redraw, and the whole picture opens, with its file beside the page.
    let sum = "[...document.querySelector('figure canvas').getContext('2d').getImageData(0, 0, 96, 54).data].reduce((a, b) => a + b)";
    let before = browser.count(sum);
    browser.ask("(() => { const slider = document.querySelector('input[type=range]'); slider.value = -4; slider.dispatchEvent(new Event('input')); })()");
    let darker = browser.count(sum);
    assert!(darker < before, "{darker} < {before}");
    browser.click("figure button.zoom");
    browser.until("document.querySelector('dialog.large')?.view.picture?.small.join() === '96,54'");
    let file = browser.text("decodeURI(document.querySelector('dialog a').getAttribute('href'))");
    assert!(place.path(&file).is_file(), "{file}");
    browser.screenshot("pictures");
    browser.press("Escape");
    browser.has_no_errors();
    // Without that word there is the page alone, and it has the same texels.
    let alone = ["--format", "html", "--capture", "-o", "alone.html"];
    place.run_with(&variables, &[&["inspect", "forward"][..], &SMALL, &alone].concat()).exits(0);
    assert!(!place.path("alone.images").exists());
    let texels = "DATA.captures.map((one) => one.data).join()";
    let full = browser.text(texels);
    browser.open_file(&place.path("alone.html"), "#view=pictures");
    assert!(browser.text(texels) == full, "the texels are others");
    place
        .run(&["inspect", "forward", "--capture", "--scene", "courtyard", "-o", "x"])
        .exits(2)
        .mentions("add `--format html`");
    place.run(&["inspect", "forward", "--capture"]).exits(2);
}

pub(crate) const FACE: &str = "#version 460
layout(set = 0, binding = 0) uniform Params { vec4 v; } params;
layout(location = 0) out vec4 c;
void main() { c = params.v; }";

pub(crate) const LOOK: &str = "#version 460
layout(set = 0, binding = 0) uniform samplerCube c;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 o;
void main() { o = texture(c, vec3(uv - 0.5, 0.5)); }";

/// A pipeline by its name, with the captures that there are, and what is left out of them.
pub(crate) type CapturedImage = (&'static str, &'static str, &'static [&'static str], Option<&'static str>);

/// What is drawn and was refused by each tool that captures.
pub(crate) fn odd_pipelines() -> [CapturedImage; 4] {
    let cube = r#"Pipeline(version: 1,
        images: [(name: "c", format: R16G16B16A16_SFLOAT, size: Fixed(16, 16), shape: Cube), (name: "screen", format: Output, size: Output)],
        passes: [
            (name: "face", repeat: ("i", 6), draw: FullScreen("face"), params: {"v": ("i / 6", 0.5, 0.0, 1.0)}, color: [(image: "c", layer: "i")]),
            (name: "show", draw: FullScreen("look"), sample: {"c": "c"}, color: ["screen"]),
        ], outputs: ["screen"])"#;
    let depth_alone = r#"Pipeline(version: 1,
        images: [(name: "c", format: Color(hdr: true), size: Output), (name: "d", format: DepthStencil, size: Output), (name: "screen", format: Output, size: Output)],
        passes: [
            (name: "o", draw: Objects(Opaque), shader: "lit", color: [(image: "c", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "d", clear: 0.0)),
            (name: "show", draw: FullScreen("reinhard"), sample: {"source": "c"}, color: ["screen"]),
        ], outputs: ["screen"])"#;
    let samples = r#"Pipeline(version: 1,
        images: [(name: "c", format: Color(hdr: true), size: Output, samples: 4), (name: "d", format: DepthStencil, size: Output, samples: 4), (name: "screen", format: Output, size: Output)],
        passes: [
            (name: "o", draw: Objects(Opaque), shader: "lit", color: [(image: "c", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "d", clear: 0.0, stencil: (clear: 0, reference: 1, pass: Replace))),
            (name: "show", draw: FullScreen("reinhard"), sample: {"source": "c"}, color: ["screen"]),
        ], outputs: ["screen"])"#;
    let stencil = r#"Pipeline(version: 1,
        images: [(name: "c", format: Color(hdr: true), size: Output), (name: "d", format: DepthStencil, size: Output), (name: "screen", format: Output, size: Output)],
        passes: [
            (name: "o", draw: Objects(Opaque), shader: "lit", color: [(image: "c", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "d", clear: 0.0, stencil: (clear: 0, reference: 7, pass: Replace))),
            (name: "show", draw: FullScreen("reinhard"), sample: {"source": "c"}, color: ["screen"]),
        ], outputs: ["screen"])"#;
    [
        (
            "cube",
            cube,
            &[
                "face_0_-c",
                "face_1_-c-layer1",
                "face_2_-c-layer2",
                "face_3_-c-layer3",
                "face_4_-c-layer4",
                "face_5_-c-layer5",
                "show-screen",
            ],
            None,
        ),
        ("depth_alone", depth_alone, &["o-c", "o-d", "show-screen"], None),
        (
            "samples",
            samples,
            &["o-c", "o-d", "show-screen"],
            Some("`d`: it has several samples, and stencil can't be resolved"),
        ),
        ("stencil", stencil, &["o-c", "o-d", "o-d-stencil", "show-screen"], None),
    ]
}

#[test]
fn whatever_is_drawn_is_captured_and_what_is_left_out_is_said() {
    let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
    for (name, text, captured, left_out) in odd_pipelines() {
        let place = Place::new();
        place.file("p.ron", text);
        place.file("face.frag", FACE);
        place.file("look.frag", LOOK);
        let run = |more: &[&str]| place.run_with(&variables, &[more, &SMALL].concat()).exits(0);
        let dumped = run(&["run", "p.ron", "--dump-all", "all", "-o", "beside.png", "--validate"]);
        assert!(dumped.out.contains("validation: silent; "), "{name}: {}", dumped.out);
        let files: Vec<String> =
            listed(&place, "all").iter().map(|one| one["file"].as_str().expect("a file").to_owned()).collect();
        assert_eq!(files.len(), captured.len(), "{name}: {files:?}");
        for wanted in captured {
            let is_it = |file: &&String| file.rsplit_once('.').is_some_and(|(stem, _)| stem[4..] == **wanted);
            assert_eq!(files.iter().filter(is_it).count(), 1, "{name}: {wanted} in {files:?}");
        }
        let said =
            |err: &str| err.lines().filter(|line| line.contains("not captured")).map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(
            said(&dumped.err),
            Vec::from_iter(left_out.map(|why| format!("note: not captured: {why}"))),
            "{name}"
        );
        // A capture changes no picture.
        run(&["run", "p.ron", "-o", "alone.png"]);
        let read = |file: &str| std::fs::read(place.path(file)).expect("written");
        assert!(read("alone.png") == read("beside.png"), "{name}");
        run(&["run", "p.ron", "--bisect", "no-alias"]);
        run(&["inspect", "p.ron", "--format", "html", "--capture", "-o", "page.html"]);
    }
}

/// Stencil is a capture of its own: the bytes that the pass left.
#[test]
fn captured_stencil_is_what_the_pass_left() {
    let Some(variables) = Vulkan::LAVAPIPE.variables() else { return };
    let place = Place::new();
    place.file("p.ron", odd_pipelines()[3].1);
    place.run_with(&variables, &[&["run", "p.ron", "--dump-all", "all"][..], &SMALL].concat()).exits(0);
    let images = listed(&place, "all");
    let stencil =
        images.iter().find(|one| one["file"].as_str().is_some_and(|file| file.contains("stencil"))).expect("captured");
    let file = place.path("all").join(stencil["file"].as_str().expect("a file"));
    let image = exr::prelude::read_first_flat_layer_from_file(file).expect("an OpenEXR file");
    let exr::prelude::FlatSamples::U32(words) = &image.layer_data.channel_data.list[0].sample_data else {
        panic!("integers")
    };
    let [marked, others] = [7, 0].map(|value| words.iter().filter(|word| **word == value).count());
    assert!(marked > 100 && others > 100 && marked + others == words.len(), "{marked} and {others} of {}", words.len());
}
