//! Arrays of images that a shader declares, and lists of images that a pass gives to them (EM-5).

use crate::testing::pipelines::{INPUTS, right, wrong};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::vulkan::Filter;

/// A pipeline with images `a` to `e` and others, and a pass `show` with these fields. The shader `taps` samples an array of three.
fn pipeline(fields: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            settings: [(name: "scale", value: Number(default: 1.0, min: 0.1, max: 1.0))],
            images: [
                (name: "a", format: R8_UNORM, size: Output, per_eye: true),
                (name: "b", format: R8_UNORM, size: Fixed(8, 4)),
                (name: "c", format: R16G16B16A16_SFLOAT, size: Output, mips: 2),
                (name: "d", format: R8_UNORM, size: Output), (name: "e", format: R8_UNORM, size: Output),
                (name: "whole", format: R32_UINT, size: Output),
                (name: "deep", format: R8_UNORM, size: Fixed(4, 4), shape: D3(4)),
                (name: "partly", format: R8_UNORM, size: Dynamic(by: "scale", up_to: 1.0)),
                (name: "word", format: R32_UINT, size: Output), (name: "other_word", format: R32_UINT, size: Output),
                (name: "screen", format: Output, size: Output, per_eye: true),
            ],
            passes: [
                (name: "a", fill: (to: "a", value: 0)), (name: "b", fill: (to: "b", value: 0)),
                (name: "c", fill: (to: "c", value: 0)), (name: "d", fill: (to: "d", value: 0)),
                (name: "e", fill: (to: "e", value: 0)), (name: "whole", fill: (to: "whole", value: 0)),
                (name: "deep", fill: (to: "deep", value: 0)), (name: "partly", fill: (to: "partly", value: 0)),
                (name: "show", color: ["screen"],
{fields}),
            ],
            outputs: ["screen"],
        )"#
    )
}

fn sampling(sample: &str) -> String {
    pipeline(&format!("draw: FullScreen(\"taps\"), sample: {sample}"))
}

/// What `show` samples: shader's names, and images.
fn sampled(frame: &Frame) -> Vec<(&str, &str)> {
    let pass = frame.passes.iter().find(|pass| pass.name.starts_with("show")).expect("it is there");
    let image = |at: usize| &*frame.images[at].name;
    pass.sampled.iter().map(|it| (&*it.binding, image(it.image.0 as usize))).collect()
}

