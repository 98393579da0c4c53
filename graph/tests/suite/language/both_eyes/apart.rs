//! What is drawn for one eye after the other, and why (ST-2, ST-4).

use super::{ALL, IN_HALVES, OWN, drawn, fall_apart, pass, passes, pipeline, remarks, saved};
use crate::testing::pipelines::right;
use framewright_graph::device::Profile;
use framewright_graph::expand::Inputs;
use framewright_graph::frame::{Eye, Stereo};

#[test]
fn what_a_compute_shader_writes_is_made_for_one_eye_after_the_other() {
    let image = r#"(name: "own", format: R16G16B16A16_SFLOAT, size: Like("color")),"#;
    let write = r#"(name: "write", dispatch: "halve", groups: Texels("own"), sample: {"source": "color"},
                    storage: {"target": "own"}, side_effect: true),"#;
    let why = "`write` uses it otherwise than by sampling or drawing";
    for frame in fall_apart(IN_HALVES, image, write, &[("own", why)]) {
        assert_eq!(passes(&frame), ["noise", "opaque", "show", "write (left)", "write (right)"]);
        // It samples the part of its eye of what is one for both.
        for (name, eye, view) in [("write (left)", Eye::Left, 1), ("write (right)", Eye::Right, 2)] {
            let write = pass(&frame, name);
            assert_eq!((write.sampled[0].eye, write.view.0), (Some(eye), view), "{name}");
            let target = &frame.images[write.storage[0].image.0 as usize].name;
            assert_eq!(*target, eye.named("own"));
        }
    }
    // In layers the image stays one for both, and each eye's pass writes its layer.
    for frame in fall_apart(&[Stereo::Multiview], image, write, &[]) {
        assert_eq!(passes(&frame), ["noise", "opaque", "show", "write (left)", "write (right)"]);
        let [left, right] = ["write (left)", "write (right)"].map(|name| &pass(&frame, name).storage[0]);
        assert_eq!((left.image, left.eye, right.eye), (right.image, Some(Eye::Left), Some(Eye::Right)));
        assert_eq!((left.write, left.read), (true, false));
        assert_eq!((right.write, right.read), (true, true), "the left eye's layer is kept");
    }
}

#[test]
fn what_is_drawn_from_what_a_compute_shader_writes_is_drawn_for_both_eyes_at_once_in_layers() {
    let images = r#"(name: "own", format: R16G16B16A16_SFLOAT, size: Like("color")),
                    (name: "second", format: Color(hdr: true), size: Like("color")),"#;
    let more = r#"(name: "write", dispatch: "halve", groups: Texels("own"), sample: {"source": "color"},
                   storage: {"target": (image: "own", access: Write)}),
                  (name: "from", draw: FullScreen("reinhard"), sample: {"source": "own"}, color: ["second"], side_effect: true),"#;
    for frame in fall_apart(&[Stereo::Multiview], images, more, &[]) {
        assert_eq!(passes(&frame), ["noise", "opaque", "show", "write (left)", "write (right)", "from"]);
        assert_eq!(pass(&frame, "from").sampled[0].eye, None, "each eye's part");
    }
}

#[test]
fn what_a_compute_shader_replaces_while_it_samples_it_is_there_for_each_eye() {
    let image = r#"(name: "own", format: R16G16B16A16_SFLOAT, size: Like("color")),"#;
    let more = r#"(name: "clear", fill: (to: "own", value: (0.0, 0.0, 0.0, 0.0))),
                  (name: "write", dispatch: "halve", groups: Texels("own"), sample: {"source": "own"},
                   storage: {"target": (image: "own", access: Write)}, side_effect: true),"#;
    let why = "`write` uses it otherwise than by sampling or drawing";
    fall_apart(ALL, image, more, &[("own", why)]);
}

