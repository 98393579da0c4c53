//! The formats that `Color` and `Depth` become: the file's choices come to the frame.

use crate::testing::pipelines::{INPUTS, right, set};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{ChosenFormat, Frame};
use framewright_graph::language::Facts;
use framewright_graph::plan::Stage;
use framewright_graph::vulkan::Format::{self, *};

/// Colour drawn with depth, both blurred or copied into others; `policies` are the pipeline's.
fn pipeline(policies: &str, hdr: &str, more: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            {policies}
            settings: [
                (name: "quality", value: OneOf(default: "Smallest", of: ["Smallest", "Balanced", "Exact"])),
                (name: "close", value: Bool(default: true)),
            ],
            images: [
                (name: "color", format: Color(hdr: {hdr}, alpha: false), size: Output),
                (name: "follows", format: Like("color"), size: Output),
                (name: "depth", format: Depth, size: Output),
                (name: "marked", format: DepthStencil, size: Output),
                (name: "named", format: R16G16B16A16_SFLOAT, size: Output),
                (name: "screen", format: Output, size: Output),
                {more}
            ],
            passes: [
                (name: "draw", draw: Objects(Opaque), shader: "lit",
                    color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
                (name: "again", draw: Objects(Opaque), shader: "lit",
                    color: [(image: "named", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "marked", clear: 0.0)),
                (name: "blur", draw: FullScreen("blur_tent"), sample: {{"source": "color"}}, color: ["follows"]),
                (name: "show", draw: FullScreen("blur_tent"), sample: {{"source": "follows"}}, color: ["screen"]),
            ],
            outputs: ["screen"],
        )"#
    )
}

fn frame(policies: &str, hdr: &str, chosen: &[(&str, &str)]) -> Frame {
    let set = set(chosen);
    right(&pipeline(policies, hdr, ""), &Inputs { set: &set, ..INPUTS })
}

/// The formats of `color`, `follows`, `depth` and `marked`.
fn formats(policies: &str, hdr: &str) -> [Format; 4] {
    let frame = frame(policies, hdr, &[]);
    assert_eq!(
        (frame.images[4].format, frame.images[5].format),
        (R16G16B16A16_SFLOAT, R8G8B8A8_SRGB),
        "not by purpose"
    );
    [0, 1, 2, 3].map(|at| frame.images[at].format)
}

#[test]
fn each_word_has_its_formats_and_without_one_all_is_as_usual() {
    let usual = [R16G16B16A16_SFLOAT, R16G16B16A16_SFLOAT, D32_SFLOAT, D32_SFLOAT_S8_UINT];
    assert_eq!(formats("", "true"), usual);
    assert_eq!(formats("color: Balanced, depth_format: Exact,", "true"), usual);
    let [_, _, depth, marked] = usual;
    for (word, hdr, format) in [
        ("Smallest", "true", B10G11R11_UFLOAT_PACK32),
        ("Exact", "true", R32G32B32A32_SFLOAT),
        ("Smallest", "false", R8G8B8A8_SRGB),
        ("Balanced", "false", R8G8B8A8_SRGB),
        ("Exact", "false", R16G16B16A16_UNORM),
    ] {
        assert_eq!(formats(&format!("color: {word},"), hdr), [format, format, depth, marked], "{word}, {hdr}");
    }
    for (word, depth, marked) in
        [("Smallest", D16_UNORM, D24_UNORM_S8_UINT), ("Balanced", X8_D24_UNORM_PACK32, D24_UNORM_S8_UINT)]
    {
        let [color, follows, ..] = usual;
        assert_eq!(formats(&format!("depth_format: {word},"), "true"), [color, follows, depth, marked], "{word}");
    }
}

/// The formats of `depth` and `marked` for a scene that reaches `reach` times as far as the near plane, and what is said of both.
fn depths(word: &str, reach: f64) -> ([Format; 2], Vec<String>) {
    let facts = Facts { depth_range: Some(reach), ..Facts::UNKNOWN };
    let inputs = Inputs { facts, facts_known: true, ..INPUTS };
    let frame = right(&pipeline(&format!("depth_format: {word},"), "true", ""), &inputs);
    ([2, 3].map(|at| frame.images[at].format), frame.remarks.into_iter().map(|it| it.text).collect())
}

