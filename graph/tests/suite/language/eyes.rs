//! Passes over each eye's own images run for each eye, and all others once (ST-1).

use crate::testing::pipelines::{INPUTS, right, wrong};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Eye, Frame, Resource, Stereo, ViewEye, ViewIndex};

const TWO: Inputs<'static> = Inputs { stereo: Stereo::MultiPass, ..INPUTS };

/// A pipeline with these images and passes beside what each eye sees.
fn pipeline(images: &str, passes: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            images: [
                (name: "color", format: Color, size: Output, per_eye: true),
                (name: "noise", format: Color, size: Fixed(64, 64)),
                (name: "screen", format: Output, size: Like("color")),
                {images}
            ],
            passes: [
                (name: "noise", draw: FullScreen("plain"), color: ["noise"]),
                (name: "opaque", draw: Objects(Opaque), shader: "lit", color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
                (name: "show", draw: FullScreen("reinhard"), sample: {{"source": "color"}}, color: ["screen"]),
                {passes}
            ],
            outputs: ["screen", "noise"],
        )"#
    )
}

fn passes(frame: &Frame) -> Vec<&str> {
    frame.passes.iter().map(|pass| &*pass.name).collect()
}

fn drawn(frame: &Frame, pass: &str) -> Vec<String> {
    let pass = frame.passes.iter().find(|it| *it.name == *pass).unwrap_or_else(|| panic!("there is no pass `{pass}`"));
    let read = pass.sampled.iter().map(|sampled| sampled.image);
    let written = pass.color.iter().map(|color| color.image);
    read.chain(written).map(|image| frame.images[image.0 as usize].name.to_string()).collect()
}

#[test]
fn a_pass_that_draws_what_each_eye_has_runs_for_each_and_all_others_once() {
    let frame = right(&pipeline("", ""), &TWO);
    let expected = ["noise", "opaque (left)", "opaque (right)", "show (left)", "show (right)"];
    assert_eq!(passes(&frame), expected);
    assert_eq!(drawn(&frame, "show (left)"), ["color (left)", "screen (left)"]);
    assert_eq!(drawn(&frame, "show (right)"), ["color (right)", "screen (right)"]);
    let views: Vec<_> = frame.views.iter().map(|view| (&*view.name, view.eye)).collect();
    let eye = |eye| Some(ViewEye { eye, of: ViewIndex(0) });
    let expected = [("main", None), ("main (left)", eye(Eye::Left)), ("main (right)", eye(Eye::Right))];
    assert_eq!(views, expected);
    assert_eq!(frame.passes.iter().map(|pass| pass.view.0).collect::<Vec<_>>(), [0, 1, 2, 1, 2]);
    let outputs = frame.outputs.iter().map(|output| match output.resource {
        Resource::Image(image) => (&*frame.images[image.0 as usize].name, output.eye),
        Resource::Buffer(_) => panic!("no buffer leaves the frame"),
    });
    let expected = [("screen (left)", Some(Eye::Left)), ("screen (right)", Some(Eye::Right)), ("noise", None)];
    assert_eq!(outputs.collect::<Vec<_>>(), expected);
}

#[test]
fn for_one_eye_nothing_is_there_twice() {
    let frame = right(&pipeline("", ""), &INPUTS);
    assert_eq!(passes(&frame), ["noise", "opaque", "show"]);
    assert!(frame.views.is_empty());
    assert!(frame.images.iter().all(|image| !image.name.contains('(')), "{:?}", frame.images);
}

#[test]
fn an_image_follows_the_one_whose_size_it_follows_unless_it_says_otherwise() {
    let images = r#"
        (name: "half", format: Color, size: Scaled(0.5, "screen")),
        (name: "shared", format: Color, size: Like("half"), per_eye: false),
    "#;
    let more = r#"
        (name: "shrink", draw: FullScreen("reinhard"), sample: {"source": "screen"}, color: ["half"]),
        (name: "once", draw: FullScreen("plain"), color: ["shared"]),
    "#;
    let frame = right(&pipeline(images, more), &TWO);
    assert_eq!(passes(&frame)[5..], ["shrink (left)", "shrink (right)", "once"]);
}