#[test]
fn what_is_blitted_is_there_for_each_eye() {
    let blit = r#"(name: "shrink", blit: (from: "color", to: "own")),"#;
    let [reads, scales] =
        [("color", "`shrink` uses it otherwise than by sampling or drawing"), ("own", "`shrink` scales by a blit")];
    // A pass that samples `color` beside it draws for one eye, too.
    let shown = ("screen", "`show` draws it for one eye after the other, as it does with `color`");
    for frame in fall_apart(ALL, OWN, blit, &[reads, shown, scales]) {
        let expected = ["opaque", "show", "shrink"].map(|it| [Eye::Left, Eye::Right].map(|eye| eye.named(it)));
        let expected: Vec<_> = std::iter::once("noise".into()).chain(expected.concat()).collect();
        assert_eq!(passes(&frame), expected.iter().map(|it: &std::sync::Arc<str>| &**it).collect::<Vec<_>>());
        let outputs: Vec<_> = frame.outputs.iter().map(|output| output.eye).collect();
        assert_eq!(outputs, [Some(Eye::Left), Some(Eye::Right), None], "what is apart leaves the frame twice");
    }
}

#[test]
fn what_is_copied_from_or_to_a_buffer_is_there_for_each_eye() {
    let upload = r#"(name: "upload", copy: (from: "rows", to: "own")),"#;
    let upload =
        [upload, r#"(name: "mix", draw: FullScreen("reinhard"), sample: {"source": "own"}, color: ["screen"]),"#];
    let why = ("own", "`upload` uses it otherwise than by sampling or drawing");
    let mixed = ("screen", "`mix` draws it for one eye after the other, as it does with `own`");
    for frame in fall_apart(ALL, OWN, &upload.concat(), &[mixed, why]) {
        // Other images that `screen` is drawn from stay one for both: each eye samples its part.
        assert!(passes(&frame).starts_with(&["noise", "opaque", "show (left)", "show (right)", "upload (left)"]));
        assert_eq!(pass(&frame, "show (right)").sampled[0].eye, Some(Eye::Right));
    }
    let read_back = r#"(name: "read", copy: (from: Eye(Left, "own"), to: "rows")),"#;
    let drawn = r#"(name: "paint", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["own"]),"#;
    let why = "`read` uses it otherwise than by sampling or drawing";
    for frame in fall_apart(ALL, OWN, &[drawn, read_back].concat(), &[("own", why)]) {
        assert_eq!(passes(&frame)[3..], ["paint (left)", "paint (right)", "read"]);
    }
}

#[test]
fn whole_images_are_copied_and_filled_for_both_eyes_at_once() {
    let more = r#"(name: "fill", fill: (to: "own", value: (0.0, 0.0, 0.0, 0.0))), (name: "copy", copy: (from: "color", to: "own")),"#;
    for frame in fall_apart(ALL, OWN, more, &[]) {
        assert_eq!(passes(&frame), ["noise", "opaque", "show", "fill", "copy"]);
    }
    let one = r#"(name: "fill", fill: (to: "own", value: (0.0, 0.0, 0.0, 0.0))),
                 (name: "copy", copy: (from: Eye(Left, "color"), to: "own")),"#;
    let why = "`copy` uses it otherwise than by sampling or drawing";
    let show = "`show` draws it for one eye after the other, as it does with `color`";
    fall_apart(ALL, OWN, one, &[("color", why), ("screen", show), ("own", why)]);
}

#[test]
fn what_is_copied_from_images_apart_or_from_what_both_share_is_there_for_each_eye() {
    let images = r#"(name: "own", format: R16G16B16A16_SFLOAT, size: Like("color")),
                    (name: "second", format: R16G16B16A16_SFLOAT, size: Like("color")),"#;
    let more = r#"(name: "write", dispatch: "halve", groups: Texels("own"), sample: {"source": "color"},
                   storage: {"target": "own"}),
                  (name: "copy", copy: (from: "own", to: "second"), side_effect: true),"#;
    let write = ("own", "`write` uses it otherwise than by sampling or drawing");
    let copied = ("second", "`copy` draws it for one eye after the other, as it does with `own`");
    for frame in fall_apart(IN_HALVES, images, more, &[write, copied]) {
        assert_eq!(passes(&frame)[5..], ["copy (left)", "copy (right)"]);
    }
    for frame in fall_apart(&[Stereo::Multiview], images, more, &[]) {
        assert_eq!(passes(&frame)[3..], ["write (left)", "write (right)", "copy"]);
    }
    let shared = r#"(name: "copy", copy: (from: "noise", to: "own"), side_effect: true),"#;
    for frame in fall_apart(ALL, OWN, shared, &[("own", "`copy` copies to it what both eyes share")]) {
        assert_eq!(passes(&frame)[3..], ["copy (left)", "copy (right)"]);
    }
}

