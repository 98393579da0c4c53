//! Fragments: images, buffers and passes that are put in under a name of their own, with arguments.

use crate::testing::pipelines::{INPUTS, right, unnamed, wrong};
use crate::testing::table::Table;
use framewright_graph::base::{self, FilePath, Sources};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::frame::{Frame, ImageIndex, ParamValue, Work};
use framewright_graph::language::{self, Files, FoundFile, ReadFailure};
use framewright_graph::vulkan::Format;
use std::sync::Arc;

/// A pipeline that blooms by a fragment.
const BLOOM: &str = r#"Pipeline(
    version: 1,
    settings: [
        (name: "bloom", value: Bool(default: true)),
        (name: "depth", value: Integer(default: 2, min: 1, max: 6)),
    ],
    fragments: [
        (name: "bloom", about: "light runs over", parameters: [
            (name: "source", value: Image, about: "what shines"),
            (name: "target", value: Image),
            (name: "levels", value: Integer(default: 5, min: 1, max: 8)),
            (name: "strength", value: Number(default: 0.5, min: 0.0, max: 1.0)),
            (name: "texels", value: Format(default: R16G16B16A16_SFLOAT)),
        ],
        images: [
            (name: "down", repeat: ("i", "levels"), format: "texels", size: Scaled("exp2(-(i + 1))", "source")),
        ],
        passes: [
            (name: "shrink", repeat: ("i", "levels"), draw: FullScreen("downsample"),
                sample: {"source": "if(i == 0, source, down[i - 1])"}, color: ["down[i]"]),
            (name: "mix", draw: FullScreen("soft_focus"), sample: {"sharp": "source", "soft": "down[levels - 1]"},
                params: {"strength": "strength"}, color: ["target"]),
        ]),
    ],
    images: [
        (name: "color", format: Color(hdr: true), size: Output),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "sky", draw: FullScreen("plain"), color: ["color"]),
        (anchor: "before_post"),
        (use: "bloom", name: "glow", when: "bloom", with: {"source": "color", "target": "screen", "levels": "depth"},
            otherwise: Forward(from: "color", to: "screen")),
    ],
    outputs: ["screen"],
)"#;

fn passes(frame: &Frame) -> Vec<&str> {
    frame.passes.iter().map(|it| &*it.name).collect()
}

fn images(frame: &Frame) -> Vec<&str> {
    frame.images.iter().map(|it| &*it.name).collect()
}

#[test]
fn what_a_fragment_makes_has_the_name_of_its_use_before_its_own() {
    let frame = right(BLOOM, &INPUTS);
    assert_eq!(images(&frame), ["color", "screen", "glow.down[0]", "glow.down[1]"]);
    assert_eq!(passes(&frame), ["sky", "glow.shrink[0]", "glow.shrink[1]", "glow.mix"]);
    assert_eq!(frame.images[3].extent, [160, 90, 1]);
    assert_eq!(frame.images[3].format, Format::R16G16B16A16_SFLOAT);
    assert_eq!(frame.passes[3].params, [("strength".into(), ParamValue::Number(0.5))]);
}

#[test]
fn a_bloom_by_a_fragment_is_the_same_as_one_written_out() {
    let written = r#"Pipeline(
        version: 1,
        images: [
            (name: "color", format: Color(hdr: true), size: Output),
            (name: "screen", format: Output, size: Output),
            (name: "half", format: Color(hdr: true), size: Scaled(0.5, "color")),
            (name: "quarter", format: Color(hdr: true), size: Scaled(0.25, "color")),
        ],
        passes: [
            (name: "sky", draw: FullScreen("plain"), color: ["color"]),
            (name: "to_half", draw: FullScreen("downsample"), sample: {"source": "color"}, color: ["half"]),
            (name: "to_quarter", draw: FullScreen("downsample"), sample: {"source": "half"}, color: ["quarter"]),
            (name: "mix", draw: FullScreen("soft_focus"), sample: {"sharp": "color", "soft": "quarter"},
                params: {"strength": 0.5}, color: ["screen"]),
        ],
        outputs: ["screen"],
    )"#;
    assert_eq!(unnamed(&right(BLOOM, &INPUTS)), unnamed(&right(written, &INPUTS)));
}

#[test]
fn a_use_that_is_off_leaves_nothing_but_what_stands_in_for_it() {
    let set = [("bloom".to_owned(), "false".to_owned())];
    let frame = right(BLOOM, &Inputs { set: &set, ..INPUTS });
    assert_eq!((images(&frame), passes(&frame)), (vec!["color", "screen"], vec!["sky", "glow"]));
    assert!(
        matches!(&frame.passes[1].work, Work::Forward { from: ImageIndex(0), to: ImageIndex(1), because } if because == "bloom = false")
    );
    assert_eq!((&*frame.switched_off[0].name, &*frame.switched_off[0].because), ("glow", "bloom = false"));

    let without = BLOOM.replace(",\n            otherwise: Forward(from: \"color\", to: \"screen\")", "");
    let said = wrong(&without, &Inputs { set: &set, ..INPUTS });
    assert!(
        said.contains("the frame needs `screen`, but pass `glow`, which fills it, is off (bloom = false)"),
        "{said}"
    );
}

#[test]
fn several_targets_of_what_is_off_are_filled_each_in_its_way() {
    let text = BLOOM.replace(
        "Forward(from: \"color\", to: \"screen\")",
        "[Clear(image: \"screen\", value: (0, 0, 0, \"depth / 8.0\"))]",
    );
    let set = [("bloom".to_owned(), "false".to_owned())];
    let frame = right(&text, &Inputs { set: &set, ..INPUTS });
    assert!(matches!(frame.passes[1].work, Work::Fill { .. }));
}

