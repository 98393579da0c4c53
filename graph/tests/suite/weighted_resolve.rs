//! Colour whose image says `resolve: Weighted`: wherever one value is made of its samples, a draw makes it (IQ-20).

use crate::testing::plans::on;
use crate::testing::raster::{self, Raster};
use framewright_graph::base::Diagnostic;
use framewright_graph::device::Profile;
use framewright_graph::frame::{Blend, Draw, Frame, ImageIndex, ParamValue, Resolve, ResolveWay};
use framewright_graph::plan::{Access, Cause, Pass, Plan, Work};
use framewright_graph::vulkan::Format::{self, *};
use framewright_graph::vulkan::ResolveMode;

fn planned(frame: &Frame) -> Result<Plan, Vec<Diagnostic>> {
    on(frame, &raster::device())
}

fn say(frame: &mut Frame, image: ImageIndex, way: ResolveWay) {
    frame.images[image.0 as usize].resolve = Some(Resolve { way, because: "`resolve: …`".into() });
}

/// Objects in `samples` samples, which two passes read before more are drawn, and one afterwards.
fn read_thrice(format: Format, samples: u32) -> Frame {
    let mut raster = Raster::default();
    let light = raster.image("light", format, samples);
    let [dim, bright, screen] = ["dim", "bright", "screen"].map(|name| raster.image(name, R16G16B16A16_SFLOAT, 1));
    raster.objects("opaque").clear(light);
    raster.full_screen("dim").sample(light).color(dim, Blend::Replace);
    raster.full_screen("bright").sample(light).color(bright, Blend::Replace);
    raster.objects("glass").color(light, Blend::Premultiplied);
    raster.full_screen("show").sample(light).sample(dim).sample(bright).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    say(&mut frame, light, ResolveWay::Weighted);
    frame
}

fn passes(plan: &Plan) -> Vec<&Pass> {
    let scopes =
        plan.steps.iter().filter_map(|step| if let Work::Render(scope) = &step.work { Some(scope) } else { None });
    scopes.flat_map(|scope| &scope.passes).collect()
}

fn inserted(plan: &Plan) -> Vec<&Pass> {
    passes(plan).into_iter().filter(|pass| &*pass.shader == "shipped:resolve_weighted").collect()
}

#[test]
fn each_version_is_resolved_by_one_draw_for_all_its_readers() {
    let plan = planned(&read_thrice(R16G16B16A16_SFLOAT, 4)).expect("it compiles");
    assert_eq!((plan.totals.resolves, plan.totals.inserted_passes), (0, 2), "{}", plan.tree());
    let names: Vec<&str> = passes(&plan).iter().map(|pass| &*pass.name).collect();
    let expected = ["opaque", "light (resolved)", "dim", "bright", "glass", "light (resolved 2)", "show"];
    assert_eq!(names, expected);
    for pass in inserted(&plan) {
        assert_eq!((pass.draw, &pass.blend[..]), (Some(Draw::FullScreen), &[Blend::Replace][..]));
        assert_eq!(
            pass.params.iter().map(|it| (&*it.name, it.value.clone())).collect::<Vec<_>>(),
            [("invert", ParamValue::Bool(true))]
        );
        let Cause::Inserted(why) = &pass.cause else { panic!("{:?}", pass.cause) };
        assert!(why.because.contains("samples `light` and it has 4 samples, `resolve: …`"), "{}", why.because);
        let bound =
            |access: &Access| access.binding.as_ref().map(|it| (it.name.clone(), it.texture.map(|it| it.to_string())));
        let sources: Vec<_> = pass.accesses.iter().filter_map(bound).collect();
        assert_eq!(sources, [("source".into(), Some("sampler2DMS".to_owned()))]);
    }
}

#[test]
fn one_sample_takes_no_draw() {
    let plan = planned(&read_thrice(R16G16B16A16_SFLOAT, 1)).expect("it compiles");
    assert_eq!((plan.totals.resolves, plan.totals.inserted_passes), (0, 0));
}

#[test]
fn what_leaves_the_frame_or_is_forwarded_is_weighted_too() {
    let mut raster = Raster::default();
    let light = raster.image("light", R16G16B16A16_SFLOAT, 4);
    let shown = raster.image("shown", R16G16B16A16_SFLOAT, 1);
    raster.objects("opaque").clear(light);
    raster.forward("off", light, shown);
    let mut frame = raster.outputs(&[shown, light]);
    say(&mut frame, light, ResolveWay::Weighted);
    let plan = planned(&frame).expect("it compiles");
    assert_eq!((plan.totals.resolves, inserted(&plan).len()), (0, 1), "{}", plan.tree());
}

