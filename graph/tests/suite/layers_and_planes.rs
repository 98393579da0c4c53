//! Raster passes that use some layers or one plane of an image leave the others as they are.

use crate::testing::plans::planned;
use crate::testing::raster::{self, Raster};
use framewright_graph::base::Span;
use framewright_graph::compile::{Options, Order};
use framewright_graph::difference::Differences;
use framewright_graph::frame::{
    Blend, Buffer, BufferIndex, Draw, DrawList, Frame, Lifetime, Pass, Resource, StencilState, TransferUse, Work,
};
use framewright_graph::hints::{Hint, HintKind, hints};
use framewright_graph::plan::{self, Plan, Side};
use framewright_graph::vulkan::Format::{D32_SFLOAT, D32_SFLOAT_S8_UINT, R8G8B8A8_UNORM, R32_UINT};
use framewright_graph::vulkan::{Aspects, CompareOp, FillValue, Filter, Layout, StencilOp, Subresources};

fn compiled(frame: &Frame) -> Result<Plan, String> {
    let options = Options { order: Order::File, ..Options::default() };
    let plan = planned(frame, &raster::device(), &options);
    plan.map_err(|errors| errors.into_iter().map(|error| error.message).collect::<Vec<_>>().join("; "))
}

fn layer(base_layer: u32) -> Subresources {
    Subresources { base_layer, layers: 1, ..Subresources::WHOLE }
}

/// `first` clears both layers of `color`, with 4 samples, `cover` covers the first one, `show` samples both.
fn two_layers(cover: Subresources) -> Frame {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_UNORM, 4);
    let screen = raster.image("screen", R8G8B8A8_UNORM, 1);
    raster.objects("first").clear(color);
    raster.full_screen("cover").color(color, Blend::Replace);
    raster.full_screen("show").sample(color).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.images[0].layers = 2;
    frame.passes[1].color[0].range = cover;
    frame
}

/// IQ-9: moving such a draw to an image with one sample would lose the other layers.
#[test]
fn a_full_screen_draw_into_one_layer_of_several_keeps_its_samples() {
    let plan = compiled(&two_layers(layer(0))).expect("both layers are written");
    assert_eq!(plan.totals.resolves, 1);
    assert!(plan.images.iter().all(|image| !image.name.contains("1 sample")), "{}", plan.tree());
}

#[test]
fn a_layer_that_is_cleared_after_a_full_screen_draw_leaves_the_other_as_it_is() {
    let mut frame = two_layers(layer(0));
    frame.passes.swap(0, 1);
    frame.passes[0].color[0].range = layer(1);
    frame.passes[1].color[0].range = layer(0);
    compiled(&frame).expect("both layers are written");
}

/// `one` clears layer 0 of `many`, of 2 layers and 4 samples; `more` clears layer 1, if it is there; `show` samples layer 0.
fn one_layer_read(more: bool) -> Frame {
    let mut raster = Raster::default();
    let many = raster.image("many", R8G8B8A8_UNORM, 4);
    let screen = raster.image("screen", R8G8B8A8_UNORM, 1);
    raster.objects("one").clear(many);
    if more {
        raster.objects("more").clear(many);
    }
    raster.full_screen("show").sample(many).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.images[0].layers = 2;
    for (pass, number) in frame.passes.iter_mut().zip(0..) {
        pass.color.iter_mut().filter(|target| target.image == many).for_each(|target| target.range = layer(number));
        pass.sampled.iter_mut().for_each(|sampled| sampled.range = layer(0));
    }
    frame
}

fn resolved_layers(plan: &Plan) -> Vec<(u32, u32)> {
    let resolves = plan.steps.iter().filter_map(|step| match &step.work {
        plan::Work::Resolve(resolve) => Some(resolve),
        _ => None,
    });
    let part = |side: &Side| match side {
        Side::Image { range, .. } => (range.base_layer, range.layers),
        Side::Buffer { .. } => panic!("only images are resolved"),
    };
    resolves.map(|resolve| part(&resolve.source)).collect()
}

#[test]
fn a_resolve_of_an_array_covers_the_layers_that_are_written_and_read() {
    for more in [false, true] {
        let plan = compiled(&one_layer_read(more)).expect("it is valid");
        assert_eq!(resolved_layers(&plan), [(0, 1)], "{}", plan.tree());
        // Each resolve that no scope carries stands out (LV-4).
        let apart: Vec<Hint> = hints(&plan).into_iter().filter(|hint| hint.kind == HintKind::ResolvedApart).collect();
        assert_eq!(
            (apart.len(), &*apart[0].text),
            (1, "`resolve many` is a step of its own: no rendering scope carries it")
        );
    }
    let plan = compiled(&two_layers(layer(0))).expect("it is valid");
    assert_eq!(resolved_layers(&plan), [(0, 2)], "{}", plan.tree());
}

