//! Raster passes as the compiler translates them: resolves, scopes, load and store operations, forwards.

use crate::testing::plans::{compiled, scopes};
use crate::testing::raster::{self, Raster, forward};
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::Blend;
use framewright_graph::plan::{Plan, Resource, Role, Stage};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{D32_SFLOAT, R8G8B8A8_SRGB, R16G16B16A16_SFLOAT, R32_UINT};
use framewright_graph::vulkan::{Filter, Layout, LoadOp, ResolveMode, StoreOp, Usage};

fn pass_names(plan: &Plan) -> Vec<Vec<String>> {
    scopes(plan).iter().map(|scope| scope.passes.iter().map(|pass| pass.name.to_string()).collect()).collect()
}

fn note(plan: &Plan, stage: Stage, subject: &str) -> String {
    let found = plan.notes.iter().find(|note| note.stage() == stage && &*note.subject == subject);
    found.map(|note| note.text.clone()).unwrap_or_default()
}

#[test]
fn a_multisampled_scene_that_is_tone_mapped_takes_one_folded_resolve() {
    let plan = compiled(&forward(4, true, true));
    assert_eq!((plan.totals.resolves, plan.totals.folded_resolves), (1, 1));
    assert_eq!(pass_names(&plan), [vec!["opaque", "sky", "glass"], vec!["tonemap"]]);
    let scope = scopes(&plan)[0];
    let color = &scope.attachments[0];
    assert_eq!((color.load, color.store), (LoadOp::Clear, StoreOp::DontCare));
    assert_eq!(color.resolve.as_ref().map(|resolve| resolve.mode), Some(ResolveMode::Average));
    let depth = scope.depth().expect("the scene has depth");
    assert_eq!((depth.load, depth.store), (LoadOp::Clear, StoreOp::DontCare));
    for attachment in [color, depth] {
        assert!(plan.image(attachment.image).usage.contains(Usage::TRANSIENT_ATTACHMENT));
    }
}

#[test]
fn one_sample_takes_no_resolve_and_no_multisampled_image() {
    let plan = compiled(&forward(1, true, true));
    assert_eq!(plan.totals.resolves, 0);
    assert!(plan.images.iter().all(|image| image.samples == 1));
    assert!(note(&plan, Stage::Adapt, "color").contains("it has 1 sample"), "{:?}", plan.notes);
}

#[test]
fn without_hdr_and_tone_mapping_the_scene_goes_straight_into_the_output() {
    let plan = compiled(&forward(1, false, false));
    assert_eq!(scopes(&plan).len(), 1);
    assert_eq!(plan.images.len(), 2, "the screen and the depth");
    assert!(matches!(plan.image(scopes(&plan)[0].attachments[0].image).role, Role::External { .. }));
    assert!(note(&plan, Stage::Adapt, "screen").contains("they are one image"), "{:?}", plan.notes);
}

#[test]
fn a_forward_that_only_loses_samples_is_the_resolve() {
    let plan = compiled(&forward(4, false, false));
    assert_eq!((plan.totals.resolves, plan.totals.folded_resolves, plan.totals.inserted_passes), (1, 1, 0));
    let resolve = scopes(&plan)[0].attachments[0].resolve.as_ref().expect("a folded resolve");
    assert!(matches!(plan.image(resolve.image).role, Role::External { .. }));
}

#[test]
fn a_forward_between_formats_is_drawn() {
    let plan = compiled(&forward(4, true, false));
    assert_eq!((plan.totals.resolves, plan.totals.inserted_passes), (1, 1));
    assert_eq!(&*scopes(&plan)[1].passes[0].shader, "shipped:copy");
}

#[test]
fn a_forward_between_formats_that_are_both_multisampled_is_resolved_and_drawn() {
    let mut raster = Raster::default();
    let color = raster.image("color", R16G16B16A16_SFLOAT, 4);
    let plain = raster.image("plain", R8G8B8A8_SRGB, 4);
    raster.objects("opaque").clear(color);
    raster.forward("tonemap", color, plain);
    raster.objects("interface").color(plain, Blend::Alpha);
    let plan = compiled(&raster.output(plain));
    assert_eq!((plan.totals.resolves, plan.totals.inserted_passes, plan.totals.copies), (2, 1, 0));
}

