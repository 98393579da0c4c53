//! Images that both eyes have are one image where both are drawn at once, and the passes that draw them run once (ST-2, ST-4).
//! Others are drawn for one eye after the other, and the frame says why.

mod apart;
mod recorded;

use crate::testing::pipelines::{INPUTS, frame, right, wrong};
use crate::testing::plans::shipped;
use framewright_graph::device::Profile;
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Eye, EyeForm, Frame, Pass, Resource, Stereo};

/// Modes that draw both eyes at once, and how they hold both eyes' parts on a device that can do what Vulkan 1.3 demands.
const AT_ONCE: [(Stereo, EyeForm); 3] =
    [(Stereo::DoubleWide, EyeForm::Halves), (Stereo::Instanced, EyeForm::Halves), (Stereo::Multiview, EyeForm::Layers)];

const fn drawn(stereo: Stereo) -> Inputs<'static> {
    Inputs { stereo, ..INPUTS }
}

/// A pipeline with these images, buffers and passes beside what each eye sees.
fn pipeline(images: &str, passes: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            settings: [(name: "on", value: Bool(default: false))],
            images: [
                (name: "color", format: Color(hdr: true), size: Output, per_eye: true),
                (name: "noise", format: Color(hdr: true), size: Output),
                (name: "screen", format: Output, size: Like("color")),
                {images}
            ],
            buffers: [
                (name: "rows", bytes: PerTexel(8, "color"), lifetime: Persistent),
                (name: "counts", bytes: 32, lifetime: Persistent),
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

fn pass<'f>(frame: &'f Frame, name: &str) -> &'f Pass {
    frame.passes.iter().find(|it| *it.name == *name).unwrap_or_else(|| panic!("no `{name}` in {:?}", passes(frame)))
}

/// Images by name, with how they hold both eyes' parts.
fn images(frame: &Frame) -> Vec<(&str, Option<EyeForm>)> {
    frame.images.iter().map(|image| (&*image.name, image.eyes)).collect()
}

/// A device whose profile is shipped.
fn saved() -> Profile {
    shipped("amd-rx-7800-xt")
}

/// The remarks of a frame: subject, place and text.
fn remarks(frame: &Frame) -> Vec<(String, String, String)> {
    let place = |span| frame.sources.place(span).expect("it stands in the file").to_string();
    frame.remarks.iter().map(|it| (it.subject.to_string(), place(it.span), it.text.clone())).collect()
}

/// Where the image `name` is declared in `text`, as people read it.
fn declared(text: &str, name: &str) -> String {
    let at = text.find(&format!("(name: \"{name}\"")).expect("it is declared") + "(name: ".len();
    let line = text[..at].matches('\n').count() + 1;
    let column = at - text[..at].rfind('\n').map_or(0, |end| end + 1) + 1;
    format!("test.ron:{line}:{column}")
}

/// In each of these modes just these images are one for each eye, for these reasons.
fn fall_apart(modes: &[Stereo], more_images: &str, more: &str, expected: &[(&str, &str)]) -> Vec<Frame> {
    let text = pipeline(more_images, more);
    let in_mode = |stereo: &Stereo| {
        let frame = right(&text, &drawn(*stereo));
        let found: Vec<(String, String, String)> = remarks(&frame);
        let all = expected.iter().map(|(image, why)| {
            let text = format!("is drawn for one eye after the other: {why}");
            ((*image).to_owned(), declared(&text_of(&frame), image), text)
        });
        assert_eq!(found, all.collect::<Vec<_>>(), "{stereo:?} of\n{more_images}\n{more}");
        for (image, _) in expected {
            let eyes: Vec<&str> = frame.images.iter().map(|it| &*it.name).filter(|it| it.starts_with(image)).collect();
            let both = [Eye::Left, Eye::Right].map(|eye| eye.named(image));
            assert!(both.iter().all(|it| eyes.contains(&&**it)) && !eyes.contains(image), "{stereo:?}: {eyes:?}");
        }
        let apart = |image: &str| {
            let alone = image.strip_suffix(" (left)").or_else(|| image.strip_suffix(" (right)"));
            expected.iter().any(|(name, _)| Some(*name) == alone)
        };
        for image in &frame.images {
            assert!(image.eyes.is_none() || !apart(&image.name), "{stereo:?}: `{}` is one for both", image.name);
        }
        frame
    };
    modes.iter().map(in_mode).collect()
}

fn text_of(frame: &Frame) -> String {
    frame.sources.file(0).expect("the pipeline").text.to_string()
}

const ALL: &[Stereo] = &[Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];
const IN_HALVES: &[Stereo] = &[Stereo::DoubleWide, Stereo::Instanced];

const OWN: &str = r#"(name: "own", format: Color(hdr: true), size: Like("color")),"#;