#[test]
fn each_element_of_an_array_is_given_the_image_at_its_place_in_a_list() {
    let frame = right(&sampling(r#"{"taps": ["c", (image: "a", filter: Nearest), Resolved("a")]}"#), &INPUTS);
    assert_eq!(sampled(&frame), [("taps[0]", "c"), ("taps[1]", "a"), ("taps[2]", "a")]);
    let filters: Vec<_> = frame.passes.last().expect("show").sampled.iter().map(|it| it.sampler.filter).collect();
    assert_eq!(filters, [Filter::Linear, Filter::Nearest, Filter::Linear]);
}

#[test]
fn storage_images_are_given_to_an_array_likewise() {
    let pass = r#"(name: "store", dispatch: "store_two", groups: Count(1), storage: {"targets": ["word", "other_word"]}),
        (name: "show", color: ["screen"],"#;
    let text = pipeline("draw: FullScreen(\"plain\")").replace(r#"(name: "show", color: ["screen"],"#, pass);
    let text = text.replace("outputs: [", "outputs: [\"word\", \"other_word\", ");
    let frame = right(&text, &INPUTS);
    let pass = frame.passes.iter().find(|pass| *pass.name == *"store").expect("it is there");
    let stored: Vec<_> = pass.storage.iter().map(|it| (&*it.binding, it.image.0, it.write)).collect();
    assert_eq!(stored, [("targets[0]", 8, true), ("targets[1]", 9, true)]);
    let short = wrong(&text.replace(r#"["word", "other_word"]}"#, r#"["word"]}"#), &INPUTS);
    assert!(short.contains("shader `store_two` uses the storage image `targets[1]`, which pass `store`"), "{short}");
}

/// The mistake in what `show` samples, at the text `place`.
#[track_caller]
fn mistaken(sample: &str, place: &str, said: &[&str]) {
    let text = sampling(sample);
    let rendered = wrong(&text, &INPUTS);
    let before = &text[..text.rfind(place).expect("it is in the text")];
    let (line, column) = (before.lines().count(), before.lines().last().map_or(0, str::len) + 1);
    for words in [&format!(" test.ron:{line}:{column}\n")[..]].iter().chain(said) {
        assert!(rendered.contains(words), "`{words}` is not in\n{rendered}");
    }
    assert_eq!(rendered.matches("error: ").count(), 1, "{rendered}");
}

#[test]
fn what_does_not_fit_an_array_is_told_at_its_place() {
    let array = "shader `taps` declares `taps` as an array of 3, ";
    let one = [&format!("{array}and is given no list"), "write a list: `\"taps\": [\"…\", \"…\", \"…\"]`"];
    mistaken(r#"{"taps": "a"}"#, "\"taps\": \"a\"", &[one[0], one[1]]);
    let more = format!("{array}and is given more");
    mistaken(r#"{"taps": ["a", "b", "c", "d", "e"]}"#, "\"d\"", &[&more, "leave this one out"]);
    mistaken(r#"{"taps": ["a", "b", "c", (image: "d", when: "2 < 1")]}"#, "(image: \"d\"", &[&more]);
    let gap = "shader `taps` samples `taps[2]`, which pass `show` doesn't give";
    mistaken(r#"{"taps": ["a", "b"]}"#, "\"b\"", &[gap, "`taps` is an array of 3: `\"taps\": [\"…\", \"…\", \"…\"]`"]);
    let gap = "shader `taps` samples `taps[1]`, which pass `show` doesn't give";
    mistaken(r#"{"taps": ["d", (image: "a", when: "2 < 1"), "c"]}"#, "\"d\"", &[gap]);
    mistaken(r#"{"taps": ["a", "b", "nobody"]}"#, "\"nobody\"", &["there is no image named `nobody`"]);
    mistaken(r#"{"taps": []}"#, "[]", &["an array has one element at least"]);
    let named = ["`taps[0]` can't be a sampled image: elements of an array have no names", "write a list under the"];
    mistaken(r#"{"taps[0]": "a", "taps": ["a", "b", "c"]}"#, "\"taps[0]\"", &named);
    let integers = "shader `taps` reads floating point from `taps[1]`, but `whole` holds unsigned integers";
    mistaken(r#"{"taps": ["a", "whole", "c"]}"#, "\"whole\"", &[integers]);
    let deep = "shader `taps` declares `taps[0]` as two-dimensional, but `deep` is three-dimensional";
    mistaken(r#"{"taps": ["deep", "a", "c"]}"#, "\"deep\"", &[deep]);
    let own = "`taps[0]` is an element of an array, and no device reads those from its own position";
    mistaken(r#"{"taps": [(image: "a", own_pixel: true), "a", "c"]}"#, "true", &[own]);
    let partly = "only a part of `partly` is in use, and shader `taps` can't be told which of the elements of `taps`";
    mistaken(r#"{"taps": ["a", "partly", "c"]}"#, "\"partly\"", &[partly]);
}

#[test]
fn an_array_that_nobody_gives_and_a_list_for_what_is_no_array_are_mistakes() {
    let none = wrong(&pipeline("draw: FullScreen(\"taps\")"), &INPUTS);
    for words in
        ["shader `taps` samples `taps[0]`, which pass `show`", "add `sample: {\"taps\": [\"…\", \"…\", \"…\"]}`"]
    {
        assert!(none.contains(words), "`{words}` is not in\n{none}");
    }
    let list = wrong(&pipeline("draw: FullScreen(\"reinhard\"), sample: {\"source\": [\"a\", \"d\"]}"), &INPUTS);
    for words in ["declares `source` as no array, and is given a list", "write `\"source\": \"…\"`"] {
        assert!(list.contains(words), "`{words}` is not in\n{list}");
    }
    assert_eq!([none, list].map(|text| text.matches("error: ").count()), [1, 1]);
}

#[test]
fn an_eyes_own_image_in_an_array_is_there_for_each_eye() {
    for stereo in [Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview, Stereo::MultiPass] {
        let frame = right(&sampling(r#"{"taps": ["a", "b", "c"]}"#), &Inputs { stereo, ..INPUTS });
        assert!(frame.images.iter().all(|image| image.eyes.is_none()), "{stereo:?}");
        let shown: Vec<_> = frame.passes.iter().filter(|pass| pass.name.starts_with("show")).collect();
        assert_eq!(shown.len(), 2, "{stereo:?}");
        let firsts: Vec<_> = shown.iter().map(|pass| pass.sampled[0].image).collect();
        assert_ne!(firsts[0], firsts[1], "{stereo:?}");
    }
}