/// `more` keeps layer 1 from frame to frame, which needs it and resolves nothing of it.
#[test]
fn a_layer_that_is_written_and_never_read_resolved_is_not_resolved() {
    let mut frame = one_layer_read(true);
    frame.images[0].lifetime = Lifetime::Persistent { initial: FillValue::Color([0.0; 4]) };
    frame.passes[1].color[0].clear = None;
    frame.passes[1].color[0].blend = Blend::Additive;
    let plan = compiled(&frame).expect("it is valid");
    assert!(plan.tree().contains("more"), "{}", plan.tree());
    assert_eq!(resolved_layers(&plan), [(0, 1)], "{}", plan.tree());
}

#[test]
fn a_layer_that_is_read_resolved_only_after_a_later_write_is_resolved_then() {
    let mut raster = Raster::default();
    let many = raster.image("many", R8G8B8A8_UNORM, 4);
    let [first, second] = ["first", "second"].map(|name| raster.image(name, R8G8B8A8_UNORM, 1));
    for (number, screen) in [first, second].into_iter().enumerate() {
        raster.objects(["one", "more"][number]).clear(many);
        raster.full_screen(["show", "show_more"][number]).sample(many).color(screen, Blend::Replace);
    }
    let mut frame = raster.outputs(&[first, second]);
    frame.images[0].layers = 2;
    for (pair, number) in frame.passes.chunks_mut(2).zip(0..) {
        pair[0].color[0].range = layer(number);
        pair[1].sampled[0].range = layer(number);
    }
    let plan = compiled(&frame).expect("it is valid");
    let resolved = resolved_layers(&plan);
    assert_eq!((resolved[0], resolved.len()), ((0, 1), 2), "{}", plan.tree());
}

/// A triangle meets one layer, unless its shader chooses others.
#[test]
fn a_full_screen_draw_covers_no_more_than_one_layer() {
    let mut frame = two_layers(Subresources::WHOLE);
    frame.passes.remove(0);
    let refusal = compiled(&frame).map(|plan| plan.tree());
    assert_eq!(
        refusal.expect_err("nothing has written the second layer"),
        "`cover` is the first to write `color`, and may leave parts of it untouched"
    );
}

#[test]
fn a_draw_that_does_not_surely_reach_every_sample_covers_nothing() {
    type Change = fn(&mut Pass);
    let with = |change: Change| {
        let mut raster = Raster::default();
        let color = raster.image("color", R8G8B8A8_UNORM, 4);
        let screen = raster.image("screen", R8G8B8A8_UNORM, 1);
        raster.full_screen("cover").color(color, Blend::Replace);
        raster.full_screen("show").sample(color).color(screen, Blend::Replace);
        let mut frame = raster.output(screen);
        change(&mut frame.passes[0]);
        compiled(&frame).map(|plan| plan.tree())
    };
    fn draws(pass: &mut Pass, new: Draw, discarding: bool) {
        let Work::Draw { draw, discards, .. } = &mut pass.work else { panic!("it draws") };
        (*draw, *discards) = (new, discarding);
    }
    with(|_| {}).expect("it covers");
    let others: [(&str, Change); 5] = [
        ("objects", |pass| draws(pass, Draw::Objects(DrawList::Opaque), false)),
        ("the sky", |pass| draws(pass, Draw::Sky, false)),
        ("fragments that may be discarded", |pass| draws(pass, Draw::FullScreen, true)),
        ("alpha that says how many samples are covered", |pass| pass.alpha_to_coverage = true),
        ("light that is added", |pass| pass.color[0].blend = Blend::Additive),
    ];
    for (what, change) in others {
        let refusal = with(change).err().unwrap_or_else(|| panic!("{what} is taken for covering"));
        assert_eq!(refusal, "`cover` is the first to write `color`, and may leave parts of it untouched", "{what}");
    }
}

