//! Malformed Plans: each mistake is said, none makes the checker panic.

use crate::testing::hand_written_plans;
use framewright_graph::frame::{Allowances, Blend, Cascade, Draw, DrawList, Jitter, Share};
use framewright_graph::plan::{
    BindingKind, FORMAT_VERSION, FirstContents, ImageBarrier, Output, Plan, PlanError, RenderScope, Resource, Role,
    View, Work,
};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{
    Accesses, AddressMode, CompareOp, Component, Dimension, FillValue, Filter, Format, ImageShape, Layout, LoadOp,
    ResolveMode, Rotation, Sampler, Shape, Stages, State, StoreOp, Subresources, Usage,
};
use serde_json::Value;

/// Images: 0 `color` at 4 samples, 1 `depth` at 4 samples, 2 `color.resolved`, 3 `screen`.
fn multisampled() -> Plan {
    let [(_, plan), ..] = hand_written_plans::all();
    plan
}

fn scope(plan: &mut Plan, step: usize) -> &mut RenderScope {
    match &mut plan.steps[step].work {
        Work::Render(scope) => scope,
        other => panic!("step {step} is no scope: {other:?}"),
    }
}

/// Has the shader of the second scope compiled for another image than the flat one that it samples.
fn declare(plan: &mut Plan, change: fn(&mut ImageShape)) {
    let mut texture = ImageShape::of(Shape::D2, 0..1, false, Component::Float);
    change(&mut texture);
    let binding = scope(plan, 1).passes[0].accesses[0].binding.as_mut().expect("it is sampled");
    binding.texture = Some(texture);
}

/// A view that is shifted once.
fn shifted(offset: [f64; 2]) -> View {
    let jitter = Some(Jitter { extent: [8, 8], offsets: vec![offset] });
    View { name: "main".into(), extent: [8, 8], camera: None, allows: Allowances::default(), jitter, eye: None }
}

