//! How several samples of depth become one value: drawn again, resolved by the scope, resolved by a draw (IQ-10 to IQ-15).

use crate::testing::plans::{compiled, on, scopes};
use crate::testing::raster::{self, Raster};
use framewright_graph::device::Profile;
use framewright_graph::frame::{
    Blend, Draw, EyeForm, Frame, ImageIndex, Output, Resolve, ResolveWay, Resource, Stereo,
};
use framewright_graph::plan::{Cause, Plan, RenderScope, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{D32_SFLOAT, D32_SFLOAT_S8_UINT, R8G8B8A8_SRGB};
use framewright_graph::vulkan::{CompareOp, LoadOp, ResolveMode, StoreOp, Usage};
use std::path::Path;

/// A device that resolves depth in these modes.
fn resolving(modes: &[ResolveMode]) -> Profile {
    Profile { depth_resolve: modes.to_vec(), ..raster::device() }
}

fn names(plan: &Plan) -> Vec<Vec<&str>> {
    scopes(plan).iter().map(|scope| scope.passes.iter().map(|pass| &*pass.name).collect()).collect()
}

fn because(cause: &Cause) -> &str {
    if let Cause::Inserted(why) = cause { &why.because } else { "" }
}

/// Opaque and masked objects, a sky behind them, stripes by depth over them, and glass that is tested afterwards.
struct Stripes {
    raster: Raster,
    depth: ImageIndex,
    screen: ImageIndex,
}

impl Stripes {
    fn new(samples: u32) -> Stripes {
        let mut raster = Raster::default();
        let color = raster.image("color", R8G8B8A8_SRGB, samples);
        let depth = raster.image("depth", D32_SFLOAT, samples);
        let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
        raster.objects("opaque").clear(color).clear_depth(depth);
        raster.objects("masked").color(color, Blend::Replace).write_depth(depth);
        raster.objects("sky").color(color, Blend::Replace).test_depth(depth);
        raster.full_screen("stripes").sample(depth).color(color, Blend::Alpha);
        raster.objects("glass").color(color, Blend::Alpha).test_depth(depth);
        raster.full_screen("show").sample(color).color(screen, Blend::Replace);
        Stripes { raster, depth, screen }
    }

    fn frame(self, mode: Option<Option<ResolveMode>>) -> Frame {
        let Stripes { raster, depth, screen } = self;
        let mut frame = raster.output(screen);
        frame.images[depth.0 as usize].resolve = mode.map(|mode| {
            let way = mode.map_or(ResolveWay::DepthOnly, ResolveWay::By);
            Resolve { way, because: "`resolve: …`".into() }
        });
        frame
    }
}

#[test]
fn iq_12_what_drew_the_depth_is_drawn_again_with_one_sample_in_one_scope_before_its_reader() {
    let plan = compiled(&Stripes::new(4).frame(None));
    let names = names(&plan);
    let at = |name: &str| names.iter().position(|scope| scope.contains(&name)).expect("it runs");
    let again = at("opaque (depth only)");
    assert_eq!(names[again], ["opaque (depth only)", "masked (depth only)"], "the sky writes no depth");
    assert!(again < at("stripes"), "{}", plan.tree());
    let scope = scopes(&plan)[again];
    let depth = scope.depth().expect("it draws depth");
    assert_eq!((scope.samples, scope.color().len(), depth.load, depth.store), (1, 0, LoadOp::Clear, StoreOp::Store));
    assert_eq!(&*plan.image(depth.image).name, "depth (depth only)");
    let redraws: Vec<Option<&str>> = scope.passes.iter().map(|pass| pass.redraws.as_deref()).collect();
    assert_eq!(redraws, [Some("opaque"), Some("masked")]);
    let why = "`stripes` samples `depth` and it has 4 samples; what drew it is drawn again with 1";
    assert_eq!(because(&scope.passes[0].cause), why);
    assert_eq!(plan.totals.inserted_passes, 2);
}

#[test]
fn iq_16_glass_behind_the_stripes_is_still_multisampled_and_tested_against_all_samples() {
    let plan = compiled(&Stripes::new(4).frame(None));
    let scopes = scopes(&plan);
    let glass = scopes.iter().find(|scope| scope.passes.iter().any(|pass| &*pass.name == "glass")).expect("it runs");
    let depth = glass.depth().expect("it is tested");
    assert_eq!((glass.samples, &*plan.image(depth.image).name), (4, "depth"));
}

#[test]
fn iq_10_depth_is_averaged_only_where_its_image_says_so() {
    let device = resolving(&[ResolveMode::SampleZero, ResolveMode::Average, ResolveMode::Min, ResolveMode::Max]);
    let averages = |mode: Option<Option<ResolveMode>>, leaves: bool| {
        let stripes = Stripes::new(4);
        let depth = Resource::Image(stripes.depth);
        let mut frame = stripes.frame(mode);
        let output = Output { resource: depth, ..frame.outputs[0].clone() };
        frame.outputs.extend(leaves.then_some(output));
        let plan = on(&frame, &device).expect("the frame is valid");
        scopes(&plan).into_iter().any(|scope| {
            let folded = scope.depth().and_then(|depth| depth.resolve.as_ref());
            folded.is_some_and(|resolve| resolve.mode == ResolveMode::Average)
                || scope.passes.iter().any(|pass| pass.shader.ends_with("average"))
        })
    };
    for leaves in [false, true] {
        for mode in [None, Some(None), Some(Some(ResolveMode::Min))] {
            assert!(!averages(mode, leaves), "{mode:?}");
        }
        assert!(averages(Some(Some(ResolveMode::Average)), leaves), "as it says");
    }
}

#[test]
fn iq_11_depth_of_one_sample_is_sampled_itself() {
    for mode in [None, Some(None), Some(Some(ResolveMode::Min))] {
        let plan = compiled(&Stripes::new(1).frame(mode));
        assert_eq!((plan.totals.inserted_passes, plan.totals.resolves), (0, 0));
        assert_eq!(plan.images.len(), 3, "{}", plan.tree());
    }
}

#[test]
fn iq_15_multisampled_depth_that_only_what_is_drawn_again_is_sampled_of_is_never_stored() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 4);
    let depth = raster.image("depth", D32_SFLOAT, 4);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.full_screen("fog").sample(depth).sample(color).color(screen, Blend::Replace);
    let plan = compiled(&raster.output(screen));
    let scope = scopes(&plan).into_iter().find(|scope| scope.samples == 4).expect("the scene");
    let depth = scope.depth().expect("it has depth");
    assert_eq!((depth.store, depth.resolve.is_none()), (StoreOp::DontCare, true));
    assert!(plan.image(depth.image).usage.contains(Usage::TRANSIENT_ATTACHMENT));
}