#[test]
fn fragments_use_fragments_and_are_repeated() {
    let text = BLOOM.replace(
        "    fragments: [",
        r#"    fragments: [
        (name: "both", parameters: [(name: "source", value: Image), (name: "target", value: Image)],
            images: [(name: "between", format: Like("source"), size: Like("source"))],
            passes: [
                (use: "bloom", name: "first", with: {"source": "source", "target": "between", "levels": 1}),
                (use: "bloom", name: "again", repeat: ("n", 2),
                    with: {"source": "between", "target": "target", "levels": "n + 1", "strength": "n / 2"}),
            ]),"#,
    );
    let text = text.replace(
        "(use: \"bloom\", name: \"glow\", when: \"bloom\", with: {\"source\": \"color\", \"target\": \"screen\", \"levels\": \"depth\"},\n            otherwise: Forward(from: \"color\", to: \"screen\"))",
        "(use: \"both\", name: \"glow\", with: {\"source\": \"color\", \"target\": \"screen\"})",
    );
    let frame = right(&text, &INPUTS);
    assert_eq!(
        images(&frame),
        [
            "color",
            "screen",
            "glow.between",
            "glow.first.down[0]",
            "glow.again[0].down[0]",
            "glow.again[1].down[0]",
            "glow.again[1].down[1]"
        ]
    );
    assert_eq!(passes(&frame)[1..4], ["glow.first.shrink[0]", "glow.first.mix", "glow.again[0].shrink[0]"]);
    let strength =
        frame.passes.iter().rfind(|it| &*it.name == "glow.again[1].mix").expect("it is there").params[0].clone();
    assert_eq!(strength.1, ParamValue::Number(0.5));
}

#[test]
fn a_fragment_sees_nothing_of_the_pipeline_that_uses_it() {
    let text = BLOOM.replace("\"source\": \"if(i == 0, source, down[i - 1])\"", "\"source\": \"color\"");
    let said = wrong(&text, &INPUTS);
    assert!(said.contains("there is no image named `color`"), "{said}");
    assert!(said.contains("used here as `glow`"), "{said}");
    assert_eq!(said.matches("error: ").count(), 1, "{said}");
}

/// Passes by the hundred thousand come of a few lines.
#[test]
fn a_hundred_thousand_passes_are_put_in() {
    let text = BLOOM.replace(
        "(use: \"bloom\", name: \"glow\", when: \"bloom\", with: {\"source\": \"color\", \"target\": \"screen\", \"levels\": \"depth\"},\n            otherwise: Forward(from: \"color\", to: \"screen\"))",
        "(use: \"bloom\", name: \"glow\", repeat: (\"n\", 33333), with: {\"source\": \"color\", \"target\": \"screen\", \"levels\": \"depth\"})",
    );
    let frame = right(&text, &INPUTS);
    assert_eq!((frame.passes.len(), frame.images.len()), (1 + 3 * 33_333, 2 + 2 * 33_333));
}

#[test]
fn fragments_that_multiply_end_at_the_limit() {
    let level = |at: u32| {
        format!(
            "(name: \"f{at}\", passes: [(use: \"f{next}\", name: \"a\"), (use: \"f{next}\", name: \"b\")]),",
            next = at + 1
        )
    };
    let levels: String = (0..30).map(level).collect();
    let text = BLOOM
        .replace("    fragments: [", &format!("    fragments: [{levels} (name: \"f30\", passes: []),"))
        .replace("(anchor: \"before_post\")", "(use: \"f0\", name: \"bomb\")");
    let said = wrong(&text, &INPUTS);
    assert!(said.contains("this makes more than 1000000 images, buffers, passes and uses of fragments"), "{said}");
    assert_eq!(said.matches("error: ").count(), 1, "{said}");
}

/// Files by path; each is read once.
struct Shelf {
    files: Vec<(&'static str, String)>,
    read: Vec<String>,
}

impl Files for Shelf {
    fn read(&mut self, from: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        self.read.push(format!("{from} -> {path}"));
        let (_, text) = self.files.iter().find(|(name, _)| *name == path).ok_or_else(|| format!("no `{path}`"))?;
        Ok(FoundFile { shown: path.to_owned(), relative: path.into(), bytes: text.clone().into_bytes() })
    }
}

#[test]
fn a_fragment_from_a_file_is_the_same_as_one_that_stands_in_the_pipeline() {
    let start = BLOOM.find("    fragments: [").expect("it has fragments");
    let end = BLOOM.find("    images: [\n        (name: \"color\"").expect("it has images");
    let text = format!("{}include: [\"bloom.ron\", \"more.ron\"],{}", &BLOOM[..start], &BLOOM[end..]);
    let library =
        format!("Fragments(version: 1, include: [\"more.ron\"], {})", &BLOOM[start..end].trim().trim_end_matches(','));
    let more = "Fragments(version: 1, fragments: [])".to_owned();
    let mut shelf = Shelf { files: vec![("bloom.ron", library), ("more.ron", more)], read: Vec::new() };
    let mut sources = Sources::default();
    let document = language::read_with(&mut sources, &mut shelf, "test.ron", "test.ron", text)
        .unwrap_or_else(|errors| panic!("{}", base::render(&sources, &errors)));
    let frame = expand(&document, Arc::new(sources), &INPUTS, &mut Table).expect("it is right");
    assert_eq!(unnamed(&frame), unnamed(&right(BLOOM, &INPUTS)));
    assert_eq!(shelf.read, ["test.ron -> bloom.ron", "bloom.ron -> more.ron", "test.ron -> more.ron"]);
    assert_eq!(&*frame.sources.place(frame.images[2].span).expect("a place").file, "bloom.ron");
}