#[test]
fn every_mistake_of_form_is_said() {
    type Change = fn(&mut Plan);
    let changes: &[(Change, &str)] = &[
        (|plan| plan.format_version = 1, "format version 1 is not known"),
        (
            |plan| plan.views.push(shifted([0.0, 0.6])),
            "view `main` is shifted by no texel, never, or by more than half of one",
        ),
        (|plan| plan.views.push(shifted([f64::NAN, 0.0])), "view `main` is shifted by no texel, never"),
        (|plan| plan.images[1].name = "color".into(), "`color`: has the name of another image"),
        (|plan| plan.images[0].extent[0] = 0, "`color`: is empty"),
        (
            |plan| {
                let binding = scope(plan, 1).passes[0].accesses[0].binding.as_mut().expect("it is sampled");
                binding.kind =
                    BindingKind::Sampled(Sampler { compare: Some(CompareOp::Less), ..Sampler::new(Filter::Nearest) });
            },
            "`color.resolved`: is compared with a depth, and holds none",
        ),
        (|plan| plan.images[2].allocated = Some([1, 4096]), "`color.resolved`: uses more than it has room for"),
        (|plan| plan.images[2].allocated = Some([4096, 1]), "`color.resolved`: uses more than it has room for"),
        (
            |plan| (plan.images[2].allocated, plan.images[2].shape) = (Some([4096, 4096]), Shape::Cube),
            "`color.resolved`: changes its size and is deep or a cube",
        ),
        (
            |plan| {
                let state =
                    State { stages: Stages::COPY, accesses: Accesses::empty(), layout: Layout::TransferSrcOptimal };
                let initial = FirstContents::Value(FillValue::Color([0.0; 4]));
                let (becomes, before, after) = (plan.images[3].id.0, state, state);
                plan.images[3].allocated = Some([4096, 4096]);
                plan.images[3].role = Role::Persistent { becomes, initial, before, after };
            },
            "`screen`: changes its size and is the same image in each frame",
        ),
        (
            |plan| {
                plan.images[2].allocated = Some([4096, 4096]);
                let binding = scope(plan, 1).passes[0].accesses[0].binding.as_mut().expect("it is sampled");
                let BindingKind::Sampled(sampler) = &mut binding.kind else { panic!("it is sampled") };
                sampler.address = AddressMode::Repeat;
            },
            "`color.resolved`: is used in part and looked up beyond its edges",
        ),
        (
            |plan| {
                plan.images[2].allocated = Some([4096, 4096]);
                let accesses = &mut scope(plan, 1).passes[0].accesses;
                let sampled = accesses[0].clone();
                accesses.extend(std::iter::repeat_n(sampled, 8));
            },
            "samples more images in part than shaders can be told of",
        ),
        (
            |plan| plan.images[2].rotation = Rotation::Rotate180,
            "`color.resolved`: is rotated, and a shader takes it to be upright",
        ),
        (
            |plan| plan.images[2].rotation = Rotation::Rotate180,
            "`color.resolved`: is drawn beside an image that is rotated otherwise",
        ),
        (
            |plan| plan.images[1].rotation = Rotation::Rotate180,
            "`depth`: is drawn beside an image that is rotated otherwise",
        ),
        (
            |plan| (plan.images[3].rotation, plan.images[3].mips) = (Rotation::Rotate180, 2),
            "`screen`: is rotated and isn't flat, or has several mip levels",
        ),
        (|plan| plan.images[3].mips = 20, "`screen`: has more mip levels than its size allows"),
        (|plan| plan.images[0].samples = 3, "`color`: has a sample count that is not"),
        (|plan| plan.images[2].usage = Usage::SAMPLED, "is used as COLOR_ATTACHMENT, which its usage leaves out"),
        (
            |plan| plan.outputs.push(Output::new("c", Resource::Image(framewright_graph::plan::ImageId(2)))),
            "`color.resolved`: is listed as an output and is transient",
        ),
        (|plan| plan.outputs.push(plan.outputs[0].clone()), "`screen`: is an output with the name of another one"),
        (
            |plan| {
                let Role::External { before, .. } = &mut plan.images[3].role else { panic!("it is an output") };
                before.layout = Layout::TransferDstOptimal;
            },
            "`screen`: comes or goes in TRANSFER_DST_OPTIMAL, for which it has no usage",
        ),
        (
            |plan| {
                let Role::External { after, .. } = &mut plan.images[3].role else { panic!("it is an output") };
                after.layout = Layout::DepthAttachmentOptimal;
            },
            "`screen`: comes or goes in DEPTH_ATTACHMENT_OPTIMAL, which not all of its planes can be in",
        ),
        (|plan| scope(plan, 0).attachments.reverse(), "lists attachments out of order (colour, depth, stencil)"),
        (
            |plan| {
                let scope = scope(plan, 0);
                scope.attachments.extend(scope.depth().cloned());
            },
            "lists attachments out of order (colour, depth, stencil), or has two of depth or stencil",
        ),
        (
            |plan| scope(plan, 1).attachments.clear(),
            "has 0 colour attachments, or none at all, as no rendering scope can",
        ),
        (
            |plan| {
                let attachment = scope(plan, 1).attachments[0].clone();
                scope(plan, 1).attachments = vec![attachment; 33];
            },
            "has 33 colour attachments",
        ),
        (
            |plan| {
                let (index, of, logarithmic) = (255, 4, Share::OF_CASCADES);
                let cascade = Cascade { list: DrawList::Opaque, index, of, reach: None, logarithmic };
                scope(plan, 1).passes[0].draw = Some(Draw::Casters(cascade));
            },
            "draws a part of the shadows' reach that there isn't",
        ),
        (
            // Each range is made of as many parts as there are ranges before it.
            |plan| {
                let image = &mut plan.images[2];
                image.layers = 1 << 13;
                let ranges = (1..1 << 13).map(|layers| Subresources {
                    mips: 1,
                    layers,
                    ..Subresources::all(image.format, 1, 1)
                });
                let barriers = ranges.map(|range| ImageBarrier { range, ..plan.steps[1].image_barriers[0].clone() });
                plan.steps[1].image_barriers = barriers.collect();
            },
            "tells more parts of images apart than can be followed",
        ),
        (
            |plan| plan.images[3].usage = Usage::COLOR_ATTACHMENT | Usage::TRANSIENT_ATTACHMENT,
            "`screen`: is a TRANSIENT_ATTACHMENT and more than an attachment, or outlives the frame",
        ),
        (|plan| scope(plan, 1).passes[0].local_barrier = true, "has a local barrier in a scope without local reads"),
        (|plan| plan.heaps[0].bytes = 1024, "reaches beyond heap 0, which has 1024 bytes"),
        (|plan| plan.heaps[0].type_bits = 0b100, "accepts the memory types 0b11, its heap may be of 0b100"),
        (|plan| plan.heaps[0].lazily_allocated = true, "lies in lazily allocated memory"),
        (|plan| plan.totals.image_barriers = 7, "totals.image_barriers is 7, its parts add up to 6"),
        (|plan| plan.totals.live_peak_bytes = 1, "totals.live_peak_bytes is 1"),
        (|plan| scope(plan, 0).extent = [32, 32], "has another size than its scope"),
        (|plan| plan.images[1].shape = Shape::D3, "`depth`: is three-dimensional and can't be an attachment"),
        (|plan| plan.images[2].shape = Shape::D3, "`color.resolved`: is three-dimensional and can't be an attachment"),
        (|plan| plan.images[3].shape = Shape::D3, "`screen`: is three-dimensional and can't be an attachment"),
        (|plan| scope(plan, 0).samples = 1, "`color`: has another sample count than its scope"),
        (|plan| scope(plan, 0).attachments[0].clear = None, "has a clear value exactly if its load is CLEAR"),
        (
            |plan| scope(plan, 0).attachments[0].clear = Some([f64::NAN; 4]),
            "has a clear value that its format doesn't hold",
        ),
        (
            |plan| scope(plan, 0).attachments[0].clear = Some([1e39; 4]),
            "has a clear value that its format doesn't hold",
        ),
        (|plan| scope(plan, 1).attachments[0].clear = Some([0.0; 4]), "has a clear value exactly if its load is CLEAR"),
        (|plan| scope(plan, 0).attachments.truncate(1), "pass `opaque` tests depth without a depth attachment"),
        (|plan| scope(plan, 0).passes[0].blend.clear(), "doesn't say how each colour attachment is blended"),
        (|plan| scope(plan, 0).passes[0].blend = vec![Blend::Alpha], "doesn't list its COLOR_ATTACHMENT_READ"),
        (|plan| scope(plan, 0).passes[0].accesses.clear(), "doesn't list its COLOR_ATTACHMENT_WRITE"),
        (|plan| scope(plan, 0).passes[0].draw = None, "is in a rendering scope and draws nothing"),
        (|plan| scope(plan, 1).passes[0].accesses[0].binding = None, "is accessed by a shader without such a binding"),
        (
            |plan| declare(plan, |texture| texture.multisampled = true),
            "`color.resolved`: isn't as its shader is made to declare it",
        ),
        (
            |plan| declare(plan, |texture| texture.dimension = Dimension::Cube),
            "isn't as its shader is made to declare it",
        ),
        (
            |plan| declare(plan, |texture| texture.component = Component::Uint),
            "isn't as its shader is made to declare it",
        ),
        (
            |plan| {
                let sampled = scope(plan, 1).passes[0].accesses[0].binding.clone();
                scope(plan, 1).passes[0].accesses[1].binding = sampled;
            },
            "is bound without such an access",
        ),
        (|plan| scope(plan, 1).passes[0].name = "sky".into(), "a pass has the name of another pass"),
        (|plan| plan.images[2].format = Format::R8G8B8A8_UNORM, "is the target of a resolve from another format"),
        (
            |plan| scope(plan, 0).attachments[0].resolve.iter_mut().for_each(|resolve| resolve.mode = ResolveMode::Max),
            "can't be resolved in that mode",
        ),
        (
            |plan| {
                let attached = scope(plan, 0).attachments[0].clone();
                scope(plan, 0).attachments.push(attached);
            },
            "`color`: is attached twice",
        ),
        (
            |plan| {
                let mut sampled = scope(plan, 1).passes[0].accesses[0].clone();
                sampled.image = framewright_graph::plan::ImageId(3);
                scope(plan, 1).passes[0].accesses.push(sampled);
            },
            "`screen`: is an attachment and accessed by a shader in the same scope",
        ),
        (
            |plan| {
                let depth = scope(plan, 0).attachments.last_mut().expect("the scene has depth");
                depth.layout = Layout::DepthStencilReadOnlyOptimal;
            },
            "is attached read-only, which takes a LOAD load and a NONE store",
        ),
        (
            |plan| plan.steps[1].image_barriers[0].dst_stages = Stages::COPY,
            "SHADER_SAMPLED_READ doesn't happen in COPY",
        ),
        (
            |plan| plan.steps[1].image_barriers[0].src_accesses |= Accesses::from_bits_retain(1 << 30),
            "names stages or accesses that are not known",
        ),
        (
            |plan| {
                let again = plan.steps[1].image_barriers[0].clone();
                plan.steps[1].image_barriers.push(again);
            },
            "two barriers of one call concern the same part",
        ),
        (
            |plan| plan.steps[1].image_barriers[0].range.base_mip = u32::MAX,
            "has no part COLOR, mip 4294967295, layer 0",
        ),
        (|plan| plan.steps[1].image_barriers[0].new_layout = Layout::TransferSrcOptimal, "for which it has no usage"),
        (|plan| plan.steps.clear(), "there are only 0"),
    ];
    for (change, expected) in changes {
        let mut plan = multisampled();
        change(&mut plan);
        let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
        assert!(said.iter().any(|violation| violation.contains(expected)), "{expected}: {said:#?}");
    }
}