#[test]
fn a_version_is_drawn_again_once_for_all_its_readers_and_anew_after_the_next_write() {
    let mut raster = Raster::default();
    let depth = raster.image("depth", D32_SFLOAT, 4);
    let [first, second, third] = ["first", "second", "third"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("opaque").clear_depth(depth);
    raster.full_screen("fog").sample(depth).color(first, Blend::Replace);
    raster.full_screen("edges").sample_depth_only(depth).color(second, Blend::Replace);
    raster.objects("more").write_depth(depth);
    raster.full_screen("haze").sample(depth).color(third, Blend::Replace);
    let plan = compiled(&raster.outputs(&[first, second, third]));
    let mut again: Vec<&str> = names(&plan).into_iter().flatten().filter(|name| name.contains("depth only")).collect();
    again.sort_unstable();
    assert_eq!(again, ["more (depth only)", "opaque (depth only 2)", "opaque (depth only)"]);
}

#[test]
fn iq_14_a_mode_that_the_device_has_is_folded_into_the_scope_that_drew_the_depth() {
    for mode in [ResolveMode::SampleZero, ResolveMode::Min, ResolveMode::Max, ResolveMode::Average] {
        let frame = Stripes::new(4).frame(Some(Some(mode)));
        let plan = on(&frame, &resolving(&[mode])).expect("the frame is valid");
        let resolve = scopes(&plan).into_iter().find_map(|scope| scope.depth()?.resolve.as_ref());
        let resolve = resolve.unwrap_or_else(|| panic!("{}", plan.tree()));
        assert_eq!((resolve.mode, plan.totals.inserted_passes), (mode, 0));
        assert_eq!(because(&resolve.cause), "`stripes` samples `depth` and it has 4 samples, `resolve: …`");
    }
}

#[test]
fn a_mode_that_the_device_has_for_one_layer_only_is_drawn_for_both_eyes_layers_and_the_reason_said() {
    let flat = resolving(&[ResolveMode::SampleZero]);
    let device = Profile { refuted_layered_depth_resolve: vec![ResolveMode::SampleZero], ..flat.clone() };
    let mut frame = Stripes::new(4).frame(Some(Some(ResolveMode::SampleZero)));
    let inserted =
        |frame: &Frame, device: &Profile| on(frame, device).expect("the frame is valid").totals.inserted_passes;
    // Of one layer it is right.
    assert_eq!((inserted(&frame, &flat), inserted(&frame, &device)), (0, 0));
    frame.stereo = Stereo::Multiview;
    for image in &mut frame.images {
        image.eyes = Some(EyeForm::Layers);
    }
    assert_eq!(inserted(&frame, &flat), 0);
    let plan = on(&frame, &device).expect("the frame is valid");
    assert_eq!(plan.totals.inserted_passes, 1, "{}", plan.tree());
    let resolved = plan.images.iter().find(|image| *image.name == *"depth (resolved)").expect("it is made");
    let said = "by a draw: `a device for tests` claims to resolve depth of several layers by SAMPLE_ZERO, and a test showed \
                that it doesn't";
    assert!(because(&resolved.cause).ends_with(said), "{}", plan.tree());
}

#[test]
fn iq_14_a_mode_that_the_device_lacks_or_only_claims_is_drawn_and_the_reason_said() {
    let lacking = resolving(&[ResolveMode::SampleZero]);
    let lying = Profile { refuted_depth_resolve: vec![ResolveMode::Average], ..lacking.clone() };
    let cases = [
        (
            ResolveMode::Max,
            &lacking,
            "shipped:depth_resolve_max",
            "`a device for tests` resolves depth by SAMPLE_ZERO only",
        ),
        (
            ResolveMode::Average,
            &lying,
            "shipped:depth_resolve_average",
            "`a device for tests` claims to resolve depth by AVERAGE, and a test showed that it doesn't",
        ),
    ];
    for (mode, device, shader, why) in cases {
        let plan = on(&Stripes::new(4).frame(Some(Some(mode))), device).expect("the frame is valid");
        let passes = scopes(&plan).into_iter().flat_map(|scope| scope.passes.iter().map(move |pass| (scope, pass)));
        let (scope, pass) = passes.into_iter().find(|(_, pass)| &*pass.name == "depth (resolved)").expect("a draw");
        assert_eq!((&*pass.shader, pass.draw, scope.samples), (shader, Some(Draw::FullScreen), 1));
        assert_eq!(pass.depth.map(|depth| (depth.test, depth.write)), Some((CompareOp::Always, true)));
        assert_eq!(scope.depth().map(|depth| depth.load), Some(LoadOp::DontCare));
        assert!(because(&pass.cause).ends_with(&format!("`resolve: …`; by a draw: {why}")), "{:?}", pass.cause);
    }
}

#[test]
fn depth_beside_stencil_is_resolved_by_a_draw() {
    let mut stripes = Stripes::new(4);
    let depth = stripes.depth.0 as usize;
    stripes.raster.format(depth, D32_SFLOAT_S8_UINT);
    let plan = compiled(&stripes.frame(Some(Some(ResolveMode::SampleZero))));
    let passes = scopes(&plan).into_iter().flat_map(|scope| &scope.passes);
    let draw = passes.into_iter().find(|pass| &*pass.name == "depth (resolved)").expect("a draw");
    assert!(because(&draw.cause).ends_with("it has stencil beside the depth"), "{:?}", draw.cause);
}

#[test]
fn the_face_asks_for_the_depth_only_pass_whatever_the_image_says() {
    let mut raster = Raster::default();
    let depth = raster.image("depth", D32_SFLOAT, 4);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear_depth(depth);
    raster.full_screen("fog").sample_depth_only(depth).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.images[0].resolve =
        Some(Resolve { way: ResolveWay::By(ResolveMode::SampleZero), because: "`resolve: …`".into() });
    let plan = compiled(&frame);
    assert_eq!((plan.totals.resolves, plan.totals.inserted_passes), (0, 1));
}

/// The reason why the passes that drew the depth can't draw it again, behind the name of the pass.
fn refused(change: impl FnOnce(&mut Frame)) -> String {
    let mut frame = Stripes::new(4).frame(None);
    change(&mut frame);
    let refused = on(&frame, &raster::device()).expect_err("there is no way");
    assert_eq!(refused.len(), 1);
    let message = &refused[0].message;
    let start = "`stripes` samples `depth` and it has 4 samples, and its depth can't be drawn again with 1: ";
    assert!(refused[0].help.as_ref().is_some_and(|help| help.contains("`resolve: SampleZero`")), "{refused:?}");
    message.strip_prefix(start).unwrap_or_else(|| panic!("{message}")).to_owned()
}

#[test]
fn iq_12_a_writer_that_cannot_be_drawn_again_is_an_error_that_says_so() {
    let drawn_as = |draw: Draw| {
        move |frame: &mut Frame| {
            if let framewright_graph::frame::Work::Draw { draw: drawn, .. } = &mut frame.passes[1].work {
                *drawn = draw;
            }
        }
    };
    assert_eq!(refused(drawn_as(Draw::Custom)), "`masked` is recorded by the program");
    let why = "has the shader `masked`, and with the macro `DEPTH_ONLY` it doesn't compile";
    assert_eq!(refused(|frame| frame.passes[1].no_depth_only = Some(why.into())), format!("`masked` {why}"));
}

#[test]
fn verify_knows_what_may_be_drawn_again() {
    let found = |change: fn(&mut RenderScope)| {
        let mut plan = compiled(&Stripes::new(4).frame(None));
        let again = |step: &mut framewright_graph::plan::Step| match &mut step.work {
            Work::Render(scope) if scope.passes[0].redraws.is_some() => change(scope),
            _ => {}
        };
        plan.steps.iter_mut().for_each(again);
        verify(&plan).iter().map(ToString::to_string).collect::<String>()
    };
    assert_eq!(found(|_| ()), "");
    let says = |change, what: &str| {
        let found = found(change);
        assert!(found.contains(what), "{found}");
    };
    says(|scope| scope.passes[1].redraws = Some("nobody".into()), "draws again what the Plan doesn't draw");
    says(|scope| scope.passes[1].redraws = Some("opaque".into()), "draws something else than the pass");
    says(|scope| scope.passes[1].discards = true, "draws something else than the pass");
    says(|scope| scope.passes[1].redraws = Some("opaque (depth only)".into()), "draws something else than the pass");
    let lax = |scope: &mut RenderScope| {
        scope.passes[1].depth.iter_mut().for_each(|depth| depth.test = CompareOp::Always);
    };
    says(lax, "tests depth otherwise than the pass");
}

/// Inserted passes stand in the Plan at their place, with their cause.
#[test]
fn the_plans_are_those_that_were_reviewed() {
    let rungs =
        [("drawn_again", None), ("in_the_scope", Some(ResolveMode::SampleZero)), ("by_a_draw", Some(ResolveMode::Max))];
    for (name, mode) in rungs {
        let plan = compiled(&Stripes::new(4).frame(mode.map(Some)));
        insta::with_settings!({
            snapshot_path => Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/depth_ladder"),
            prepend_module_to_snapshot => false,
            omit_expression => true,
            description => "accept with INSTA_UPDATE=always cargo test -p framewright-graph --test suite depth_ladder",
        }, { insta::assert_snapshot!(name, plan.tree()) });
    }
}
