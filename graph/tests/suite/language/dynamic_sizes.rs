//! Sizes that change from frame to frame, and the Plans that come of them.

use crate::testing::pipelines::{INPUTS, right, set};
use crate::testing::plans::{on, shipped};
use framewright_graph::base::render;
use framewright_graph::compile::{Compiler, Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::Frame;
use framewright_graph::plan::{Plan, Role, Work};
use framewright_graph::vulkan::{Accesses, Layout, Stages, State};
use std::sync::Arc;

fn device() -> Arc<Profile> {
    Arc::new(shipped("amd-rx-7800-xt"))
}

/// A frame whose picture is forwarded at its own size and scaled to the screen's.
fn frame(scale: &str, more: &str) -> Frame {
    let text = format!(
        r#"Pipeline(
            version: 1,
            settings: [
                (name: "scale", value: Number(default: 1.0, min: 0.1, max: 2.0)),
                (name: "exposure", value: Number(default: 1.0, min: 0.1, max: 2.0)),
                (name: "soft", value: Bool(default: false)),
            ],
            images: [
                (name: "color", format: Color(hdr: true), size: Dynamic(by: "scale", up_to: 2.0), samples: 4),
                (name: "depth", format: Depth, size: Like("color"), samples: 4, resolve: SampleZero),
                (name: "soft", format: Like("color"), size: Like("color")),
                (name: "toned", format: Output, size: Like("color")),
                (name: "screen", format: Output, size: Output),
            ],
            passes: [
                (name: "opaque", draw: Objects(Opaque), shader: "lit",
                    color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
                (name: "stripes", draw: FullScreen("depth_stripes"), sample: {{"depth": Resolved("depth")}},
                    params: {{"period": 1.0}}, color: [(image: "color", blend: Premultiplied)]),
                (name: "soften", when: "soft", draw: FullScreen("blur_tent"), sample: {{"source": "color"}},
                    color: ["soft"], otherwise: Forward(from: "color", to: "soft")),
                (name: "map", draw: FullScreen("tone_map"), sample: {{"source": "soft"}}, color: ["toned"],
                    params: {{"exposure": "exposure", "white_point": 2.0}}),
                (name: "show", draw: FullScreen("copy"), sample: {{"source": "toned"}}, color: ["screen"]),
            ],
            outputs: [{more} "screen"],
        )"#
    );
    let chosen = set(&[("scale", scale)]);
    right(&text, &Inputs { set: &chosen, output_extent: [64, 36], ..INPUTS })
}

fn planned(frame: &Frame) -> Plan {
    on(frame, &device()).expect("it compiles")
}

#[test]
fn whatever_part_is_in_use_a_plan_differs_in_values_alone_and_takes_the_same_memory() {
    let first = planned(&frame("1", ""));
    let mut compiler = Compiler::new();
    for scale in ["1", "0.1", "2", "0.5", "1.99", "1"] {
        let frame = Arc::new(frame(scale, ""));
        let plan = planned(&frame);
        assert_eq!(first.differs_beyond_values(&plan), None, "{scale}");
        assert_eq!(first.heaps, plan.heaps, "{scale}");
        let device = device();
        let followed = compiler.compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default());
        assert_eq!(followed.expect("it compiles"), &plan, "{scale}");
        let extents: Vec<_> = plan
            .steps
            .iter()
            .filter_map(|step| match &step.work {
                Work::Render(scope) => Some(scope.extent),
                _ => None,
            })
            .collect();
        let part = plan.images[0].extent;
        assert_eq!(extents.last(), Some(&[64, 36]));
        assert!(extents.iter().rev().skip(1).all(|extent| *extent == [part[0], part[1]]), "{extents:?}");
    }
}

#[test]
fn do_10_all_levels_are_those_of_the_greatest_factor_in_expressions_too() {
    let frame = |scale: &str| {
        let text = r#"Pipeline(
            version: 1,
            settings: [(name: "scale", value: Number(default: 1.0, min: 0.1, max: 1.0))],
            images: [
                (name: "chain", format: R8_UNORM, size: Dynamic(by: "scale", up_to: 1.0), mips: Full),
                (name: "screen", format: Output, size: Output),
            ],
            passes: [
                (name: "first", draw: FullScreen("plain"), color: [(image: "chain", mip: 0)]),
                (name: "down", repeat: ("i", "mips(chain) - 1"), draw: FullScreen("copy"),
                    sample: {"source": (image: "chain", mip: "i", filter: Nearest)}, color: [(image: "chain", mip: "i + 1")]),
                (name: "show", draw: FullScreen("copy"), sample: {"source": (image: "chain", mip: "mips(chain) - 1")}, color: ["screen"]),
            ],
            outputs: ["screen"],
        )"#;
        right(text, &Inputs { set: &set(&[("scale", scale)]), output_extent: [64, 36], ..INPUTS })
    };
    let whole = planned(&frame("1"));
    assert_eq!((whole.images[0].mips, frame("1").passes.len()), (7, 1 + 6 + 1));
    for scale in ["0.5", "0.1"] {
        assert_eq!(whole.differs_beyond_values(&planned(&frame(scale))), None, "{scale}");
    }
}