#[test]
fn a_store_without_need_of_contents_is_no_mistake() {
    let mut plan = multisampled();
    scope(&mut plan, 0).attachments[0].store = StoreOp::Store;
    assert_eq!(verify(&plan), []);
}

/// Objects don't cover: a load that throws away what an earlier step drew is caught, though they write the image.
#[test]
fn contents_that_a_draw_may_leave_standing_must_be_loaded() {
    let mut plan = hand_written_plans::all().into_iter().nth(2).expect("the Plan with read-only depth").1;
    let glass = scope(&mut plan, 2);
    glass.attachments[0].load = LoadOp::DontCare;
    glass.passes[0].blend = vec![Blend::Replace];
    glass.passes[0].accesses[0].accesses = Accesses::COLOR_ATTACHMENT_WRITE;
    let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
    let expected = "step 3 `tonemap`: `color` (COLOR, mip 0, layer 0): needed, but the DONT_CARE load of step 2 `glass` lost \
                    its contents";
    assert_eq!(said, [expected]);
}

#[test]
fn a_text_that_is_no_plan_is_refused_with_its_reason() {
    let plan = multisampled();
    let text = plan.to_json().unwrap();
    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        Plan::from_json(&text.replacen(from, to, 1)).expect_err(to).to_string()
    };
    assert_eq!(
        changed("\"format_version\": 14", "\"format_version\": 13"),
        "the Plan has format version 13, this program reads version 14: compile it again"
    );
    assert_eq!(changed("\"id\": 0", "\"id\": 9"), "images[0] has the id 9: ids are indices");
    assert_eq!(changed("\"heap\": 0", "\"heap\": 5"), "images[0] `color` names heaps[5], but there are only 1");
    assert_eq!(
        changed("\"image\": 2", "\"image\": 99"),
        "steps[0].image_barriers names images[99], but there are only 4"
    );
    assert!(changed("\"layers\"", "\"lawyers\"").starts_with("not a Plan: unknown field `lawyers`"));
    assert!(changed("\"white_point\"", "\"white_point\" \"").starts_with("not a Plan: "));
    assert!(matches!(Plan::from_json(""), Err(PlanError::Syntax(_))));
    assert!(matches!(Plan::from_json(&"[".repeat(100_000)), Err(PlanError::Syntax(_))));
    assert!(changed("0.0", "1e999").contains("number out of range"));
    let mut plan = plan;
    scope(&mut plan, 0).attachments[0].clear = Some([f64::NAN; 4]);
    assert_eq!(plan.to_json().unwrap_err().to_string(), "a clear value in steps[0] is not a finite number");
}