/// IQ-7, IQ-8: the resolved copy stays valid until the next write, for every reader.
#[test]
fn readers_of_one_version_share_its_resolve_and_the_next_version_gets_its_own() {
    let mut raster = Raster::default();
    let color = raster.image("color", R16G16B16A16_SFLOAT, 4);
    let [a, b, screen] = ["a", "b", "screen"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("opaque").clear(color);
    raster.full_screen("first").sample(color).color(a, Blend::Replace);
    raster.full_screen("second").sample(color).color(b, Blend::Replace);
    raster.objects("glass").color(color, Blend::Alpha);
    raster.full_screen("last").sample(color).sample(a).sample(b).color(screen, Blend::Replace);
    let plan = compiled(&raster.output(screen));
    assert_eq!((plan.totals.resolves, plan.totals.folded_resolves), (2, 2));
    let opaque = &scopes(&plan)[0].attachments[0];
    assert_eq!(opaque.store, StoreOp::Store, "glass draws on top of it");
}

/// IQ-8: an image that another one is forwarded to holds the same version.
#[test]
fn readers_of_a_forwarded_image_share_the_resolve_of_the_one_that_it_was() {
    let mut raster = Raster::default();
    let [color, other] = ["color", "other"].map(|name| raster.image(name, R16G16B16A16_SFLOAT, 4));
    let [a, b] = ["a", "b"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("opaque").clear(color);
    raster.full_screen("first").sample(color).color(a, Blend::Replace);
    raster.forward("glow", color, other);
    raster.full_screen("second").sample(other).color(b, Blend::Replace);
    let plan = compiled(&raster.outputs(&[a, b]));
    assert_eq!((plan.totals.resolves, plan.totals.folded_resolves), (1, 1));
}

#[test]
fn a_scope_that_was_resolved_is_closed_for_later_draws() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 4);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    let other = raster.image("other", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color);
    raster.forward("copy_out", color, screen);
    raster.objects("glass").color(color, Blend::Alpha);
    raster.full_screen("last").sample(color).color(other, Blend::Replace);
    let plan = compiled(&raster.outputs(&[screen, other]));
    assert_eq!(pass_names(&plan), [vec!["opaque"], vec!["glass"], vec!["last"]]);
    assert!(note(&plan, Stage::Scope, "glass").contains("resolve"), "{:?}", plan.notes);
}

#[test]
fn a_draw_that_samples_what_it_replaces_gets_a_second_image() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color);
    raster.full_screen("blur").sample(color).color(color, Blend::Replace);
    let plan = compiled(&raster.output(color));
    let blur = &scopes(&plan)[1];
    assert_ne!(blur.attachments[0].image, blur.passes[0].accesses[0].image);
    assert_eq!(plan.totals.copies, 0);
}

#[test]
fn a_draw_that_samples_what_it_blends_onto_gets_a_copy() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color);
    raster.full_screen("haze").sample(color).color(color, Blend::Alpha);
    let plan = compiled(&raster.output(color));
    assert_eq!(plan.totals.copies, 1);
    let haze = &scopes(&plan)[1];
    assert_ne!(haze.attachments[0].image, haze.passes[0].accesses[0].image);
    assert_eq!(haze.attachments[0].load, LoadOp::Load);
}

#[test]
fn a_multisampled_target_may_be_sampled_resolved_while_it_is_drawn_into() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 4);
    raster.objects("opaque").clear(color);
    raster.full_screen("stripes").sample(color).color(color, Blend::Alpha);
    let plan = compiled(&raster.output(color));
    assert_eq!((plan.totals.resolves, plan.totals.folded_resolves, plan.totals.copies), (2, 2, 0));
}

#[test]
fn integers_are_resolved_by_sample_zero() {
    let mut raster = Raster::default();
    let ids = raster.image("ids", R32_UINT, 4);
    raster.objects("opaque").clear(ids);
    let plan = compiled(&raster.output(ids));
    let resolve = scopes(&plan)[0].attachments[0].resolve.as_ref().expect("a folded resolve");
    assert_eq!(resolve.mode, ResolveMode::SampleZero);
}

