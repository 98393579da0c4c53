//! Every image after every pass that wrote it: as files, and on the page (IN-2).

use crate::testing::browser::Browser;
use crate::testing::{Place, Vulkan, shipped_pipelines};
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
    for name in shipped_pipelines() {
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
    let page = ["--format", "html", "--capture", "-o", "page.html"];
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
    // The controls redraw, and the whole picture opens.
    let sum = "[...document.querySelector('figure canvas').getContext('2d').getImageData(0, 0, 96, 54).data].reduce((a, b) => a + b)";
    let before = browser.count(sum);
    browser.ask("(() => { const slider = document.querySelector('input[type=range]'); slider.value = -4; slider.dispatchEvent(new Event('input')); })()");
    let darker = browser.count(sum);
    assert!(darker < before, "{darker} < {before}");
    browser.click("figure button.zoom");
    browser.until("document.querySelector('dialog img')?.naturalWidth === 96");
    browser.screenshot("pictures");
    browser.press("Escape");
    browser.has_no_errors();
    place
        .run(&["inspect", "forward", "--capture", "--scene", "courtyard", "-o", "x"])
        .exits(2)
        .mentions("add `--format html`");
    place.run(&["inspect", "forward", "--capture"]).exits(2);
}
