//! The pictures in `docs/pictures` are what the shipped pipelines draw, by the settings that their names speak of.

use crate::testing::{Place, Vulkan, repository};
use framewright_tests::sweep;
use image::RgbImage;
use std::collections::BTreeSet;
use std::path::Path;

/// How a changed picture is accepted.
const ACCEPT: &str =
    "FRAMEWRIGHT_UPDATE=1 cargo test --package framewright-cli --test suite shipped_pictures; git diff docs/pictures";

/// How all of them are drawn. After these frames what persists has settled, and snow is falling.
const HOW: [&str; 4] = ["--size", "320x180", "--frames", "4"];

/// Where to; each in turn.
const DRAWN: &str = "drawn.png";

/// The scene that a pipeline draws: only in the first the sun casts shadows, and only in the second something moves.
fn scene(pipeline: &str) -> &'static str {
    match pipeline {
        "deferred" | "shadows" => "courtyard",
        "temporal" => "passing",
        _ => "spheres_and_cubes",
    }
}

/// The settings that a picture's name speaks of: `blur=5` of `image_quality@blur=5`.
fn set(name: &str) -> (&str, Vec<&str>) {
    match name.split_once('@') {
        Some((pipeline, choices)) => (pipeline, choices.split(',').flat_map(|choice| ["--set", choice]).collect()),
        None => (name, Vec::new()),
    }
}

/// Names of the files of a folder that end so, without that.
fn names(folder: &str, ending: &str) -> BTreeSet<String> {
    let files = std::fs::read_dir(repository(folder)).expect("the folder is there");
    let names = files.map(|file| file.expect("listed").file_name().to_string_lossy().into_owned());
    names.filter_map(|name| name.strip_suffix(ending).map(str::to_owned)).collect()
}

fn picture(path: &Path) -> RgbImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).into_rgb8()
}

/// Pixels of which a channel is further apart than `steps` 8-bit steps.
fn apart(ours: &RgbImage, theirs: &RgbImage, steps: u8) -> usize {
    let far =
        |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).any(|channel| a[channel].abs_diff(b[channel]) > steps);
    ours.pixels().zip(theirs.pixels()).filter(|pair| far(*pair)).count()
}

#[test]
fn each_shipped_pipeline_draws_the_picture_that_is_shown_of_it() {
    hold(Vulkan::LAVAPIPE, [100, 1000], std::env::var_os("FRAMEWRIGHT_UPDATE").is_some());
}

#[test]
fn the_other_driver_draws_the_same_pictures() {
    hold(Vulkan::SWIFTSHADER, [20, 200], false);
}

/// Draws shipped pipelines, on lavapipe all of them, and takes each picture for the one that is shown or compares the two: one pixel in
/// `one_in[0]` may be further away than 2/255, and one in `one_in[1]` further than 24/255. Another driver, or a processor with other
/// vector instructions, rounds otherwise: an edge may fall on the other side of a pixel's middle.
fn hold(vulkan: Vulkan, one_in: [usize; 2], update: bool) {
    let Some(variables) = vulkan.variables() else { return };
    let place = Place::new();
    let all = &names("examples/pipelines", ".ron") | &names("docs/pictures", ".png");
    // Those of lavapipe are the ones that are shown: all of them are drawn.
    let few = if vulkan.is_lavapipe() { all.len() } else { 4 };
    for name in sweep::of("shipped pictures", all.into_iter().collect(), few) {
        let (pipeline, set) = set(&name);
        let run = ["run", pipeline, "--scene", scene(pipeline), "-o", DRAWN];
        place.run_with(&variables, &[&run[..], &HOW, &set].concat()).exits(0);
        let shown = repository("docs/pictures").join(format!("{name}.png"));
        if update {
            std::fs::copy(place.path(DRAWN), &shown).expect("copied");
            continue;
        }
        let (drawn, shown) = (picture(&place.path(DRAWN)), picture(&shown));
        assert_eq!(drawn.dimensions(), shown.dimensions(), "{name}; accept: {ACCEPT}");
        let [slightly, clearly] = [2, 24].map(|steps| apart(&drawn, &shown, steps));
        let all = drawn.pixels().len();
        assert!(
            slightly * one_in[0] <= all && clearly * one_in[1] <= all,
            "{name}: of {all} pixels {slightly} are further apart than 2/255, {clearly} further than 24/255; \
             accept: {ACCEPT}"
        );
    }
}

#[test]
fn no_picture_is_left_over_from_a_pipeline_that_is_gone() {
    let pipelines: BTreeSet<String> =
        names("docs/pictures", ".png").iter().map(|name| set(name).0.to_owned()).collect();
    assert_eq!(pipelines, names("examples/pipelines", ".ron"));
}