#[test]
fn what_a_draw_reads_as_storage_has_it_drawn_for_each_eye() {
    let image = r#"(name: "own", format: R16G16B16A16_SFLOAT, size: Like("color")),"#;
    let more = r#"(name: "paint", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["own"]),
                  (name: "look", draw: FullScreen("look_up"), storage: {"texels": (image: "own", access: Read)},
                   color: ["screen"]),"#;
    let own = ("own", "`look` uses it otherwise than by sampling or drawing");
    let screen = ("screen", "`look` draws it for one eye after the other, as it does with `own`");
    for frame in fall_apart(ALL, image, more, &[screen, own]) {
        let looks = ["look (left)", "look (right)"].map(|name| pass(&frame, name).storage[0].image);
        assert_ne!(looks[0], looks[1], "each eye reads its own");
    }
}

#[test]
fn what_the_program_records_is_recorded_for_each_eye() {
    let more = r#"(name: "outside", custom: "it", reads: ["color"], writes: ["own"]),"#;
    let [read, written] = [
        ("color", "`outside` uses it otherwise than by sampling or drawing"),
        ("own", "`outside` is recorded by the program"),
    ];
    let shown = ("screen", "`show` draws it for one eye after the other, as it does with `color`");
    for frame in fall_apart(ALL, OWN, more, &[read, shown, written]) {
        assert_eq!(passes(&frame)[5..], ["outside (left)", "outside (right)"]);
    }
    // An image that the pass only samples stays one for both.
    let more = r#"(name: "outside", custom: "it", sample: {"source": "color"}, writes: ["own"]),"#;
    for frame in fall_apart(ALL, OWN, more, &[written]) {
        assert_eq!(passes(&frame), ["noise", "opaque", "show", "outside (left)", "outside (right)"]);
        assert_eq!(pass(&frame, "outside (right)").sampled[0].eye, Some(Eye::Right));
    }
}

#[test]
fn what_is_drawn_for_one_eye_only_is_there_for_each() {
    let more = r#"
        (name: "paint", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["own"]),
        (name: "mark", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: [Eye(Left, "own")]),"#;
    for frame in fall_apart(ALL, OWN, more, &[("own", "`mark` writes one eye's")]) {
        assert_eq!(passes(&frame), ["noise", "opaque", "show", "paint (left)", "paint (right)", "mark"]);
        // A pass that draws for one eye reads that eye's images.
        let mark = pass(&frame, "mark");
        assert_eq!((mark.sampled[0].eye, mark.view.0), (Some(Eye::Left), 1));
        assert_eq!(&*frame.images[mark.color[0].image.0 as usize].name, "own (left)");
    }
}

