//! Views: parts of a frame that have their own size, camera, allowances and values of settings.

use crate::testing::pipelines::{INPUTS, right, set, wrong};
use crate::testing::plans::shipped;
use framewright_graph::compile::{Compiler, Options, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Allowances, Frame, Image, Jitter, Pass, ViewIndex};
use std::sync::Arc;

/// A pipeline with two views, these images and these passes after those that fill `screen` and `small`.
fn pipeline(preview: &str, images: &str, passes: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            settings: [
                (name: "glow", value: Bool(default: true)),
                (name: "msaa", value: OneOf(default: 4, of: [1, 2, 4])),
                (name: "share", value: Number(default: 0.25, min: 0.125, max: 1.0)),
            ],
            views: [(name: "main"), (name: "preview", {preview})],
            fragments: [
                (name: "inner", parameters: [(name: "target", value: Image)],
                    passes: [(name: "draw", draw: FullScreen("plain"), when: "view.width < 400", color: ["target"])]),
                (name: "outer", parameters: [(name: "target", value: Image), (name: "samples", value: Integer)],
                    images: [(name: "own", format: Color, size: Output, samples: "samples")],
                    passes: [
                        (use: "inner", name: "inner", with: {{"target": "target"}}),
                        (name: "own", draw: FullScreen("plain"), color: ["own"]),
                    ]),
            ],
            images: [
                (name: "screen", format: Output, size: Output),
                (name: "small", view: "preview", format: Output, size: Output),
                {images}
            ],
            passes: [
                (name: "screen", draw: FullScreen("plain"), color: ["screen"]),
                (name: "small", view: "preview", draw: FullScreen("plain"), color: ["small"]),
                {passes}
            ],
            outputs: ["screen", "small"],
        )"#
    )
}

fn image<'f>(frame: &'f Frame, name: &str) -> &'f Image {
    frame.images.iter().find(|image| *image.name == *name).unwrap_or_else(|| panic!("there is no image `{name}`"))
}

fn pass<'f>(frame: &'f Frame, name: &str) -> &'f Pass {
    frame.passes.iter().find(|pass| *pass.name == *name).unwrap_or_else(|| panic!("there is no pass `{name}`"))
}

/// Why passes are off.
fn off(frame: &Frame) -> Vec<(&str, &str)> {
    frame.switched_off.iter().map(|off| (&*off.name, &*off.because)).collect()
}

