//! Images, buffers and passes that are repeated, and references to them.

use crate::testing::pipelines::{INPUTS, right, wrong};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Frame, ImageIndex, ParamValue, Resource};

fn names(frame: &Frame) -> (Vec<&str>, Vec<&str>) {
    (frame.images.iter().map(|it| &*it.name).collect(), frame.passes.iter().map(|it| &*it.name).collect())
}

/// A chain of images, each half as large as the one before it.
const CHAIN: &str = r#"Pipeline(
    version: 1,
    settings: [(name: "levels", value: Integer(default: 3, min: 0, max: 8))],
    images: [
        (name: "color", format: Color(hdr: true), size: Output),
        (name: "down", repeat: ("i", "levels"), format: Like("color"), size: Scaled("exp2(-(i + 1))", "color")),
        (name: "screen", format: Output, size: Output),
    ],
    passes: [
        (name: "sky", draw: FullScreen("plain"), color: ["color"]),
        (name: "shrink", repeat: ("i", "levels"), draw: FullScreen("downsample"),
            sample: {"source": "if(i == 0, color, down[i - 1])"}, color: ["down[i]"]),
        (name: "show", draw: FullScreen("downsample"), sample: {"source": "if(levels == 0, color, down[levels - 1])"},
            color: ["screen"]),
    ],
    outputs: ["screen"],
)"#;

#[test]
fn a_list_is_named_by_its_index_and_each_element_has_what_its_index_says() {
    let frame = right(CHAIN, &INPUTS);
    let (images, passes) = names(&frame);
    assert_eq!(images, ["color", "down[0]", "down[1]", "down[2]", "screen"]);
    assert_eq!(passes, ["sky", "shrink[0]", "shrink[1]", "shrink[2]", "show"]);
    let sizes: Vec<[u32; 2]> = frame.images[1..4].iter().map(|it| [it.extent[0], it.extent[1]]).collect();
    assert_eq!(sizes, [[320, 180], [160, 90], [80, 45]]);
    let read: Vec<ImageIndex> = frame.passes[1..].iter().map(|it| it.sampled[0].image).collect();
    assert_eq!(read, [0, 1, 2, 3].map(ImageIndex));
    let drawn: Vec<ImageIndex> = frame.passes[1..4].iter().map(|it| it.color[0].image).collect();
    assert_eq!(drawn, [1, 2, 3].map(ImageIndex));
}

#[test]
fn none_at_all_is_a_number_of_repetitions_too() {
    let set = [("levels".to_owned(), "0".to_owned())];
    let frame = right(CHAIN, &Inputs { set: &set, ..INPUTS });
    assert_eq!(names(&frame), (vec!["color", "screen"], vec!["sky", "show"]));
    assert_eq!(frame.passes[1].sampled[0].image, ImageIndex(0));
}

#[test]
fn what_is_repeated_is_the_same_as_what_is_written_out() {
    let written = r#"Pipeline(
        version: 1,
        images: [
            (name: "color", format: Color(hdr: true), size: Output),
            (name: "a", format: Like("color"), size: Scaled(0.5, "color")),
            (name: "b", format: Like("color"), size: Scaled(0.25, "color")),
            (name: "c", format: Like("color"), size: Scaled(0.125, "color")),
            (name: "screen", format: Output, size: Output),
        ],
        passes: [
            (name: "sky", draw: FullScreen("plain"), color: ["color"]),
            (name: "to_a", draw: FullScreen("downsample"), sample: {"source": "color"}, color: ["a"]),
            (name: "to_b", draw: FullScreen("downsample"), sample: {"source": "a"}, color: ["b"]),
            (name: "to_c", draw: FullScreen("downsample"), sample: {"source": "b"}, color: ["c"]),
            (name: "show", draw: FullScreen("downsample"), sample: {"source": "c"}, color: ["screen"]),
        ],
        outputs: ["screen"],
    )"#;
    assert_eq!(
        crate::testing::pipelines::unnamed(&right(CHAIN, &INPUTS)),
        crate::testing::pipelines::unnamed(&right(written, &INPUTS))
    );
}

#[test]
fn a_chain_is_as_deep_as_the_image_above_it_allows() {
    let text = CHAIN.replace("repeat: (\"i\", \"levels\")", "repeat: (\"i\", \"floor(log2(height(color)))\")");
    let text = text.replace("if(levels == 0, color, down[levels - 1])", "down[0]");
    let frame = right(&text, &INPUTS);
    // 360 texels are halved eight times before they are one.
    assert_eq!(frame.images.len(), 2 + 8);
    assert_eq!(frame.images[8].extent, [2, 1, 1]);
}