#[test]
fn a_part_is_two_texels_wide_and_high_at_least_where_there_is_room() {
    let text = r#"Pipeline(
        version: 1,
        images: [
            (name: "least", format: R8_UNORM, size: Dynamic(by: 0.01, up_to: 1.0)),
            (name: "row", format: R8_UNORM, size: Dynamic(by: 0.01, up_to: 0.04)),
            (name: "screen", format: Output, size: Output),
        ],
        passes: [
            (name: "fill", fill: (to: "least", value: 0)), (name: "fill_row", fill: (to: "row", value: 0)),
            (name: "sky", draw: Sky, color: [(image: "screen", clear: (0.0, 0.0, 0.0, 1.0))]),
        ],
        outputs: ["screen"],
    )"#;
    let images = right(text, &Inputs { output_extent: [64, 36], ..INPUTS }).images;
    let size = |at: usize| (images[at].extent, images[at].allocated);
    assert_eq!(size(0), ([2, 2, 1], Some([64, 36])));
    assert_eq!(size(1), ([2, 1, 1], Some([2, 1])), "there is room for no more");
}

#[test]
fn a_part_as_large_as_the_screen_is_no_image_of_the_screen() {
    // At this scale all sizes are the same: what would become one image otherwise stays two.
    let whole = planned(&frame("1", ""));
    assert!(whole.images.iter().filter(|image| image.extent == [64, 36, 1]).count() == whole.images.len());
    assert!(whole.images.iter().filter(|image| image.allocated.is_none()).count() == 1);
}

#[test]
fn other_rooms_samples_or_passes_are_more_than_values() {
    let first = planned(&frame("1", ""));
    let changed = |change: &dyn Fn(&mut Plan)| {
        let mut plan = first.clone();
        change(&mut plan);
        first.differs_beyond_values(&plan)
    };
    assert_eq!(changed(&|plan| plan.images[0].allocated = Some([130, 72])).as_deref(), Some("its images are others"));
    assert_eq!(changed(&|plan| plan.heaps[0].bytes += 1).as_deref(), Some("its memory is cut in another way"));
    assert_eq!(changed(&|plan| drop(plan.steps.pop())).map(|said| said.contains("steps, not")), Some(true));
    assert_eq!(changed(&|plan| drop(plan.outputs.pop())).as_deref(), Some("other outputs leave it"));
    let scope = |plan: &mut Plan, change: &dyn Fn(&mut framewright_graph::plan::RenderScope)| {
        let scopes = plan.steps.iter_mut().filter_map(|step| match &mut step.work {
            Work::Render(scope) => Some(scope),
            _ => None,
        });
        change(scopes.last().expect("a scope"));
    };
    // The screen's own size is none of the values.
    let larger = changed(&|plan| scope(plan, &|scope| scope.extent = [65, 36]));
    assert!(larger.is_some_and(|said| said.contains("does something else")));
    assert!(changed(&|plan| scope(plan, &|scope| scope.passes[0].shader = "other".into())).is_some());
    assert_eq!(changed(&|plan| scope(plan, &|scope| scope.attachments[0].because = "so".into())), None);
}

#[test]
fn what_changes_its_size_leaves_the_frame_but_is_shown_in_no_window_do_10() {
    let device = device();
    let plan = planned(&frame("0.5", "\"toned\","));
    let toned = plan.images.iter().find(|image| &*image.name == "toned").expect("it is an output");
    assert_eq!((toned.extent, toned.allocated), ([32, 18, 1], Some([128, 72])));
    let mut shown = frame("0.5", "\"toned\",");
    shown.outputs[0].after =
        Some(State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::PresentSrcKhr });
    let errors = compile(&shown, &device, &mut MemoryEstimate(&device), &Options::default()).expect_err("it can't be");
    let said = render(&shown.sources, &errors);
    assert!(said.contains("`toned` can't be shown in a window: its size may change from frame to frame"), "{said}");
    assert!(said.contains("E0627"), "{said}");
}