/// Every number of every Plan, one after the other, becomes very small and very large.
#[test]
fn no_number_makes_anything_panic() {
    let mut tried = 0;
    for (_, plan) in hand_written_plans::all() {
        let value: Value = serde_json::from_str(&plan.to_json().unwrap()).unwrap();
        let mut numbers = Vec::new();
        find_numbers(&value, String::new(), &mut numbers);
        for place in &numbers {
            for number in [0, 1, 5, 33, u64::from(u32::MAX) - 1, u64::from(u32::MAX), u64::MAX] {
                let mut value = value.clone();
                *value.pointer_mut(place).expect("it was just found") = number.into();
                if let Ok(plan) = Plan::from_json(&value.to_string()) {
                    let _ = (verify(&plan).iter().map(ToString::to_string).count(), plan.tree());
                    tried += 1;
                }
            }
        }
    }
    assert!(tried > 1000, "{tried}");
}

fn find_numbers(value: &Value, place: String, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(place),
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(at, value)| find_numbers(value, format!("{place}/{at}"), found));
        }
        Value::Object(fields) => {
            fields.iter().for_each(|(name, value)| find_numbers(value, format!("{place}/{name}"), found));
        }
        _ => {}
    }
}

#[test]
fn names_from_files_are_shown_without_control_characters() {
    let mut plan = multisampled();
    plan.images[2].name = "red\u{1b}[31m\n\u{202e}".into();
    scope(&mut plan, 1).passes[0].name = "beep\u{7}".into();
    plan.settings[0].value = "\r".to_owned();
    plan.device.name = "\u{0}".to_owned();
    plan.steps[1].image_barriers.remove(0);
    let shown: String = verify(&plan).iter().map(|violation| format!("{violation}\n")).chain([plan.tree()]).collect();
    assert!(shown.contains(r"red\u{1b}[31m\n\u{202e}"), "{shown}");
    let raw = shown.chars().find(|letter| *letter != '\n' && (letter.is_control() || *letter == '\u{202e}'));
    assert_eq!(raw, None);
}

