//! What the program records for both eyes at once, where it says so (DO-12).

use super::{ALL, OWN, drawn, fall_apart, pass, passes, pipeline};
use crate::testing::pipelines::{right, wrong};
use crate::testing::plans::compiled;
use framewright_graph::frame::Stereo;
use framewright_graph::verify::verify;

/// Outside of a rendering scope by transfer and by shaders of the program's own, and within one.
const AT_ONCE: &str = r#"
    (name: "move", custom: "it", both_eyes: true, reads: ["color"], writes: ["own"]),
    (name: "store", custom: "it", both_eyes: true, sample: {"source": "color"}, storage: {"target": (image: "own", access: ReadWrite)},
        uses: [(image: "own", stages: [COMPUTE_SHADER], accesses: [SHADER_STORAGE_READ, SHADER_STORAGE_WRITE], layout: GENERAL)]),
    (name: "inside", custom: "it", both_eyes: true, sample: {"source": "own"}, color: ["screen"]),"#;

#[test]
fn do_12_what_the_program_records_for_both_eyes_at_once_runs_once() {
    for frame in fall_apart(ALL, OWN, AT_ONCE, &[]) {
        assert_eq!(passes(&frame)[3..], ["move", "store", "inside"], "{:?}", frame.stereo);
        assert!(frame.images.iter().filter(|image| &*image.name != "noise").all(|image| image.eyes.is_some()));
        let plan = compiled(&frame);
        assert_eq!(verify(&plan), [], "{}", plan.tree());
        for name in ["move", "store", "inside"] {
            assert!(pass(&frame, name).both_eyes && pass(&frame, name).view.0 == 0, "{name}: the view between both");
            let planned = plan.steps.iter().flat_map(|step| step.work.passes()).find(|it| *it.name == *name);
            let planned = planned.unwrap_or_else(|| panic!("no `{name}`: {}", plan.tree()));
            assert!(planned.both_eyes && plan.both_eyes(planned).is_some(), "{}", plan.tree());
        }
        assert_eq!(plan.tree().matches("shader `it`, for both eyes at once").count(), 3, "{}", plan.tree());
    }
}

#[test]
fn do_12_where_nothing_holds_both_eyes_parts_it_runs_as_it_does_elsewhere() {
    let text = pipeline(OWN, AT_ONCE);
    for stereo in [Stereo::Off, Stereo::MultiPass] {
        let frame = right(&text, &drawn(stereo));
        assert!(frame.passes.iter().all(|pass| !pass.both_eyes), "{stereo:?}");
        let silent = right(&text.replace("both_eyes: true, ", ""), &drawn(stereo));
        assert_eq!(passes(&frame), passes(&silent), "{stereo:?}");
        assert_eq!(compiled(&frame).tree(), compiled(&silent).tree(), "{stereo:?}");
    }
    // What no eye has of its own isn't recorded for either.
    let shared = r#"(name: "shared", custom: "it", both_eyes: true, writes: ["noise"]),"#;
    for stereo in ALL {
        let frame = right(&pipeline("", shared), &drawn(*stereo));
        assert!(!pass(&frame, "shared").both_eyes, "{stereo:?}");
    }
}

#[test]
fn do_12_what_cannot_hold_both_eyes_parts_is_recorded_for_one_eye_after_the_other() {
    let levels = r#"(name: "own", format: Color(hdr: true), size: Like("color"), layers: 2),"#;
    let more = r#"(name: "move", custom: "it", both_eyes: true, writes: ["own"]),"#;
    for frame in fall_apart(ALL, levels, more, &[("own", "it has layers of its own")]) {
        assert_eq!(passes(&frame)[3..], ["move (left)", "move (right)"]);
        assert!(frame.passes.iter().all(|pass| !pass.both_eyes));
    }
    // What such a pass reads, and what one eye alone writes beside it, is there for each eye too.
    let beside = |name: &str| format!("`{name}` draws it for one eye after the other, as it does with `own`");
    let show = "`show` draws it for one eye after the other, as it does with `color`";
    let own = ("own", "it has layers of its own");
    for (name, more) in [
        (
            "move",
            r#"(name: "move", custom: "it", both_eyes: true, reads: ["color"], writes: ["own"], side_effect: true),"#,
        ),
        (
            "store",
            r#"(name: "store", custom: "it", both_eyes: true, side_effect: true,
            storage: {"a": (image: "color", access: Read), "b": (image: "own", layer: 0, access: Write)}),"#,
        ),
        ("copy", r#"(name: "copy", copy: (from: "color", to: (image: "own", layer: 0)), side_effect: true),"#),
    ] {
        for frame in fall_apart(ALL, levels, more, &[("color", &beside(name)), ("screen", show), own]) {
            assert_eq!(verify(&compiled(&frame)), [], "{name}");
        }
    }
    let left = r#"(name: "left", custom: "it", both_eyes: true, storage: {"a": (image: Eye(Left, "own"), access: Write)}, reads: ["color"],
        side_effect: true),"#;
    let by_texels = "`left` uses it otherwise than by sampling or drawing";
    for frame in fall_apart(ALL, OWN, left, &[("color", by_texels), ("screen", show), ("own", by_texels)]) {
        assert_eq!(verify(&compiled(&frame)), []);
    }
    // One eye's, moved or stored, is no part of both.
    let why = "`move` uses it otherwise than by sampling or drawing";
    for more in [
        r#"(name: "move", custom: "it", both_eyes: true, reads: [Eye(Left, "color")], side_effect: true),"#,
        r#"(name: "move", custom: "it", both_eyes: true, storage: {"x": (image: Eye(Left, "color"), access: Read)}, side_effect: true),"#,
    ] {
        fall_apart(ALL, "", more, &[("color", why), ("screen", show)]);
    }
    // Within a rendering scope nothing is stored for both.
    let stores = r#"(name: "store", custom: "it", both_eyes: true, storage: {"x": (image: "color", access: Read)}, color: ["own"]),"#;
    let more = [r#"(name: "clear", fill: (to: "own", value: (0.0, 0.0, 0.0, 0.0))),"#, stores].concat();
    let color = ("color", "`store` uses it otherwise than by sampling or drawing");
    let own = ("own", "`store` draws it for one eye after the other, as it does with `color`");
    fall_apart(ALL, OWN, &more, &[color, ("screen", show), own]);
}

#[test]
fn do_12_other_work_than_the_programs_is_never_said_to_be_for_both_eyes() {
    let more = r#"(name: "look", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["screen"], both_eyes: true),"#;
    let said = wrong(&pipeline("", more), &drawn(Stereo::Off));
    assert!(said.contains("pass `look` has `both_eyes`, which means nothing beside `draw`"), "{said}");
}