#[test]
fn both_eyes_parts_are_in_one_image_and_what_draws_them_runs_once() {
    let text = pipeline("", "");
    for (stereo, form) in AT_ONCE {
        let frame = right(&text, &drawn(stereo));
        assert_eq!(passes(&frame), ["noise", "opaque", "show"], "{stereo:?}");
        assert_eq!(images(&frame), [("color", Some(form)), ("noise", None), ("screen", Some(form))], "{stereo:?}");
        assert_eq!(frame.stereo, stereo);
        assert_eq!(remarks(&frame), [], "{stereo:?}");
        // Sizes are those of one eye's part.
        assert!(frame.images.iter().all(|image| image.extent == [640, 360, 1]));
        let made = frame.images[0].made();
        let expected = match form {
            EyeForm::Halves => ([1280, 360, 1], 1),
            EyeForm::Layers => ([640, 360, 1], 2),
        };
        assert_eq!((made, frame.images[0].made_layers()), expected, "{stereo:?}");
        assert_eq!((frame.images[1].made(), frame.images[1].made_layers()), ([640, 360, 1], 1), "the noise is shared");
        // Each output is one for both.
        let outputs: Vec<_> = frame.outputs.iter().map(|output| (output.resource, output.eye)).collect();
        let image = |at| Resource::Image(framewright_graph::frame::ImageIndex(at));
        assert_eq!(outputs, [(image(2), None), (image(1), None)], "{stereo:?}");
        // The pass's view lies between both eyes; the draw source looks up the views of both.
        assert_eq!(pass(&frame, "opaque").view.0, 0);
        let views: Vec<_> = frame.views.iter().map(|view| &*view.name).collect();
        assert_eq!(views, ["main", "main (left)", "main (right)"]);
    }
}

#[test]
fn one_eye_and_one_eye_after_the_other_have_no_images_for_both() {
    for stereo in [Stereo::Off, Stereo::MultiPass] {
        let frame = right(&pipeline("", ""), &drawn(stereo));
        assert!(frame.images.iter().all(|image| image.eyes.is_none()), "{stereo:?}");
    }
}

#[test]
fn instanced_draws_into_layers_where_vertex_shaders_choose_them_and_else_into_halves() {
    let device = |vertex_layer| Profile { vertex_layer, ..saved() };
    for (device, form) in
        [(Some(device(true)), EyeForm::Layers), (Some(device(false)), EyeForm::Halves), (None, EyeForm::Halves)]
    {
        let of = |stereo| Inputs { device: device.as_ref(), ..drawn(stereo) };
        let frame = right(&pipeline("", ""), &of(Stereo::Instanced));
        assert_eq!(frame.images[0].eyes, Some(form), "{device:?}");
        // The others are what they are everywhere.
        assert_eq!(right(&pipeline("", ""), &of(Stereo::DoubleWide)).images[0].eyes, Some(EyeForm::Halves));
        assert_eq!(right(&pipeline("", ""), &of(Stereo::Multiview)).images[0].eyes, Some(EyeForm::Layers));
    }
}

#[test]
fn being_drawn_apart_spreads_to_what_is_drawn_from_it_and_beside_it_and_no_further() {
    let images = r#"
        (name: "first", format: Color(hdr: true), size: Like("color")),
        (name: "beside", format: R16G16_SFLOAT, size: Like("color")),
        (name: "second", format: Color(hdr: true), size: Like("color")),
        (name: "third", format: Color(hdr: true), size: Like("color")),
        (name: "other", format: Color(hdr: true), size: Like("color")),"#;
    let more = r#"
        (name: "record", custom: "it", writes: ["first"]),
        (name: "both", draw: Objects(Opaque), shader: "g_buffer",
            color: [(image: "first", clear: (0.0, 0.0, 0.0, 1.0)), (image: "beside", clear: (0.0, 0.0, 0.0, 1.0)), (image: "other", clear: (0.0, 0.0, 0.0, 1.0))]),
        (name: "from", draw: FullScreen("reinhard"), sample: {"source": "beside"}, color: ["second"]),
        (name: "on", draw: FullScreen("reinhard"), sample: {"source": "second"}, color: ["third"]),
    "#;
    let expected = [
        ("first", "`record` is recorded by the program"),
        ("beside", "`both` draws it for one eye after the other, as it does with `first`"),
        ("second", "`from` draws it for one eye after the other, as it does with `beside`"),
        ("third", "`on` draws it for one eye after the other, as it does with `second`"),
        ("other", "`both` draws it for one eye after the other, as it does with `first`"),
    ];
    for frame in fall_apart(ALL, images, more, &expected) {
        assert_eq!(passes(&frame)[..3], ["noise", "opaque", "show"], "what has nothing to do with it runs once");
    }
    // Also against the order of passes: what a pass draws beside an image that a later one takes apart.
    let more = r#"
        (name: "on", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["third"]),
        (name: "record", custom: "it", writes: ["third"]),"#;
    for frame in fall_apart(ALL, images, more, &[("third", "`record` is recorded by the program")]) {
        assert_eq!(
            passes(&frame),
            ["noise", "opaque", "show", "on (left)", "on (right)", "record (left)", "record (right)"]
        );
    }
    // One eye's, named, is that eye's part: it doesn't make a pass draw for one eye.
    let more = r#"
        (name: "record", custom: "it", writes: ["first"]),
        (name: "on", draw: FullScreen("reinhard"), sample: {"source": Eye(Right, "first")}, color: ["second"]),"#;
    for frame in fall_apart(ALL, images, more, &[("first", "`record` is recorded by the program")]) {
        let on = pass(&frame, "on");
        assert_eq!(&*frame.images[on.sampled[0].image.0 as usize].name, "first (right)");
        assert_eq!(on.sampled[0].eye, None, "it is an image of its own");
    }
}