#[test]
fn what_is_not_a_flat_image_of_one_layer_and_in_halves_of_one_mip_level_is_there_for_each_eye() {
    let cases = [
        (r#"mips: Full"#, "it has mip levels"),
        (r#"mips: 2"#, "it has mip levels"),
        (r#"layers: 2"#, "it has layers of its own"),
        (r#"layers: Like("color")"#, "it has layers of its own"),
    ];
    for (what, why) in cases {
        let image = format!(r#"(name: "own", format: Color(hdr: true), size: Like("color"), {what}),"#);
        let target = if what.starts_with("layers: 2") || what.starts_with("mips") {
            r#"(image: "own", mip: 0, layer: 0)"#
        } else {
            r#""own""#
        };
        let paint = format!(r#"(name: "paint", draw: FullScreen("plain"), color: [{target}]),"#);
        let has_mips = what.starts_with("mips");
        for frame in fall_apart(if has_mips { IN_HALVES } else { ALL }, &image, &paint, &[("own", why)]) {
            assert_eq!(passes(&frame)[3..], ["paint (left)", "paint (right)"], "{what}");
        }
        if has_mips {
            let frame = &fall_apart(&[Stereo::Multiview], &image, &paint, &[])[0];
            assert_eq!(passes(frame)[3..], ["paint"], "{what}: each layer has its levels");
        }
    }
    let deep = r#"(name: "own", format: Color(hdr: true), size: Fixed(8, 8), shape: D3(8), per_eye: true),"#;
    let fog =
        r#"(name: "fog", dispatch: "fog", groups: Texels("own"), storage: {"target": "own"}, side_effect: true),"#;
    fall_apart(ALL, deep, fog, &[("own", "it isn't flat")]);
    let one = r#"(name: "own", format: Color(hdr: true), size: Like("color"), layers: 1, mips: 1),"#;
    fall_apart(ALL, one, r#"(name: "paint", draw: FullScreen("plain"), color: ["own"]),"#, &[]);
}

#[test]
fn what_a_buffer_counts_is_drawn_for_each_eye_unless_the_device_draws_both_views() {
    let more = r#"(name: "points", draw: Indirect("counts"), shader: "pulled", storage: {"particles": (buffer: "rows", access: Read)}, color: ["own"]),"#;
    let clear = r#"(name: "clear", fill: (to: "own", value: (0.0, 0.0, 0.0, 0.0))),"#;
    let more = [clear, more].concat();
    let why = "`points` draws the instances that a buffer says";
    for frame in fall_apart(IN_HALVES, OWN, &more, &[("own", why)]) {
        assert_eq!(passes(&frame)[5..], ["points (left)", "points (right)"]);
    }
    for frame in fall_apart(&[Stereo::Multiview], OWN, &more, &[]) {
        assert_eq!(passes(&frame)[4..], ["points"]);
    }
    // Where instances are drawn into layers they are counted as well.
    let device = Profile { vertex_layer: true, ..saved() };
    let frame = right(&pipeline(OWN, &more), &Inputs { device: Some(&device), ..drawn(Stereo::Instanced) });
    assert_eq!(remarks(&frame)[0].2, format!("is drawn for one eye after the other: {why}"));
}

#[test]
fn what_is_read_beyond_its_edges_is_there_for_each_eye_where_both_would_lie_side_by_side() {
    for (word, wraps) in [("Repeat", true), ("Mirror", true), ("Clamp", false)] {
        let more = format!(
            r#"(name: "paint", draw: FullScreen("reinhard"), sample: {{"source": (image: "color", address: {word})}}, color: ["own"]),"#
        );
        let apart = [
            ("color", "`paint` reads beyond its edges"),
            ("screen", "`show` draws it for one eye after the other, as it does with `color`"),
            ("own", "`paint` draws it for one eye after the other, as it does with `color`"),
        ];
        fall_apart(IN_HALVES, OWN, &more, if wraps { &apart } else { &[] });
        fall_apart(&[Stereo::Multiview], OWN, &more, &[]);
    }
    // Of what both eyes share it changes nothing.
    let more = r#"(name: "paint", draw: FullScreen("reinhard"), sample: {"source": (image: "noise", address: Repeat)}, color: ["own"]),"#;
    fall_apart(ALL, OWN, more, &[]);
}
