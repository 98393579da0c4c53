//! What stands out in a Plan (LV-4): each hint is about what the Plan does, with its bytes and its line.

use crate::testing::pipelines::{INPUTS, right, shipped};
use crate::testing::plans::compiled;
use framewright_graph::hints::{Hint, HintKind, hints};
use framewright_graph::plan::{Plan, Resource};

/// A pipeline that draws `big` at some size, shows a part of it at another, and shows that.
fn pipeline(big: u32, half: u32) -> Plan {
    let text = format!(
        r#"Pipeline(version: 1, images: [
            (name: "big", format: R16G16B16A16_SFLOAT, size: Fixed({big}, {big})),
            (name: "again", format: R16G16B16A16_SFLOAT, size: Fixed({half}, {half})),
            (name: "half", format: R16G16B16A16_SFLOAT, size: Fixed({half}, {half})),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [
            (name: "draw", draw: FullScreen("sky"), color: ["big"]),
            (name: "shrink", draw: FullScreen("downsample"), sample: {{"source": "big"}}, color: ["half"]),
            (name: "copy", draw: FullScreen("downsample"), sample: {{"source": "half"}}, color: ["again"]),
            (name: "show", draw: FullScreen("tone_map"), sample: {{"source": "again"}}, params: {{"exposure": 1.0, "white_point": 1.0}},
             color: ["screen"])], outputs: ["screen"])"#
    );
    compiled(&right(&text, &INPUTS))
}

fn of_kind(plan: &Plan, kind: HintKind) -> Vec<Hint> {
    hints(plan).into_iter().filter(|hint| hint.kind == kind).collect()
}

#[test]
fn lv_4_an_image_that_is_only_shown_smaller_stands_out() {
    let found = of_kind(&pipeline(1024, 512), HintKind::ShownSmaller);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0].text, "`big` has 1024×1024 texels, and is read by passes that draw 512×512 or less");
    assert_eq!((found[0].code, found[0].bytes), ("H03", 1024 * 1024 * 8));
    assert!(found[0].at.is_some(), "its line");
    assert_eq!(of_kind(&pipeline(1024, 1024), HintKind::ShownSmaller), []);
}

#[test]
fn lv_4_an_image_that_one_pass_reads_stands_out_with_that_pass() {
    let found = of_kind(&pipeline(2048, 2048), HintKind::OneReader);
    let mut texts: Vec<&str> = found.iter().map(|hint| &*hint.text).collect();
    texts.sort_unstable();
    assert_eq!(
        texts,
        [
            "`again` is stored for one reader, `show`",
            "`big` is stored for one reader, `shrink`",
            "`half` is stored for one reader, `copy`"
        ]
    );
}

#[test]
fn lv_4_an_image_that_several_passes_read_does_not_stand_out_for_one() {
    let text = r#"Pipeline(version: 1, images: [
            (name: "big", format: R16G16B16A16_SFLOAT, size: Fixed(2048, 2048)),
            (name: "half", format: R16G16B16A16_SFLOAT, size: Fixed(1024, 1024)),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [
            (name: "draw", draw: FullScreen("sky"), color: ["big"]),
            (name: "shrink", draw: FullScreen("downsample"), sample: {"source": "big"}, color: ["half"]),
            (name: "show", draw: FullScreen("tone_map"), sample: {"source": "big"}, params: {"exposure": 1.0, "white_point": 1.0},
             color: ["screen"])], outputs: ["screen", "half"])"#;
    assert_eq!(of_kind(&compiled(&right(text, &INPUTS)), HintKind::OneReader), []);
}

#[test]
fn lv_4_what_takes_half_of_the_memory_stands_out() {
    let found = of_kind(&pipeline(2048, 512), HintKind::LargestShare);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!((&*found[0].text, found[0].bytes), ("`big` is 32.0 MiB of 36.0 MiB of transient memory", 32 << 20));
    assert_eq!(of_kind(&pipeline(512, 512), HintKind::LargestShare), []);
}

#[test]
fn lv_4_hints_say_what_the_plan_says() {
    for name in ["forward.ron", "auto_exposure.ron"] {
        let plan = compiled(&right(&shipped(name), &INPUTS));
        let moved = plan.moved().sum();
        let found = hints(&plan);
        assert!(found.is_sorted_by(|one, other| one.bytes >= other.bytes), "{name}: the most bytes first");
        for hint in found {
            let named = hint.text.split('`').nth(1).expect("a name");
            let resources = (0..).map(framewright_graph::plan::ImageId).take(plan.images.len()).map(Resource::Image);
            let is_image = resources.into_iter().any(|image| plan.resource_name(image) == named);
            assert!(is_image || hint.kind == HintKind::ResolvedApart, "{name}: {hint:?}");
            assert!(hint.bytes <= moved.max(plan.totals.transient_bytes), "{name}: {hint:?}");
        }
    }
}

#[test]
fn lv_4_what_is_stored_and_loaded_again_at_once_stands_out() {
    let text = r#"Pipeline(version: 1, images: [
            (name: "big", format: R16G16B16A16_SFLOAT, size: Fixed(512, 512)),
            (name: "depth", format: D32_SFLOAT, size: Like("big")),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output)],
         passes: [
            (name: "before", draw: Objects(Opaque), shader: "lit", color: [(image: "big", clear: (0, 0, 0, 1))], depth: (image: "depth", clear: 0.0)),
            (name: "light", draw: FullScreen("downsample"), sample: {"source": "depth"}, color: ["big"]),
            (name: "over", draw: Objects(Opaque), shader: "lit", color: ["big"], depth: "depth"),
            (name: "show", draw: FullScreen("tone_map"), sample: {"source": "big"}, params: {"exposure": 1.0, "white_point": 1.0},
             color: ["screen"])], outputs: ["screen"])"#;
    let found = of_kind(&compiled(&right(text, &INPUTS)), HintKind::LoadedAgain);
    let said = "`big` is stored by the scope of `light`, and loaded again by the next one, of `over`";
    assert!(found.iter().any(|hint| hint.text == said && hint.bytes == 2 * 512 * 512 * 8), "{found:#?}");
}