#[test]
fn what_a_pass_that_is_off_hands_on_is_one_for_both_or_two_on_both_sides() {
    let off = r#"(name: "grade", when: "on", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["own"],
                  otherwise: Forward(from: "color", to: "own")),"#;
    for frame in fall_apart(ALL, OWN, off, &[]) {
        assert_eq!(passes(&frame)[3..], ["grade"]);
    }
    let record = r#"(name: "record", custom: "it", reads: ["own"], side_effect: true),"#;
    let expected = [
        ("color", "`grade` is off and hands it on"),
        ("screen", "`show` draws it for one eye after the other, as it does with `color`"),
        ("own", "`record` uses it otherwise than by sampling or drawing"),
    ];
    for frame in fall_apart(ALL, OWN, &[off, record].concat(), &expected) {
        let forwards = frame.passes.iter().filter(|pass| pass.name.starts_with("grade"));
        assert_eq!(forwards.map(|pass| &*pass.name).collect::<Vec<_>>(), ["grade (left)", "grade (right)"]);
    }
}

#[test]
fn what_both_share_is_handed_to_each_eye_and_what_is_each_eyes_not_to_what_both_share() {
    let off = r#"(name: "grade", when: "on", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["own"],
                  otherwise: Forward(from: "noise", to: "own"), side_effect: true),"#;
    for frame in fall_apart(ALL, OWN, off, &[("own", "`grade` is off and hands it on")]) {
        assert_eq!(passes(&frame)[3..], ["grade (left)", "grade (right)"]);
    }
    let image = r#"(name: "once", format: Color(hdr: true), size: Output),"#;
    let off = r#"(name: "grade", when: "on", draw: FullScreen("reinhard"), sample: {"source": Eye(Right, "color")},
                  color: ["once"], otherwise: Forward(from: "color", to: "once"), side_effect: true),"#;
    for stereo in [Stereo::MultiPass, Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview] {
        let mistakes = wrong(&pipeline(image, off), &drawn(stereo));
        assert!(mistakes.contains("pass `grade` is off, and `once` would take each eye's `color`"), "{mistakes}");
    }
}

#[test]
fn one_eye_that_is_sampled_is_that_ones_part_in_every_mode() {
    let images = r#"(name: "mirror", format: Color(hdr: true), size: Output),"#;
    let more = r#"
        (name: "mirror", draw: FullScreen("reinhard"), sample: {"source": Eye(Right, "color")}, color: ["mirror"]),
        (name: "cross", draw: FullScreen("reinhard"), sample: {"source": Eye(Left, "color")}, color: ["screen"]),"#;
    for frame in fall_apart(ALL, images, more, &[]) {
        assert_eq!(passes(&frame), ["noise", "opaque", "show", "mirror", "cross"]);
        let eye = |name| pass(&frame, name).sampled[0].eye;
        assert_eq!((eye("show"), eye("mirror"), eye("cross")), (None, Some(Eye::Right), Some(Eye::Left)));
        assert_eq!(pass(&frame, "mirror").view.0, 0);
    }
}

#[test]
fn what_is_off_takes_nothing_apart() {
    let off = r#"(name: "record", when: "on", custom: "it", writes: ["color"]),"#;
    fall_apart(ALL, "", off, &[]);
}