#[test]
fn a_view_has_its_own_size_camera_and_allowances() {
    let frame = right(&pipeline(r#"size: Fixed(320, 200), camera: "top", allows_msaa: false"#, "", ""), &INPUTS);
    let [main, preview] = &frame.views[..] else { panic!("{:?}", frame.views) };
    assert_eq!(
        (&*main.name, main.extent, &main.camera, main.allows),
        ("main", [640, 360], &None, Allowances::default())
    );
    let allows = Allowances { msaa: false, ..Allowances::default() };
    assert_eq!((&*preview.name, preview.extent, preview.allows), ("preview", [320, 200], allows));
    assert_eq!(preview.camera.as_deref(), Some("top"));
    let place = frame.sources.place(preview.span).expect("it stands in the file");
    assert_eq!(place.line, 8);
}

#[test]
fn a_view_may_be_a_share_of_the_frame_that_a_setting_chooses() {
    let extent = |size: &str, set: &[(String, String)]| {
        right(&pipeline(&format!("size: {size}"), "", ""), &Inputs { set, ..INPUTS }).views[1].extent
    };
    assert_eq!(extent("Scaled(0.5)", &[]), [320, 180]);
    assert_eq!(extent("Scaled(\"share\")", &[]), [160, 90]);
    assert_eq!(extent("Scaled(\"share\")", &set(&[("share", "1")])), [640, 360]);
    assert_eq!(extent("Fixed(\"if(glow, view.width - 40, 1)\", \"view.height\")", &[]), [600, 360]);
}

#[test]
fn sizes_and_names_of_the_view_are_those_of_the_view_that_an_entry_is_for() {
    let images = r#"(name: "half", view: "preview", format: Color, size: Scaled(0.5)),
                    (name: "own_half", format: Color, size: Scaled(0.5)),
                    (name: "row", view: "preview", format: Color, size: Fixed("view.width", 1)),
                    (name: "main_row", view: "main", format: Color, size: Fixed("view.width", 1)),
                    (name: "follows", format: Color, size: Like("small")),"#;
    let frame = right(&pipeline("size: Fixed(300, 200)", images, ""), &INPUTS);
    let extent = |name: &str| image(&frame, name).extent;
    assert_eq!((extent("small"), extent("half"), extent("own_half")), ([300, 200, 1], [150, 100, 1], [320, 180, 1]));
    assert_eq!((extent("row"), extent("main_row"), extent("follows")), ([300, 1, 1], [640, 1, 1], [300, 200, 1]));
    assert_eq!((pass(&frame, "screen").view, pass(&frame, "small").view), (ViewIndex(0), ViewIndex(1)));
}

#[test]
fn what_a_view_sets_holds_within_it_alone_whatever_the_user_chose() {
    let images = r#"(name: "color", format: Color, size: Output, samples: "msaa"),
                    (name: "small_color", view: "preview", format: Color, size: Output, samples: "msaa"),"#;
    let passes = r#"(name: "glow", when: "glow", draw: FullScreen("plain"), color: ["screen"]),
                    (name: "small_glow", view: "preview", when: "glow", draw: FullScreen("plain"), color: ["small"]),"#;
    let text = pipeline(r#"set: {"glow": false, "msaa": 1}"#, images, passes);
    let frame = right(&text, &INPUTS);
    assert_eq!((image(&frame, "color").samples, image(&frame, "small_color").samples), (4, 1));
    assert_eq!(off(&frame), [("small_glow", "glow = false in view `preview`")]);
    let chosen = set(&[("glow", "true"), ("msaa", "2")]);
    let frame = right(&text, &Inputs { set: &chosen, ..INPUTS });
    assert_eq!((image(&frame, "color").samples, image(&frame, "small_color").samples), (2, 1));
    assert_eq!(off(&frame).len(), 1);
    assert_eq!(frame.settings[0].1, "true", "what the frame shows is what the user chose");
}

#[test]
fn conditions_see_what_a_view_allows() {
    let passes = r#"(name: "a", when: "view.allows_hdr && view.allows_scale", draw: FullScreen("plain"), color: ["screen"]),
        (name: "b", view: "preview", when: "view.allows_hdr", draw: FullScreen("plain"), color: ["small"]),
        (name: "c", view: "preview", when: "view.allows_scale", draw: FullScreen("plain"), color: ["small"]),"#;
    let frame = right(&pipeline(r#"allows_hdr: "!glow", allows_scale: "glow""#, "", passes), &INPUTS);
    assert_eq!(off(&frame), [("b", "view.allows_hdr = false in view `preview`")]);
}

#[test]
fn a_fragment_is_for_the_view_of_its_use_and_so_is_what_it_uses() {
    let passes = r#"(use: "outer", name: "large", with: {"target": "screen", "samples": "msaa"}),
                    (use: "outer", name: "little", view: "preview", with: {"target": "small", "samples": "msaa"}),"#;
    let frame = right(&pipeline(r#"size: Scaled("share"), set: {"msaa": 2}"#, "", passes), &INPUTS);
    let own = |name: &str| (image(&frame, name).extent, image(&frame, name).samples);
    assert_eq!(own("large.own"), ([640, 360, 1], 4));
    assert_eq!(own("little.own"), ([160, 90, 1], 2));
    assert_eq!(pass(&frame, "little.inner.draw").view, ViewIndex(1));
    assert_eq!(off(&frame), [("large.inner.draw", "view.width = 640")]);
}

#[test]
fn repetitions_and_stand_ins_are_for_the_view_too() {
    let images =
        r#"(name: "steps", view: "preview", repeat: ("i", "msaa"), format: Color, size: Scaled("1 / (i + 1)")),"#;
    let passes = r#"(name: "step", view: "preview", repeat: ("i", "msaa"), draw: FullScreen("plain"), color: ["steps[i]"]),
                    (name: "off", view: "preview", when: "!glow", draw: FullScreen("downsample"),
                        sample: {"source": "steps[0]"}, color: ["small"],
                        otherwise: Clear(image: "small", value: 0)),"#;
    let frame = right(&pipeline(r#"size: Fixed(90, 60), set: {"msaa": 2}"#, images, passes), &INPUTS);
    let steps: Vec<_> =
        frame.images.iter().filter(|image| image.name.starts_with("steps")).map(|it| it.extent).collect();
    assert_eq!(steps, [[90, 60, 1], [45, 30, 1]]);
    assert_eq!((pass(&frame, "step[1]").view, pass(&frame, "off").view), (ViewIndex(1), ViewIndex(1)));
}

#[test]
fn a_file_without_views_has_none() {
    let text = r#"Pipeline(version: 1, images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "show", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#;
    assert_eq!(right(text, &INPUTS).views, []);
}

#[test]
fn a_view_is_shifted_by_parts_of_a_texel_of_what_is_drawn() {
    let jitter = |fields: &str, chosen: &[(String, String)]| {
        right(&pipeline(fields, "", ""), &Inputs { set: chosen, ..INPUTS }).views[1].jitter.clone()
    };
    let sized = "size: Fixed(320, 200)";
    assert_eq!(jitter(sized, &[]), None);
    assert_eq!(jitter(&format!("{sized}, jitter: 1"), &[]), None);
    assert_eq!(jitter(&format!("{sized}, jitter: 8"), &[]), Some(Jitter::halton(8, [320, 200])));
    // Of a smaller picture texels are larger; values of settings are the view's own.
    let within =
        format!("{sized}, jitter: \"if(glow, 1, msaa)\", jitter_size: Scaled(\"share\"), set: {{\"glow\": false}}");
    assert_eq!(jitter(&within, &[]), Some(Jitter::halton(4, [80, 50])));
    assert_eq!(jitter(&within, &set(&[("msaa", "1")])), None);
}

#[test]
fn a_compiler_that_remembers_the_last_frame_takes_over_how_views_are_shifted() {
    let device = Arc::new(shipped("amd-rx-7800-xt"));
    let mut compiler = Compiler::new();
    for jitter in ["4", "8", "8, jitter_size: Scaled(0.5)", "2"] {
        let frame = Arc::new(right(&pipeline(&format!("size: Fixed(320, 200), jitter: {jitter}"), "", ""), &INPUTS));
        // Spans differ with the texts; what is compiled anew is the judge.
        let [mut estimated, mut anew] = [MemoryEstimate(&device), MemoryEstimate(&device)];
        let followed = compiler.compile(&frame, &device, &mut estimated, &Options::default()).expect("it compiles");
        assert_eq!(
            followed,
            &compile(&frame, &device, &mut anew, &Options::default()).expect("it compiles"),
            "{jitter}"
        );
    }
    let by_setting = |share: &str| {
        let text = pipeline("size: Fixed(320, 200), jitter: 8, jitter_size: Scaled(\"share\")", "", "");
        Arc::new(right(&text, &Inputs { set: &set(&[("share", share)]), ..INPUTS }))
    };
    for share in ["0.25", "0.5", "1"] {
        let frame = by_setting(share);
        let [mut estimated, mut anew] = [MemoryEstimate(&device), MemoryEstimate(&device)];
        let followed = compiler.compile(&frame, &device, &mut estimated, &Options::default()).expect("it compiles");
        assert_eq!(
            followed,
            &compile(&frame, &device, &mut anew, &Options::default()).expect("it compiles"),
            "{share}"
        );
    }
}

#[test]
fn a_view_is_shifted_1_to_256_times() {
    for (jitter, said) in [("0", "1 to 256"), ("257", "1 to 256"), ("2.5", "a whole number"), ("\"msaa * 100\"", "400")]
    {
        let text = pipeline(&format!("jitter: {jitter}"), "", "");
        let mistakes = wrong(&text, &INPUTS);
        assert!(mistakes.contains(said) && mistakes.contains(":8:"), "{jitter}: {mistakes}");
    }
}