/// Images that are one, and say different ways.
#[test]
fn a_resolve_of_another_way_serves_nobody() {
    let mut raster = Raster::default();
    let [light, seen] = ["light", "seen"].map(|name| raster.image(name, R16G16B16A16_SFLOAT, 4));
    let [one, other] = ["one", "other"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("opaque").clear(light);
    raster.full_screen("look").sample(light).color(one, Blend::Replace);
    raster.forward("off", light, seen);
    raster.full_screen("see").sample(seen).color(other, Blend::Replace);
    let mut frame = raster.outputs(&[one, other]);
    say(&mut frame, light, ResolveWay::Weighted);
    let plan = planned(&frame).expect("it compiles");
    assert_eq!((plan.totals.resolves, inserted(&plan).len()), (1, 1), "{}", plan.tree());
}

fn refused(frame: &Frame) -> String {
    let errors = planned(frame).expect_err("it is refused");
    errors.iter().map(|error| error.message.clone()).collect::<Vec<_>>().join("; ")
}

#[test]
fn layers_and_formats_without_light_are_refused() {
    let mut layered = read_thrice(R16G16B16A16_SFLOAT, 4);
    layered.images[0].layers = 2;
    let said = refused(&layered);
    assert!(said.contains("an image of several layers can't be resolved, whichever of them is read"), "{said}");
    for (format, way) in [
        (R32_UINT, ResolveWay::Weighted),
        (R32_UINT, ResolveWay::By(ResolveMode::Average)),
        (R16G16B16A16_SFLOAT, ResolveWay::By(ResolveMode::Max)),
        (R16G16B16A16_SFLOAT, ResolveWay::DepthOnly),
        (D32_SFLOAT, ResolveWay::Weighted),
    ] {
        let mut frame = read_thrice(format, 4);
        say(&mut frame, ImageIndex(0), way);
        assert!(refused(&frame).contains(&format!("can't be resolved as it says: it is {format}")), "{way:?}");
    }
}

#[test]
fn integers_are_resolved_by_a_draw_where_the_device_takes_another_sample_and_the_reason_said() {
    let lying = Profile { refuted_integer_resolve: true, ..raster::device() };
    for (format, shader) in [(R8_UINT, "shipped:resolve_zero_uint"), (R32_SINT, "shipped:resolve_zero_sint")] {
        let mut raster = Raster::default();
        let ids = raster.image("ids", format, 4);
        let [one, other] = ["one", "other"].map(|name| raster.image(name, R16G16B16A16_SFLOAT, 1));
        raster.objects("opaque").clear(ids);
        raster.full_screen("first").sample(ids).color(one, Blend::Replace);
        raster.full_screen("second").sample(ids).sample(one).color(other, Blend::Replace);
        let frame = raster.output(other);
        let honest = planned(&frame).expect("it compiles");
        assert_eq!((honest.totals.resolves, honest.totals.inserted_passes), (1, 0), "{}", honest.tree());
        let plan = on(&frame, &lying).expect("it compiles");
        assert_eq!((plan.totals.resolves, plan.totals.inserted_passes), (0, 1), "{}", plan.tree());
        let drawn: Vec<&Pass> = passes(&plan).into_iter().filter(|pass| &*pass.shader == shader).collect();
        let Cause::Inserted(why) = &drawn[0].cause else { panic!("{:?}", drawn[0].cause) };
        let said = "by a draw: a test showed that `a device for tests` resolves integers to another sample";
        assert!(why.because.ends_with(said), "{}", why.because);
    }
}

/// Weights count light below zero as none, so one sample isn't the same as four alike.
#[test]
fn a_draw_that_covers_an_image_of_weighed_samples_keeps_them() {
    let plan = |way| {
        let mut raster = Raster::default();
        let light = raster.image("light", R16G16B16A16_SFLOAT, 4);
        let screen = raster.image("screen", R16G16B16A16_SFLOAT, 1);
        raster.full_screen("cover").color(light, Blend::Replace);
        raster.full_screen("show").sample(light).color(screen, Blend::Replace);
        let mut frame = raster.output(screen);
        say(&mut frame, light, way);
        planned(&frame).expect("it compiles")
    };
    assert_eq!(inserted(&plan(ResolveWay::By(ResolveMode::Average))).len(), 0);
    assert_eq!(inserted(&plan(ResolveWay::Weighted)).len(), 1);
}