#[test]
fn plain_sampling_of_depth_with_stencil_reads_the_depth_alone() {
    let mut raster = Raster::default();
    let depth = raster.image("depth", D32_SFLOAT_S8_UINT, 1);
    let screen = raster.image("screen", R8G8B8A8_UNORM, 1);
    raster.objects("opaque").clear_depth(depth);
    raster.full_screen("show").sample(depth).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    let stencil = StencilState { clear: Some(0), test: CompareOp::Always, reference: 1, pass: StencilOp::Replace };
    for stencil in [None, Some(stencil)] {
        frame.passes[0].depth.as_mut().expect("it tests depth").stencil = stencil;
        let plan = compiled(&frame).expect("the depth is written");
        let barriers = plan.steps.iter().flat_map(|step| &step.image_barriers);
        let read: Vec<Aspects> = barriers
            .filter(|barrier| barrier.new_layout == Layout::DepthReadOnlyOptimal)
            .map(|barrier| barrier.range.aspects)
            .collect();
        assert_eq!(read, [Aspects::DEPTH]);
    }
}

/// Neither can a rendering scope carry it, nor is there a command for it.
#[test]
fn several_layers_of_multisampled_depth_are_not_resolved() {
    let mut raster = Raster::default();
    let depth = raster.image("depth", D32_SFLOAT, 4);
    raster.objects("opaque").clear_depth(depth);
    let mut frame = raster.output(depth);
    frame.images[0].layers = 2;
    assert_eq!(
        compiled(&frame).map(|plan| plan.tree()).expect_err("nothing could resolve it"),
        "`depth` is an output and has 4 samples; an image of several layers can't be resolved, whichever of them is read"
    );
}

#[test]
fn one_plane_of_depth_with_stencil_is_copied_to_a_buffer() {
    for (plane, bytes) in [(Aspects::DEPTH, 4), (Aspects::STENCIL, 1)] {
        let mut raster = Raster::default();
        let depth = raster.image("depth", D32_SFLOAT_S8_UINT, 1);
        let mut frame = raster.output(depth);
        let texels: u32 = frame.images[0].extent.iter().product();
        let bytes = bytes * u64::from(texels);
        let lifetime = Lifetime::Transient;
        frame.buffers.push(Buffer { name: "rows".into(), span: Span::NONE, bytes, lifetime });
        let side = |resource, aspects, write| {
            let range = Subresources { aspects, ..Subresources::WHOLE };
            TransferUse { resource, range, frames_ago: 0, span: Span::NONE, write, keeps: false }
        };
        let [image, rows] = [Resource::Image(depth), Resource::Buffer(BufferIndex(0))];
        let fill = Work::Fill { value: FillValue::Depth(0.5, 1) };
        let all = vec![side(image, Aspects::empty(), true)];
        frame.passes.push(Pass { transfers: all, ..Pass::new("fill", fill) });
        let both = vec![side(image, plane, false), side(rows, Aspects::empty(), true)];
        frame.passes.push(Pass { transfers: both, ..Pass::new("copy", Work::Copy) });
        frame.outputs.push(rows.into());
        compiled(&frame).expect("the buffer holds the plane");
        frame.buffers[0].bytes -= 1;
        let too_small =
            |wanted: u64| format!("`copy`: `rows` has {} bytes, but the texels of `depth` take {wanted}", bytes - 1);
        assert_eq!(compiled(&frame).expect_err("it is too small"), too_small(bytes));
        frame.passes[1].transfers[0].range = Subresources::WHOLE;
        let planes = "`copy`: `depth` has depth and stencil (D32_SFLOAT_S8_UINT): say which of them";
        let said = compiled(&frame).expect_err("these are two planes");
        assert_eq!(said, format!("{planes}; {}", too_small(4 * u64::from(texels))));
    }
}

fn transferred(resource: Resource, aspects: Aspects, write: bool) -> TransferUse {
    let range = Subresources { aspects, ..Subresources::WHOLE };
    TransferUse { resource, range, frames_ago: 0, span: Span::NONE, write, keeps: false }
}

#[test]
fn a_blit_between_planes_of_different_kinds_is_refused() {
    let mut raster = Raster::default();
    let [from, to] = ["from", "to"].map(|name| raster.image(name, D32_SFLOAT_S8_UINT, 1));
    let mut frame = raster.output(to);
    for image in [from, to] {
        let all = vec![transferred(Resource::Image(image), Aspects::empty(), true)];
        let fill = Work::Fill { value: FillValue::Depth(0.5, 1) };
        frame.passes.push(Pass { transfers: all, ..Pass::new(&format!("fill{}", image.0), fill) });
    }
    let blit = |from_plane, to_plane| {
        let from = transferred(Resource::Image(from), from_plane, false);
        let to = transferred(Resource::Image(to), to_plane, true);
        let blit = Pass { transfers: vec![from, to], ..Pass::new("blit", Work::Blit { filter: Filter::Nearest }) };
        let mut frame = frame.clone();
        frame.passes.push(blit);
        compiled(&frame)
    };
    for plane in [Aspects::DEPTH, Aspects::STENCIL, Aspects::empty()] {
        blit(plane, plane).expect("both planes are the same");
    }
    for (one, other) in
        [(Aspects::DEPTH, Aspects::empty()), (Aspects::empty(), Aspects::STENCIL), (Aspects::STENCIL, Aspects::DEPTH)]
    {
        let said = blit(one, other).expect_err("the planes differ");
        assert_eq!(said, "`blit`: `from` can't be scaled into `to`");
    }
}