#[test]
fn one_eye_can_be_named_as_source_and_as_target() {
    let images = r#"(name: "mirror", format: Color, size: Output),"#;
    let more = r#"
        (name: "mirror", draw: FullScreen("reinhard"), sample: {"source": Eye(Right, "screen")}, color: ["mirror"]),
        (name: "mark", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: [Eye(Left, "screen")]),
        (name: "both", copy: (from: Eye(Left, "color"), to: Eye(Right, "color"))),
    "#;
    let frame = right(&pipeline(images, more), &TWO);
    assert_eq!(passes(&frame)[5..], ["mirror", "mark", "both"]);
    assert_eq!(drawn(&frame, "mirror"), ["screen (right)", "mirror"]);
    // A pass that draws for one eye reads that eye's images.
    assert_eq!(drawn(&frame, "mark"), ["color (left)", "screen (left)"]);
    assert_eq!(frame.passes.iter().map(|pass| pass.view.0).collect::<Vec<_>>()[5..], [0, 1, 2]);
    // For one eye both are the same image.
    assert_eq!(
        drawn(&right(&pipeline(images, &more.replace("(name: \"both\"", "// ")), &INPUTS), "mirror"),
        ["screen", "mirror"]
    );
}

#[test]
fn what_can_not_be_for_each_eye_is_a_mistake_for_two_and_a_remark_for_one() {
    let mistakes = [
        (
            r#"(name: "mirror", format: Color, size: Output),"#,
            r#"(name: "mirror", draw: FullScreen("reinhard"), sample: {"source": "screen"}, color: ["mirror"]),"#,
            "pass `mirror` runs once, and each eye has a `screen` of its own",
        ),
        (
            r#"(name: "shared", format: Color, size: Output),"#,
            r#"(name: "two", custom: "it", writes: ["color", "shared"]),"#,
            "pass `two` runs once for each eye, and both would write this",
        ),
        (
            "",
            r#"(name: "own", draw: FullScreen("reinhard"), sample: {"source": Eye(Left, "noise")}, color: ["screen"]),"#,
            "`noise` is the same for both eyes",
        ),
        (
            r#"(name: "other", format: Output, size: Like("color")),"#,
            r#"(name: "mixed", custom: "it", writes: ["screen", Eye(Left, "other")]),"#,
            "pass `mixed` runs once for each eye, and both would write this one's `other`",
        ),
    ];
    for (images, more, expected) in mistakes {
        let said = wrong(&pipeline(images, more), &TWO);
        assert!(said.contains(expected), "{expected}: {said}");
    }
    let (images, more, expected) = mistakes[0];
    let frame = right(&pipeline(images, more), &INPUTS);
    let said: Vec<_> = frame.remarks.iter().map(|remark| &*remark.text).collect();
    assert_eq!(said, [format!("can't be drawn for two eyes: {expected}")]);
    let foreign = wrong(&pipeline(mistakes[2].0, mistakes[2].1), &INPUTS);
    assert!(foreign.contains(mistakes[2].2), "{foreign}");
    let said =
        wrong(&pipeline("", r#"(name: "x", draw: FullScreen("plain"), color: [Eye(Middle, "screen")]),"#), &INPUTS);
    assert!(said.contains("`Middle`") && said.contains("`Left`"), "{said}");
}

#[test]
fn what_is_wrong_for_both_eyes_is_told_once() {
    let more = r#"(name: "odd", draw: FullScreen("no_such"), sample: {"source": "color"}, color: ["screen"]),"#;
    let [one, two] = [INPUTS, TWO].map(|inputs| wrong(&pipeline("", more), &inputs));
    assert_eq!(one, two);
    assert_eq!(two.matches("no_such").count(), 2, "in the message and in the line that it shows: {two}");
}

#[test]
fn what_a_camera_sees_for_both_eyes_at_once_is_remarked_where_each_eye_is_shown_it() {
    let text = pipeline("", "");
    assert!(right(&text, &INPUTS).remarks.is_empty());
    let shared = text.replace("size: Output, per_eye: true)", "size: Output)");
    let shared = shared.replace("size: Like(\"color\"))", "size: Output, per_eye: true)");
    for inputs in [INPUTS, TWO] {
        let frame = right(&shared, &inputs);
        let said: Vec<_> = frame.remarks.iter().map(|remark| (&*remark.subject, &*remark.text)).collect();
        let text = "draws `color` once for both eyes, and what each eye sees is made of it: say `per_eye: true` of it";
        assert_eq!(said, [("opaque", text)]);
    }
}