#[test]
fn depth_is_finer_than_asked_where_the_scene_reaches_too_far_and_that_is_said() {
    let none = Vec::<String>::new();
    assert_eq!(depths("Smallest", 1023.0), ([D16_UNORM, D24_UNORM_S8_UINT], none.clone()));
    let (formats, said) = depths("Smallest", 2000.0);
    assert_eq!(formats, [X8_D24_UNORM_PACK32, D24_UNORM_S8_UINT]);
    let expected = "X8_D24_UNORM_PACK32 is taken in spite of `depth_format: Smallest`: D16_UNORM is too coarse, since the scene \
                    reaches 2000 times as far as the near plane, and D16_UNORM is good for 1023 times";
    assert_eq!(said, [expected]);
    assert_eq!(depths("Balanced", 262_143.0), ([X8_D24_UNORM_PACK32, D24_UNORM_S8_UINT], none.clone()));
    for word in ["Smallest", "Balanced"] {
        let (formats, said) = depths(word, 1e7);
        assert_eq!(formats, [D32_SFLOAT, D32_SFLOAT_S8_UINT], "{word}");
        assert_eq!(said.len(), 2, "{said:?}");
    }
    assert_eq!(depths("Exact", 1e7), ([D32_SFLOAT, D32_SFLOAT_S8_UINT], none));
}