#[test]
fn expressions_stand_wherever_values_do() {
    let text = r#"Pipeline(
        version: 1,
        settings: [
            (name: "hdr", value: Bool(default: true)), (name: "n", value: Integer(default: 2, min: 1, max: 4)),
            (name: "quality", value: OneOf(default: "high", of: ["low", "high"])),
        ],
        images: [
            (name: "a", format: "if(hdr && view.allows_hdr, R16G16B16A16_SFLOAT, R8G8B8A8_UNORM)",
                size: Fixed("64 * n", "view.height - 60"), mips: "n + 1", layers: "if(quality == 'high', 3, 1)"),
            (name: "d", format: DepthStencil, size: Scaled("1 / n"), samples: "max(1, 2 * n)"),
            (name: "s", format: "R8G8B8A8_UNORM", size: Like("if(hdr, a, d)"), samples: "if(hdr, 1, 2)"),
            (name: "screen", format: Output, size: Output),
        ],
        buffers: [(name: "b", bytes: "16 * n * n", lifetime: Persistent), (name: "c", bytes: Times("4 * n", "n - 1"))],
        passes: [
            (name: "fill", draw: FullScreen("scalars"), params: {"a": "width(a) / 2", "b": "n % 2 == 0", "c": "layers(a)"},
                color: [(image: "screen", clear: ("n / 4", "0", 0, "if(hdr, 1, 0)"))], side_effect: "!hdr"),
            (name: "part", draw: FullScreen("plain"), color: [(image: "a", mip: "n - 1", layer: "layers(a) - 1")]),
            (name: "depth", draw: Vertices("3 * n", "n"), shader: "pulled", storage: {"particles": "b"},
                depth: (image: "d", clear: "1 / n", write: "hdr", stencil: (clear: "n", reference: "n + 1"))),
        ],
        outputs: ["screen"],
    )"#;
    let frame = right(text, &INPUTS);
    let a = &frame.images[0];
    assert_eq!((a.format.name(), a.extent, a.mips, a.layers), ("R16G16B16A16_SFLOAT", [128, 300, 1], 3, 3));
    assert_eq!((frame.images[1].extent, frame.images[1].samples), ([320, 180, 1], 4));
    assert_eq!((frame.images[2].extent, frame.images[2].samples), ([128, 300, 1], 1));
    assert_eq!([frame.buffers[0].bytes, frame.buffers[1].bytes], [64, 8]);
    assert_eq!(
        frame.passes[0].params,
        [
            ("a".into(), ParamValue::Number(64.0)),
            ("b".into(), ParamValue::Bool(true)),
            ("c".into(), ParamValue::Integer(3))
        ]
    );
    assert_eq!(frame.passes[0].color[0].clear, Some([0.5, 0.0, 0.0, 1.0]));
    assert_eq!((frame.passes[1].color[0].range.base_mip, frame.passes[1].color[0].range.base_layer), (1, 2));
    let depth = frame.passes[2].depth.as_ref().expect("it has depth");
    assert_eq!(
        (depth.clear, depth.write, depth.stencil.map(|it| (it.clear, it.reference))),
        (Some(0.5), true, Some((Some(2), 3)))
    );
}

#[test]
fn a_pass_that_is_off_needs_no_values() {
    let text = CHAIN.replace("draw: FullScreen(\"downsample\"), sample: {\"source\": \"if(levels == 0, color, down[levels - 1])\"}",
        "when: \"levels > 0\", otherwise: Clear(image: \"screen\", value: (0, 0, 0, 1)), draw: FullScreen(\"downsample\"), sample: {\"source\": \"down[levels - 1]\"}");
    let set = [("levels".to_owned(), "0".to_owned())];
    let frame = right(&text, &Inputs { set: &set, ..INPUTS });
    assert_eq!(names(&frame).1, ["sky", "show"]);
    assert_eq!(frame.switched_off[0].because, "levels = 0");
    assert_eq!(frame.passes[1].transfers[0].resource, Resource::Image(ImageIndex(1)));
    assert!(right(&text, &INPUTS).switched_off.is_empty());
}

#[test]
fn a_use_that_is_off_needs_no_number_of_repetitions() {
    let text = r#"Pipeline(version: 1,
        settings: [(name: "levels", value: Integer(default: 0, min: 0, max: 8))],
        fragments: [(name: "chain", parameters: [(name: "target", value: Image), (name: "count", value: Integer)],
            images: [(name: "down", repeat: ("i", "count - 1"), format: Color, size: Output)],
            passes: [(name: "clear", fill: (to: "target", value: 0))])],
        images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "sky", draw: Sky, color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]),
            (use: "chain", name: "chain", when: "levels > 0", with: {"target": "screen", "count": "levels"})],
        outputs: ["screen"])"#;
    assert_eq!(right(text, &INPUTS).switched_off[0].because, "levels = 0");
    let set = [("levels".to_owned(), "2".to_owned())];
    assert_eq!(names(&right(text, &Inputs { set: &set, ..INPUTS })).1, ["sky", "chain.clear"]);
}

#[test]
fn steps_and_texts_are_kept_by_settings() {
    let text = CHAIN.replace("Integer(default: 3, min: 0, max: 8)", "Integer(default: 3, min: 1, max: 8, step: 2)");
    let chosen = |value: &str| [("levels".to_owned(), value.to_owned())];
    assert_eq!(right(&text, &Inputs { set: &chosen("5"), ..INPUTS }).settings[0].1, "5");
    let said = wrong(&text, &Inputs { set: &chosen("4"), ..INPUTS });
    assert!(said.contains("it is a whole number from 1 to 8 in steps of 2"), "{said}");
    let text = CHAIN
        .replace(
            "(name: \"levels\", value: Integer(default: 3, min: 0, max: 8))",
            "(name: \"quality\", value: OneOf(default: \"low\", of: [\"low\", \"high\"]))",
        )
        .replace("levels", "if(quality == 'high', 4, 1)");
    let chosen = [("quality".to_owned(), "high".to_owned())];
    let frame = right(&text, &Inputs { set: &chosen, ..INPUTS });
    assert_eq!((frame.images.len(), frame.settings[0].1.as_str()), (6, "high"));
}