/// A pyramid with history, and its sizes in a Plan.
fn pyramid(scale: &str) -> Frame {
    let text = r#"Pipeline(
            version: 1,
            settings: [(name: "scale", value: Number(default: 0.5, min: 0.01, max: 1.0))],
            images: [
                (name: "chain", format: R16G16B16A16_SFLOAT, size: Dynamic(by: "scale", up_to: 1.0), mips: Full,
                    lifetime: History),
                (name: "screen", format: Output, size: Output),
            ],
            passes: [
                (name: "first", draw: FullScreen("plain"), color: [(image: "chain", mip: 0)]),
                (name: "level", repeat: ("i", 6), draw: FullScreen("downsample"), color: [(image: "chain", mip: "i + 1")],
                    sample: {"source": (image: "chain", mip: "i")}),
                (name: "show", draw: FullScreen("downsample"), sample: {"source": (image: "chain", mip: 0, previous: 1)},
                    color: ["screen"]),
            ],
            outputs: ["screen"],
        )"#;
    let chosen = set(&[("scale", scale)]);
    right(text, &Inputs { set: &chosen, output_extent: [64, 36], ..INPUTS })
}

#[test]
fn levels_are_used_half_as_far_each_and_as_far_as_a_filter_needs_do_10() {
    let extents = |scale: &str| {
        let plan = planned(&pyramid(scale));
        assert_eq!(plan.images.iter().filter(|image| image.mips == 7).count(), 2, "this frame's, and the one before");
        let scopes = plan.steps.iter().filter_map(|step| match &step.work {
            Work::Render(scope) if plan.image(scope.attachments[0].image).allocated.is_some() => Some(scope.extent),
            _ => None,
        });
        scopes.collect::<Vec<_>>()
    };
    assert_eq!(extents("1"), [[64, 36], [32, 18], [16, 9], [8, 4], [4, 2], [2, 1], [1, 1]]);
    assert_eq!(extents("0.3"), [[19, 10], [9, 5], [4, 2], [2, 2], [2, 2], [2, 1], [1, 1]]);
    assert_eq!(extents("0.01"), [[2, 2], [2, 2], [2, 2], [2, 2], [2, 2], [2, 1], [1, 1]]);
    let first = planned(&pyramid("1"));
    for scale in ["0.3", "0.01", "0.77"] {
        let other = planned(&pyramid(scale));
        assert_eq!(first.differs_beyond_values(&other), None, "{scale}");
        assert_eq!(first.heaps, other.heaps, "{scale}");
        assert!(framewright_graph::verify::verify(&other).is_empty(), "{scale}");
    }
}

#[test]
fn what_an_earlier_frame_left_at_its_size_is_drawn_and_not_copied_do_10() {
    let refused = |pass: &str| {
        let text = format!(
            r#"Pipeline(
                version: 1,
                images: [
                    (name: "color", format: R8G8B8A8_UNORM, size: Dynamic(by: 0.5, up_to: 1.0), lifetime: History),
                    (name: "target", format: R8G8B8A8_UNORM, size: Like("color")),
                ],
                passes: [
                    (name: "draw", draw: FullScreen("plain"), color: ["color"]),
                    (name: "keep", {pass}),
                ],
                outputs: ["target"],
            )"#
        );
        crate::testing::pipelines::wrong(&text, &Inputs { output_extent: [64, 36], ..INPUTS })
    };
    for pass in [
        r#"copy: (from: (image: "color", previous: 1), to: "target")"#,
        r#"blit: (from: (image: "color", previous: 1), to: "target", filter: Nearest)"#,
    ] {
        let said = refused(pass);
        assert!(said.contains("E0626") && said.contains("may have had another size in that frame"), "{said}");
    }
    let own = r#"draw: FullScreen("downsample"), color: ["target"],
        sample: {"source": (image: "color", previous: 1, own_pixel: true)}"#;
    assert!(refused(own).contains("can't be read at the fragment's own position"));
}

/// The checker finds out by itself what is wrong with images that are used in part.
#[test]
fn verify_finds_parts_that_nobody_is_told_of_do_10() {
    let broken = |change: &dyn Fn(&mut Plan)| {
        let mut plan = planned(&pyramid("0.3"));
        change(&mut plan);
        framewright_graph::verify::verify(&plan).iter().map(ToString::to_string).collect::<String>()
    };
    assert_eq!(broken(&|_| ()), "");
    let scope = |plan: &mut Plan, extent: [u32; 2]| {
        let mut scopes = plan.steps.iter_mut().filter_map(|step| match &mut step.work {
            Work::Render(scope) if scope.extent == [2, 2] => Some(scope),
            _ => None,
        });
        scopes.next().expect("a small level").extent = extent;
    };
    assert!(broken(&|plan| scope(plan, [2, 1])).contains("has another size than its scope"));
    let alone = broken(&|plan| {
        for image in &mut plan.images {
            if let (Role::Persistent { becomes, .. }, Some(_)) = (&mut image.role, image.allocated) {
                *becomes = image.id.0;
            }
        }
    });
    assert!(alone.contains("changes its size and is the same image in each frame"), "{alone}");
    let levels =
        broken(&|plan| plan.images.iter_mut().filter(|image| image.mips == 7).for_each(|image| image.mips = 8));
    assert!(levels.contains("has more mip levels than its size allows"), "{levels}");
}