#[test]
fn maps_of_shadows_are_as_coarse_as_asked_however_far_the_scene_reaches() {
    let facts = Facts { depth_range: Some(1e9), ..Facts::UNKNOWN };
    let inputs = Inputs { facts, facts_known: true, ..INPUTS };
    let text = pipeline("depth_format: Smallest,", "true", r#"(name: "map", format: Depth, size: Fixed(512, 512)),"#)
        .replace(
            "(name: \"draw\"",
            r#"(name: "casters", draw: Casters(list: Opaque, cascade: 0, of: 1), shader: "casters", depth: (image: "map", clear: 0.0), side_effect: true),
            (name: "draw""#,
        );
    let frame = right(&text, &inputs);
    let format = |name: &str| frame.images.iter().find(|image| &*image.name == name).map(|image| image.format);
    assert_eq!([format("map"), format("depth")], [Some(D16_UNORM), Some(D32_SFLOAT)]);
}

#[test]
fn a_setting_or_an_expression_chooses_and_is_named() {
    let chosen = |frame: &Frame, at: usize| frame.images[at].chosen.clone();
    let said = |usual, because: &str| Some(ChosenFormat { usual, because: because.into() });
    let by_setting = frame("color: \"quality\",", "true", &[]);
    let expected = said(R16G16B16A16_SFLOAT, "`color: Smallest` (quality = 'Smallest')");
    assert_eq!((chosen(&by_setting, 0), chosen(&by_setting, 1)), (expected.clone(), expected));
    assert_eq!(chosen(&frame("color: \"quality\",", "true", &[("quality", "Balanced")]), 0), None);
    let by_expression = frame("depth_format: \"if(close, 'Smallest', 'Exact')\",", "true", &[]);
    assert_eq!(chosen(&by_expression, 2), said(D32_SFLOAT, "`depth_format: Smallest` (close = true)"));
    assert_eq!(chosen(&by_expression, 0), None);
}

/// The remark about `color`, which keeps its format.
fn kept(text: &str) -> String {
    let frame = right(text, &INPUTS);
    assert_eq!((frame.images[0].format, &frame.images[0].chosen), (R16G16B16A16_SFLOAT, &None));
    let [remark] = &frame.remarks[..] else { panic!("{:?}", frame.remarks) };
    assert_eq!(&*remark.subject, "color");
    let why = remark.text.strip_prefix("R16G16B16A16_SFLOAT is taken in spite of `color: Smallest`: ");
    why.expect(&remark.text).to_owned()
}

#[test]
fn what_others_rely_on_keeps_its_format() {
    let text = pipeline("color: Smallest,", "true", "");
    let leaves = text.replace("outputs: [\"screen\"]", "outputs: [\"screen\", \"follows\"]");
    assert_eq!(kept(&leaves), "it leaves the frame");
    let imported = text.replace(
        "size: Output),\n                (name: \"follows\"",
        "size: Output, lifetime: Imported(before: Sampled)),\n                (name: \"follows\"",
    );
    assert_eq!(kept(&imported), "it is handed in");
    let moved = text
        .replace("images: [", "buffers: [(name: \"bytes\", bytes: PerTexel(8, \"color\"))], images: [")
        .replace("(name: \"blur\"", "(name: \"save\", copy: (from: \"color\", to: \"bytes\")), (name: \"blur\"")
        .replace("outputs: [\"screen\"]", "outputs: [\"screen\", \"bytes\"]");
    assert_eq!(kept(&moved), "`save` moves its bytes");
    let stored = text.replace(
        "(name: \"show\"",
        "(name: \"spread\", dispatch: \"paint\", groups: Count(1, 1, 1), storage: {\"target\": \"follows\"}, side_effect: true), (name: \"show\"",
    );
    assert_eq!(kept(&stored), "`spread` uses it as a storage image");
}

#[test]
fn colour_keeps_its_alpha_unless_its_format_has_none() {
    let text = pipeline("color: Smallest,", "true", "");
    assert_eq!(right(&text, &INPUTS).images[0].format, B10G11R11_UFLOAT_PACK32);
    let because = "the alpha of `color` is kept, since its format isn't `Color(alpha: false)`";
    for with_alpha in ["Color(hdr: true)", "Color(hdr: true, alpha: true)", "Color(hdr: true, alpha: \"close\")"] {
        let kept_alpha = text.replace("Color(hdr: true, alpha: false)", with_alpha);
        assert_eq!(kept(&kept_alpha), because, "{with_alpha}");
        let exact = kept_alpha.replace("color: Smallest", "color: Exact");
        assert_eq!(right(&exact, &INPUTS).images[0].format, R32G32B32A32_SFLOAT, "it has alpha");
    }
    let copied = text
        .replace("format: Like(\"color\")", "format: Color(hdr: true)")
        .replace(
            "\"blur_tent\"), sample: {\"source\": \"color\"}, color: [\"follows\"]",
            "\"blur_tent\"), sample: {\"source\": \"color\"}, color: [\"named\"]",
        )
        .replace("(name: \"show\"", "(name: \"move\", copy: (from: \"color\", to: \"follows\")), (name: \"show\"");
    let because = "the alpha of `follows` is kept, since its format isn't `Color(alpha: false)`";
    assert_eq!(kept(&copied), because, "it is copied into an image that keeps its alpha");
    let named = copied
        .replace("(name: \"follows\", format: Color(hdr: true)", "(name: \"follows\", format: R16G16B16A16_SFLOAT");
    assert_eq!(kept(&named), because, "it is copied into an image whose format is named");
}

#[test]
fn what_is_dumped_is_shown_as_it_is() {
    let dump = ["color".to_owned()];
    let inputs = Inputs { dump: &dump, ..INPUTS };
    assert_eq!(right(&pipeline("color: Smallest,", "true", ""), &inputs).images[0].format, B10G11R11_UFLOAT_PACK32);
}

#[test]
fn a_depth_format_that_stands_in_the_file_and_is_too_coarse_for_the_scene_is_told_of() {
    let said = |format: &str, reach: Option<f64>| {
        let text = pipeline("", "true", "")
            .replace("(name: \"depth\", format: Depth", &format!("(name: \"depth\", format: {format}"));
        let facts = Facts { depth_range: reach, ..Facts::UNKNOWN };
        let frame = right(&text, &Inputs { facts, facts_known: true, ..INPUTS });
        frame.remarks.into_iter().map(|it| format!("{}: {}", it.subject, it.text)).collect::<Vec<_>>()
    };
    let coarse = |format: &str, reach: &str, good: &str| {
        vec![format!(
            "depth: {format} is too coarse, since the scene reaches {reach} times as far as the near plane, and {format} is good for \
             {good} times; `Depth` in its place reaches any distance"
        )]
    };
    assert_eq!(said("D16_UNORM", Some(2000.0)), coarse("D16_UNORM", "2000", "1023"));
    assert_eq!(said("X8_D24_UNORM_PACK32", Some(1e6)), coarse("X8_D24_UNORM_PACK32", "1000000", "262143"));
    assert_eq!(said("D24_UNORM_S8_UINT", Some(1e6)), coarse("D24_UNORM_S8_UINT", "1000000", "262143"));
    let none = Vec::<String>::new();
    for (format, reach) in
        [("D16_UNORM", Some(1023.0)), ("D16_UNORM", None), ("D32_SFLOAT", Some(1e9)), ("Depth", Some(1e9))]
    {
        assert_eq!(said(format, reach), none, "{format}, {reach:?}");
    }
    // One that follows has the format too; nothing is said of depth that no object is drawn into.
    let text = pipeline("", "true", "(name: \"coarse\", format: D16_UNORM, size: Output),")
        .replace("(name: \"depth\", format: Depth", "(name: \"depth\", format: Like(\"coarse\")");
    let facts = Facts { depth_range: Some(2000.0), ..Facts::UNKNOWN };
    let frame = right(&text, &Inputs { facts, facts_known: true, ..INPUTS });
    assert_eq!(frame.remarks.iter().map(|it| &*it.subject).collect::<Vec<_>>(), ["depth"]);
    assert!(frame.remarks.iter().all(|it| it.kind.stage() == Stage::Fit), "who draws is told");
}