#[test]
fn in_halves_shaders_ask_which_half_is_theirs_and_in_layers_they_need_not() {
    let text = pipeline("", "").replace("FullScreen(\"reinhard\")", "FullScreen(\"deaf\")");
    for stereo in IN_HALVES {
        let said = wrong(&text, &drawn(*stereo));
        let expected = "shader `deaf` samples `source` and doesn't ask which half of `color` is its eye's";
        assert!(said.contains(expected) && said.contains("test.ron:17:77"), "{said}");
        assert_eq!(said.matches("which half").count(), 1, "{said}");
    }
    for stereo in [Stereo::Off, Stereo::MultiPass, Stereo::Multiview] {
        assert!(frame(&text, &drawn(stereo)).is_ok(), "{stereo:?}");
    }
    // A pass for one eye after the other that samples half of an image for both must ask as well; it is told once.
    let apart = r#"(name: "record", custom: "it", writes: ["own"]),
        (name: "paint", draw: FullScreen("deaf"), sample: {"source": "color"}, color: ["own"]),"#;
    let said = wrong(&pipeline(OWN, apart), &drawn(Stereo::DoubleWide));
    assert!(said.contains("test.ron:19:70"), "{said}");
    assert_eq!(said.matches("which half").count(), 1, "{said}");
    // The shared noise, sampled the same way, is whole.
    let shared = text.replace("{\"source\": \"color\"}", "{\"source\": \"noise\"}");
    for stereo in Stereo::ALL {
        assert!(frame(&shared, &drawn(stereo)).is_ok(), "{stereo:?}");
    }
}

/// ST-2: HLSL includes other files than GLSL, and WGSL none.
#[test]
fn st_2_a_shader_that_misses_its_half_is_told_what_its_language_has_for_that() {
    let helps = [
        ("deaf", "include `include/texture.glsl` and look it up by `found_in(source, source_st, uv)`"),
        (
            "deaf.hlsl:main",
            "`include/part.hlsl` and look it up by `uv_clamp(uv_adjust(uv, source_st), source_st, size)`, where",
        ),
        (
            "deaf.slang:main",
            "`include/part.hlsl` and look it up by `uv_clamp(uv_adjust(uv, source_st), source_st, size)`, where",
        ),
        ("deaf.wgsl:main", "WGSL isn't told of halves: draw in a mode with layers, or by `multi-pass`"),
    ];
    for (shader, help) in helps {
        let text = pipeline("", "").replace("FullScreen(\"reinhard\")", &format!("FullScreen(\"{shader}\")"));
        let said = wrong(&text, &drawn(Stereo::DoubleWide));
        assert!(said.contains(help), "{said}");
    }
}

/// ST-9: the same of a shader that reads where its fragments lie.
#[test]
fn st_9_a_shader_that_reads_raw_positions_is_told_what_its_language_has_for_that() {
    let halves = "isn't told of halves: draw in a mode with layers, or by `multi-pass`";
    let told = [
        (
            "raw",
            "reads `gl_FragCoord` without `frag_coord()`",
            "`frag_coord()` of `include/rotation.glsl` is the place",
        ),
        (
            "raw.hlsl:main",
            "reads `SV_Position` without `frag_coord(position)`",
            "`frag_coord(position)` of `include/rotation.hlsl` is",
        ),
        (
            "raw.slang:main",
            "reads `SV_Position` without `frag_coord(position)`",
            "`frag_coord(position)` of `include/rotation.hlsl` is",
        ),
        ("raw.spv", "reads `FragCoord`", halves),
        ("raw.wgsl:main", "reads `@builtin(position)`", halves),
    ];
    for (shader, message, help) in told {
        let text = pipeline("", "").replace("FullScreen(\"reinhard\")", &format!("FullScreen(\"{shader}\")"));
        let said = wrong(&text, &drawn(Stereo::DoubleWide));
        assert!(said.contains(&format!("shader `{shader}` {message}")) && said.contains(help), "{said}");
        assert!(frame(&text, &drawn(Stereo::Multiview)).is_ok(), "{shader}");
    }
}

/// Draws are recorded for each half, with its viewport and scissor; instances are cut by a clip distance, and in layers by nothing.
#[test]
fn double_wide_takes_nothing_of_a_device_and_instances_a_layer_or_a_clip_distance() {
    let device = |vertex_layer, max_clip_distances| Profile { vertex_layer, max_clip_distances, ..saved() };
    for clip_distances in [None, Some(0), Some(1), Some(8)] {
        assert_eq!(Stereo::DoubleWide.lacks(&device(false, clip_distances)), None);
        assert_eq!(Stereo::Instanced.lacks(&device(true, clip_distances)), None);
        let lacks = Stereo::Instanced.lacks(&device(false, clip_distances));
        let expected = match clip_distances {
            None => {
                Some("its profile doesn't say that vertex shaders can choose the layer, nor how many clip distances")
            }
            Some(0) => Some("its vertex shaders can't choose the layer and have no clip distance"),
            Some(_) => None,
        };
        let begins = expected.is_some_and(|expected| lacks.as_deref().is_some_and(|lacks| lacks.starts_with(expected)));
        assert_eq!((lacks.is_some(), begins), (expected.is_some(), expected.is_some()), "{lacks:?}");
    }
}