/// What a copy leaves of its target must have been written before.
#[test]
fn a_copy_that_is_shorter_than_its_target_says_that_it_keeps_the_rest() {
    let buffer =
        |name: &str, bytes| Buffer { name: name.into(), span: Span::NONE, bytes, lifetime: Lifetime::Transient };
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_UNORM, 1);
    raster.objects("draw").clear(color);
    let mut frame = raster.output(color);
    frame.buffers = vec![buffer("short", 16), buffer("long", 64 * 64 * 4 + 16)];
    let [short, long] = [0, 1].map(|at| Resource::Buffer(BufferIndex(at)));
    for (name, target) in [("fill_short", short), ("fill_long", long)] {
        let fill = Work::Fill { value: FillValue::Bits([0; 4]) };
        frame
            .passes
            .push(Pass { transfers: vec![transferred(target, Aspects::empty(), true)], ..Pass::new(name, fill) });
    }
    frame.outputs.push(long.into());
    let copy = |from, keeps| {
        let from = transferred(from, Aspects::empty(), false);
        let to = TransferUse { keeps, ..transferred(long, Aspects::empty(), true) };
        let mut frame = frame.clone();
        frame.passes.push(Pass { transfers: vec![from, to], ..Pass::new("copy", Work::Copy) });
        compiled(&frame)
    };
    for from in [short, Resource::Image(color)] {
        let plan = copy(from, true).expect("it says so");
        assert_eq!(plan.totals.fills, if from == short { 2 } else { 1 }, "{}", plan.tree());
    }
    let said = copy(short, false).expect_err("it doesn't say so");
    assert_eq!(said, "`copy`: `short` has 16 bytes and `long` has 16400: a copy fills its target whole");
    let said = copy(Resource::Image(color), false).expect_err("it doesn't say so");
    assert_eq!(said, "`copy`: `long` has 16400 bytes, but the texels of `color` take 16384");
}

/// What compiles as other values is drawn with the same images and pipelines.
#[test]
fn another_clear_value_of_stencil_is_a_value() {
    let frame = |clear| {
        let mut raster = Raster::default();
        let depth = raster.image("depth", D32_SFLOAT_S8_UINT, 1);
        let screen = raster.image("screen", R8G8B8A8_UNORM, 1);
        raster.objects("opaque").clear_depth(depth);
        raster.full_screen("show").sample(depth).color(screen, Blend::Replace);
        let mut frame = raster.output(screen);
        let stencil = StencilState { clear: Some(clear), test: CompareOp::Always, reference: 1, pass: StencilOp::Keep };
        frame.passes[0].depth.as_mut().expect("it tests depth").stencil = Some(stencil);
        frame
    };
    let [one, other] = [1, 2].map(|clear| compiled(&frame(clear)).expect("it compiles"));
    assert_ne!(one, other);
    assert_eq!(one.differs_beyond_values(&other), None);
}

#[test]
fn a_difference_tells_that_integers_take_sample_zero_where_a_resolve_is_a_step() {
    let plan = |format| {
        let mut raster = Raster::default();
        let ids = raster.image("ids", format, 4);
        raster.objects("opaque").clear(ids);
        let mut frame = raster.output(ids);
        frame.images[0].layers = 2;
        compiled(&frame).expect("it compiles")
    };
    let none = Plan { steps: Vec::new(), ..plan(R32_UINT) };
    for (format, mode) in [(R32_UINT, "SAMPLE_ZERO"), (R8G8B8A8_UNORM, "AVERAGE")] {
        let plan = plan(format);
        let resolves = plan.steps.iter().any(|step| matches!(step.work, plan::Work::Resolve(_)));
        assert!(resolves, "{}", plan.tree());
        let text = Differences::between(("none", &none), ("some", &plan)).text();
        assert!(text.contains(&format!("mode {mode}")), "{text}");
    }
}