#[test]
fn what_reaches_no_output_does_not_run() {
    let mut raster = Raster::default();
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    let unused = raster.image("unused", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(screen);
    raster.full_screen("wasted").sample(screen).color(unused, Blend::Replace);
    let plan = compiled(&raster.output(screen));
    assert_eq!(plan.totals.passes, 1);
    assert_eq!(plan.images.len(), 1);
    assert!(note(&plan, Stage::Cull, "wasted").contains("no output"));
}

/// IQ-5: the highest count up to the wanted one that all attachments have together.
#[test]
fn an_unsupported_sample_count_is_lowered_and_said() {
    let mut device = raster::device();
    for support in &mut device.formats {
        support.samples = if support.format == D32_SFLOAT { vec![1, 2] } else { vec![1, 2, 4] };
    }
    let plan = compile(&forward(8, true, true), &device, &mut MemoryEstimate(&device), &Options::default())
        .expect("the frame is valid");
    let color = plan.images.iter().find(|image| &*image.name == "color").expect("there is a color");
    assert_eq!(color.samples, 2);
    let text = note(&plan, Stage::Fit, "color");
    assert_eq!(
        text,
        format!("2 samples instead of 8: `{}` offers 1 and 2 for R16G16B16A16_SFLOAT with D32_SFLOAT", device.name)
    );
}

/// Two images are one only if nobody can tell: `screen` is drawn on while `color` is still read.
#[test]
fn a_forward_does_not_share_memory_with_what_is_read_later() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 1);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    let second = raster.image("second", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color);
    raster.forward("tonemap", color, screen);
    raster.objects("interface").color(screen, Blend::Alpha);
    raster.full_screen("preview").sample(color).color(second, Blend::Replace);
    let plan = compiled(&raster.outputs(&[screen, second]));
    assert_eq!(plan.totals.copies, 1);
    let names: Vec<&str> = plan.images.iter().map(|image| &*image.name).collect();
    assert_eq!(names, ["color", "screen", "second"]);
}

#[test]
fn depth_that_is_only_tested_is_left_alone() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 1);
    let depth = raster.image("depth", D32_SFLOAT, 1);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.full_screen("fog").sample(depth).sample(color).color(screen, Blend::Replace);
    raster.objects("glass").color(screen, Blend::Alpha).test_depth(depth);
    let plan = compiled(&raster.output(screen));
    let glass = scopes(&plan)[2].depth().expect("glass is tested");
    assert_eq!((glass.load, glass.store), (LoadOp::Load, StoreOp::None));
    let barriers_of_depth =
        plan.steps.iter().flat_map(|step| &step.image_barriers).filter(|barrier| barrier.image == glass.image).count();
    assert_eq!(barriers_of_depth, 2, "reads in one layout follow each other without a barrier");
}

/// IQ-10: depth is never averaged unless a file asks for it, also where it is dumped.
#[test]
fn multisampled_depth_that_leaves_the_frame_is_its_sample_zero() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 4);
    let depth = raster.image("depth", D32_SFLOAT, 4);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.objects("glass").color(color, Blend::Alpha).test_depth(depth);
    let plan = compiled(&raster.outputs(&[color, depth]));
    assert_eq!((plan.totals.resolves, plan.totals.folded_resolves, plan.totals.scopes), (2, 2, 1));
    let resolve = scopes(&plan)[0].depth().and_then(|depth| depth.resolve.as_ref()).expect("a folded resolve");
    assert_eq!(resolve.mode, ResolveMode::SampleZero);
    assert_eq!(plan.outputs[1].resource, Resource::Image(resolve.image));
}

#[test]
fn what_a_device_can_neither_filter_nor_blend_is_refused_by_name() {
    let mut device = raster::device();
    for support in &mut device.formats {
        support.blend &= support.format != R16G16B16A16_SFLOAT;
        support.linear_filter &= support.format != D32_SFLOAT;
    }
    let mut raster = Raster::default();
    let color = raster.image("color", R16G16B16A16_SFLOAT, 1);
    let depth = raster.image("depth", D32_SFLOAT, 1);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.objects("glass").color(color, Blend::Alpha).test_depth(depth);
    raster.full_screen("fog").sample_by(color, Filter::Linear).sample_by(depth, Filter::Linear).clear(screen);
    let refused = compile(&raster.output(screen), &device, &mut MemoryEstimate(&device), &Options::default());
    let said: Vec<String> = refused.expect_err("it can't be drawn").into_iter().map(|error| error.message).collect();
    assert_eq!(
        said,
        [
            "`glass` can't blend into `color`: `a device for tests` can't do that with R16G16B16A16_SFLOAT",
            "`fog` can't filter `depth`: `a device for tests` can't do that with D32_SFLOAT",
        ]
    );
}