/// A blit clamps at the edge of the image, not of the part in use: a linear one that enlarges would mix in what nobody wrote.
fn scaled(source: &str, target: &str, blit: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            settings: [(name: "scale", value: Number(default: 0.5, min: 0.1, max: 1.0))],
            images: [
                (name: "part", format: {source}, size: Dynamic(by: "scale", up_to: 1.0)),
                (name: "whole", format: Like("part"), {target}),
                (name: "less", format: Like("part"), size: Scaled(0.5, "part")),
                (name: "screen", format: Output, size: Output),
            ],
            passes: [
                (name: "draw", draw: FullScreen("plain"), color: ["part"]),
                (name: "scale", blit: ({blit})),
                (name: "show", draw: FullScreen("plain"), color: ["screen"]),
            ],
            outputs: ["whole", "screen"],
        )"#
    )
}

#[test]
fn a_linear_blit_of_a_part_is_drawn_whatever_the_part_and_one_of_the_nearest_texels_is_none() {
    let up = |filter: &str, scale: &str| {
        let text = scaled("R16G16B16A16_SFLOAT", "size: Output", &format!(r#"from: "part", to: "whole"{filter}"#));
        let chosen = set(&[("scale", scale)]);
        planned(&right(&text, &Inputs { set: &chosen, output_extent: [64, 36], ..INPUTS }))
    };
    let steps = |plan: &Plan| {
        let of = |step: &framewright_graph::plan::Step| match &step.work {
            Work::Blit(_) => "blit",
            Work::Render(_) => "render",
            _ => "other",
        };
        plan.steps.iter().map(of).collect::<Vec<_>>()
    };
    for scale in ["0.1", "0.5", "1"] {
        assert!(!steps(&up("", scale)).contains(&"blit"), "{scale}");
        assert!(steps(&up(", filter: Nearest", scale)).contains(&"blit"), "{scale}");
    }
    let plan = up("", "0.5");
    let reasons = plan.tree();
    assert!(reasons.contains("of which a frame uses a part,"), "{reasons}");
}

#[test]
fn a_linear_blit_of_a_part_into_one_level_is_refused() {
    let text = scaled(
        "R16G16B16A16_SFLOAT",
        "size: Output, mips: 2, lifetime: Persistent",
        r#"from: "part", to: (image: "whole", mip: 1)"#,
    );
    let answer = crate::testing::pipelines::wrong(&text, &Inputs { output_extent: [64, 36], ..INPUTS });
    assert!(answer.contains("a blit would mix in texels beyond that part"), "{answer}");
    assert!(answer.contains("draw: FullScreen(\"copy\")"), "{answer}");
}

/// The checker finds it out by itself.
#[test]
fn verify_finds_linear_blits_that_enlarge_a_part() {
    let found = |filter, extent: [u32; 3], made: Option<[u32; 2]>| {
        let text = scaled("R16G16B16A16_SFLOAT", "size: Output", r#"from: "part", to: "whole", filter: Nearest"#);
        let mut plan = planned(&right(&text, &Inputs { output_extent: [64, 36], ..INPUTS }));
        for image in plan.images.iter_mut().filter(|image| &*image.name == "part") {
            image.allocated = made;
        }
        for step in &mut plan.steps {
            let Work::Blit(transfer) = &mut step.work else { continue };
            transfer.filter = Some(filter);
            if let framewright_graph::plan::Side::Image { extent: whole, .. } = &mut transfer.target {
                *whole = extent;
            }
        }
        framewright_graph::verify::verify(&plan).iter().map(ToString::to_string).collect::<String>()
    };
    use framewright_graph::vulkan::Filter;
    let says = "texels beyond the part in use are mixed in";
    assert!(found(Filter::Linear, [64, 36, 1], Some([64, 36])).contains(says));
    assert!(found(Filter::Linear, [32, 19, 1], Some([64, 36])).contains(says), "along one axis");
    assert!(!found(Filter::Nearest, [64, 36, 1], Some([64, 36])).contains(says));
    assert!(!found(Filter::Linear, [32, 18, 1], Some([64, 36])).contains(says), "it isn't enlarged");
    assert!(!found(Filter::Linear, [64, 36, 1], None).contains(says), "all of it is used");
}