/// Attachments are compared with each other only where they are as few as a scope can have, whatever their kinds are.
#[test]
fn very_many_attachments_of_depth_are_not_compared_with_each_other() {
    let twice = |count: usize| {
        let mut plan = multisampled();
        let depth = scope(&mut plan, 0).depth().cloned().expect("it tests depth");
        scope(&mut plan, 0).attachments = vec![depth; count];
        verify(&plan).iter().filter(|wrong| wrong.to_string().contains("is attached twice")).count()
    };
    assert_eq!((twice(1), twice(35)), (0, 0));
    assert!(twice(34) > 0);
}

#[test]
fn a_plan_without_steps_is_refused() {
    let mut plan = multisampled();
    plan.images.retain(|image| matches!(image.role, Role::External { .. }));
    plan.images[0].id.0 = 0;
    plan.outputs = vec![Output::new("screen", Resource::Image(plan.images[0].id))];
    plan.steps.clear();
    plan.notes.clear();
    let said: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
    assert_eq!(said, ["the Plan: has no steps"]);
}

#[test]
fn the_tree_says_what_runs_in_order_and_why() {
    insta::assert_snapshot!(multisampled().tree());
}

#[test]
fn the_page_about_the_form_is_about_this_version() {
    let page = include_str!("../../../../docs/plan-format.md");
    assert!(page.starts_with(&format!("# The JSON form of a Plan, version {FORMAT_VERSION}\n")));
    assert!(page.contains(&format!("| `format_version` | `{FORMAT_VERSION}` |")));
}