#[test]
fn depth_is_forwarded_as_the_same_image() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 1);
    let depth = raster.image("depth", D32_SFLOAT, 1);
    let kept = raster.image("kept", D32_SFLOAT, 1);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.forward("fog_depth", depth, kept);
    let plan = compiled(&raster.outputs(&[color, kept]));
    assert_eq!((plan.images.len(), plan.totals.copies, plan.totals.inserted_passes), (2, 0, 0));
}

/// Heaps have their worst moments at different steps; the frame has one.
#[test]
fn the_live_peak_is_that_of_all_heaps_together() {
    let mut device = raster::device();
    device.lazily_allocated_memory = true;
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 4);
    let [near, far, screen] = ["near", "far", "screen"].map(|name| raster.image(name, R16G16B16A16_SFLOAT, 1));
    raster.objects("opaque").clear(color);
    raster.full_screen("first").sample(color).color(near, Blend::Replace);
    raster.full_screen("second").sample(near).color(far, Blend::Replace);
    raster.full_screen("last").sample(near).sample(far).color(screen, Blend::Replace);
    let plan = compile(&raster.output(screen), &device, &mut MemoryEstimate(&device), &Options::default())
        .expect("the frame is valid");
    assert_eq!(plan.heaps.len(), 2);
    assert_eq!(verify(&plan), [], "{}", plan.tree());
}

#[test]
fn single_samples_of_a_target_are_read_from_a_copy_of_the_version_before() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 4);
    raster.objects("opaque").clear(color);
    raster.full_screen("edges").sample_each(color).sample_each(color).color(color, Blend::Alpha);
    let plan = compiled(&raster.output(color));
    assert_eq!(plan.totals.copies, 1, "both bindings have the same copy");
    let copy = plan.images.iter().find(|image| &*image.name == "color (copy)").expect("there is a copy");
    assert_eq!(copy.samples, 4);
}

#[test]
fn an_image_that_another_is_forwarded_to_may_have_been_used_before() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 1);
    let [screen, second] = ["screen", "second"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("opaque").clear(screen);
    raster.full_screen("preview").sample(screen).color(second, Blend::Replace);
    raster.objects("glass").clear(color);
    raster.forward("tonemap", color, screen);
    let plan = compiled(&raster.outputs(&[screen, second]));
    let names: Vec<&str> = plan.images.iter().map(|image| &*image.name).collect();
    assert_eq!(names, ["screen (2)", "second", "screen"]);
    let Resource::Image(screen) = plan.outputs[0].resource else { panic!("it is an image") };
    assert_eq!(&*plan.image(screen).name, "screen");
}

#[test]
fn an_image_that_is_forwarded_to_itself_stays_as_it_is() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color);
    raster.forward("nothing", color, color);
    let plan = compiled(&raster.output(color));
    assert_eq!((plan.totals.copies, plan.images.len()), (0, 1));
}

#[test]
fn a_full_screen_draw_whose_depth_test_always_passes_covers() {
    let mut raster = Raster::default();
    let color = raster.image("color", R8G8B8A8_SRGB, 1);
    let depth = raster.image("depth", D32_SFLOAT, 1);
    let second = raster.image("second", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(color).clear_depth(depth);
    raster.full_screen("preview").sample(color).color(second, Blend::Replace);
    raster.full_screen("fog").color(color, Blend::Replace).pass_depth(depth);
    let mut plan = compiled(&raster.outputs(&[color, second]));
    assert_eq!(scopes(&plan)[2].attachments[0].load, LoadOp::DontCare);
    let image = scopes(&plan)[2].attachments[0].image;
    for barrier in plan.steps[2].image_barriers.iter_mut().filter(|barrier| barrier.image == image) {
        barrier.old_layout = Layout::ShaderReadOnlyOptimal;
    }
    assert_eq!(verify(&plan), [], "nor does the checker ask for what was there");
}

#[test]
fn multisampled_depth_that_was_not_drawn_last_is_resolved_by_a_draw() {
    let mut raster = Raster::default();
    let [near, far] = ["near", "far"].map(|name| raster.image(name, D32_SFLOAT, 4));
    raster.objects("opaque").clear_depth(near);
    raster.forward("shift", near, far);
    let plan = compiled(&raster.outputs(&[near, far]));
    let drawn: Vec<_> = scopes(&plan).into_iter().flat_map(|scope| &scope.passes).map(|pass| &*pass.name).collect();
    assert_eq!(
        drawn,
        ["opaque", "far (resolved)"],
        "only a rendering scope resolves depth: the copy is resolved by a draw"
    );
}
