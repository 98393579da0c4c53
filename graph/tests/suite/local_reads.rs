//! Local reads: a pass that reads only its own pixel joins the rendering scope that draws it, where the device can, and says why
//! where it doesn't.

use crate::testing::plans::{planned, scopes};
use crate::testing::raster::{self, Raster};
use framewright_graph::compile::{Compiler, Options, Order, Reuse, compile};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::frame::{Blend, Draw, Frame, ImageIndex, Resource, Work};
use framewright_graph::plan::{self, BindingKind, Plan, RenderScope, Stage};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{R8G8B8A8_SRGB, R8G8B8A8_UNORM, R16G16B16A16_SFLOAT};
use framewright_graph::vulkan::{Accesses, Layout, Stages, StoreOp, Usage};
use std::sync::Arc;

/// Geometry draws into `albedo` and `normal`, `light` reads both at its own pixel into `lit`, `tonemap` samples that.
fn deferred(samples: u32) -> Frame {
    let mut raster = Raster::default();
    let albedo = raster.image("albedo", R8G8B8A8_UNORM, samples);
    let normal = raster.image("normal", R8G8B8A8_UNORM, samples);
    let lit = raster.image("lit", R16G16B16A16_SFLOAT, samples);
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("geometry").clear(albedo).clear(normal);
    raster.full_screen("light").sample(albedo).sample(normal).color(lit, Blend::Replace);
    raster.full_screen("tonemap").sample(lit).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    frame.passes[1].sampled.iter_mut().for_each(|sampled| sampled.own_pixel = true);
    frame
}

fn device(local_read: bool) -> Profile {
    Profile { local_read, ..raster::device() }
}

fn compiled(frame: &Frame, device: &Profile) -> Plan {
    planned(frame, device, &Options { demote: false, ..Options::default() }).expect("the frame is valid")
}

fn note(plan: &Plan, subject: &str) -> String {
    let notes = plan.notes.iter().filter(|note| note.stage() == Stage::Scope && *note.subject == *subject);
    notes.map(|note| note.text.clone()).collect::<Vec<_>>().join("; ")
}

#[test]
fn lighting_joins_the_scope_of_the_geometry_that_it_reads_at_its_own_pixel() {
    let plan = compiled(&deferred(1), &device(true));
    let [first, _] = scopes(&plan)[..] else { panic!("{}", plan.tree()) };
    let [geometry, light] = &first.passes[..] else { panic!("{}", plan.tree()) };
    let layouts: Vec<Layout> = first.color().iter().map(|attachment| attachment.layout).collect();
    let local = Layout::RenderingLocalReadKhr;
    assert_eq!(layouts, [local, local, Layout::ColorAttachmentOptimal]);
    assert!(!geometry.local_barrier && light.local_barrier);
    assert_eq!(
        light.merged,
        Some(Box::new("reads `albedo` at its own position: 0.0 MiB need not be read from memory".into()))
    );
    let bound =
        light.accesses.iter().filter_map(|access| access.binding.as_ref().map(|binding| (access, binding.kind)));
    for (access, kind) in bound {
        assert_eq!(
            (kind, access.layout, access.stages),
            (BindingKind::InputAttachment, local, Stages::FRAGMENT_SHADER)
        );
        assert_eq!(access.accesses, Accesses::INPUT_ATTACHMENT_READ);
    }
    // One blend mode for each attachment of the scope.
    assert!([geometry, light].iter().all(|pass| pass.blend.len() == 3));
}

#[test]
fn what_is_read_only_locally_never_leaves_its_scope() {
    let plan = compiled(&deferred(1), &device(true));
    for name in ["albedo", "normal"] {
        let image = plan.images.iter().find(|image| *image.name == *name).expect("it is in the Plan");
        assert_eq!(image.usage, Usage::COLOR_ATTACHMENT | Usage::INPUT_ATTACHMENT | Usage::TRANSIENT_ATTACHMENT);
    }
    let stores: Vec<StoreOp> = scopes(&plan)[0].color().iter().map(|attachment| attachment.store).collect();
    assert_eq!(stores, [StoreOp::DontCare, StoreOp::DontCare, StoreOp::Store]);
}

#[test]
fn without_local_reads_it_is_sampled_and_said() {
    let plan = compiled(&deferred(1), &device(false));
    assert_eq!(scopes(&plan).len(), 3);
    let said = note(&plan, "light");
    assert!(
        said.contains("reads `albedo` at its own position from memory: `a device for tests` has no local reads"),
        "{said}"
    );
    assert!(plan.images.iter().all(|image| !image.usage.contains(Usage::INPUT_ATTACHMENT)));
}

/// docs/synchronization.md says what Vulkan asks for: this is the safe side of it.
#[test]
fn a_colour_write_after_a_local_read_of_the_same_scope_stands_behind_a_local_barrier() {
    let mut raster = Raster::default();
    let [x, y] = ["x", "y"].map(|name| raster.image(name, R16G16B16A16_SFLOAT, 1));
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.full_screen("one").color(x, Blend::Replace);
    raster.full_screen("two").sample(x).color(y, Blend::Replace);
    raster.full_screen("three").color(x, Blend::Additive);
    raster.full_screen("four").sample(x).color(y, Blend::Additive);
    raster.full_screen("show").sample(x).sample(y).color(screen, Blend::Replace);
    let mut frame = raster.output(screen);
    for pass in [1, 3] {
        frame.passes[pass].sampled[0].own_pixel = true;
    }
    let plan = compiled(&frame, &device(true));
    let [first, _] = scopes(&plan)[..] else { panic!("{}", plan.tree()) };
    let barriers: Vec<(&str, bool)> = first.passes.iter().map(|pass| (&*pass.name, pass.local_barrier)).collect();
    assert_eq!(barriers, [("one", false), ("two", true), ("three", true), ("four", true)]);
}

#[test]
fn what_cannot_be_read_locally_is_sampled_and_said() {
    // Several samples are resolved into another image.
    let plan = compiled(&deferred(4), &device(true));
    assert_eq!(scopes(&plan).len(), 3);
    assert!(note(&plan, "light").contains("it doesn't share the scope that draws it"), "{}", note(&plan, "light"));
    // Neighbours are read too.
    let mut frame = deferred(1);
    frame.passes[1].sampled[1].own_pixel = false;
    let plan = compiled(&frame, &device(true));
    assert_eq!(scopes(&plan).len(), 3);
    assert!(note(&plan, "light").contains("it samples `normal`, which the scope before it writes"));
    // The scope would have too many attachments.
    let plan = compiled(&deferred(1), &Profile { max_color_attachments: 2, ..device(true) });
    assert_eq!(scopes(&plan).len(), 3);
    assert!(note(&plan, "light").contains("its attachments are not the same"));
}

#[test]
fn a_light_that_is_added_later_reads_without_a_second_barrier() {
    let mut frame = deferred(1);
    let mut more = frame.passes[1].clone();
    more.name = "more light".into();
    more.color[0].blend = Blend::Additive;
    frame.passes.insert(2, more);
    let plan = compiled(&frame, &device(true));
    let barriers: Vec<bool> = scopes(&plan)[0].passes.iter().map(|pass| pass.local_barrier).collect();
    assert_eq!(barriers, [false, true, false]);
}

#[test]
fn what_was_read_locally_is_drawn_over_behind_a_barrier() {
    let mut frame = deferred(1);
    let mut marks = frame.passes[0].clone();
    marks.name = "marks".into();
    marks.color.truncate(1);
    marks.color[0].clear = None;
    frame.passes.insert(2, marks);
    frame.outputs.push(Resource::Image(ImageIndex(0)).into());
    let options = Options { demote: false, order: Order::File, ..Options::default() };
    let plan =
        compile(&frame, &device(true), &mut MemoryEstimate(&device(true)), &options).expect("the frame is valid");
    assert_eq!(verify(&plan), [], "{}", plan.tree());
    let barriers: Vec<bool> = scopes(&plan)[0].passes.iter().map(|pass| pass.local_barrier).collect();
    assert_eq!(barriers, [false, true, true], "{}", plan.tree());
    let mut without = plan;
    for step in &mut without.steps {
        if let plan::Work::Render(scope) = &mut step.work {
            scope.passes.iter_mut().filter(|pass| &*pass.name == "marks").for_each(|pass| pass.local_barrier = false);
        }
    }
    let [violation] = &verify(&without)[..] else { panic!("one violation") };
    assert!(violation.to_string().contains("albedo"), "{violation}");
}

#[test]
fn sizes_that_come_apart_or_together_part_or_join_scopes_where_a_local_read_depends_on_them() {
    let device = Arc::new(device(true));
    let options = Options { demote: false, ..Options::default() };
    let of = |light: u32| {
        let mut frame = deferred(1);
        frame.images[2..].iter_mut().for_each(|image| image.extent = [light, light, 1]);
        Arc::new(frame)
    };
    let mut compiler = Compiler::new();
    for (light, count) in [(64, 2), (32, 3), (16, 3), (64, 2)] {
        let frame = of(light);
        let plan =
            compiler.compile(&frame, &device, &mut MemoryEstimate(&device), &options).expect("the frame is valid");
        assert_eq!(
            *plan,
            compile(&frame, &device, &mut MemoryEstimate(&device), &options).expect("the frame is valid")
        );
        assert_eq!((scopes(plan).len(), compiler.reuse()), (count, Reuse::Nothing), "{light} texels");
    }
}

#[test]
fn a_program_s_own_draws_share_no_scope_in_which_colours_come_and_go() {
    // Pipelines of a program's own know one list of colours, in which the pass's own has location 0.
    let mut raster = Raster::default();
    let [albedo, lit] = ["albedo", "lit"].map(|name| raster.image(name, R8G8B8A8_UNORM, 1));
    raster.objects("geometry").clear(albedo);
    raster.full_screen("light").sample(albedo).color(lit, Blend::Replace);
    raster.full_screen("grass").color(lit, Blend::Alpha);
    let mut frame = raster.output(lit);
    frame.passes[1].sampled.iter_mut().for_each(|sampled| sampled.own_pixel = true);
    let colors = |frame: &Frame| -> Vec<(Vec<String>, usize)> {
        let plan = compiled(frame, &device(true));
        let names = |scope: &RenderScope| scope.passes.iter().map(|pass| pass.name.to_string()).collect();
        scopes(&plan).into_iter().map(|scope| (names(scope), scope.color().len())).collect()
    };
    let named = |names: &[&str]| names.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(colors(&frame), [(named(&["geometry", "light", "grass"]), 2)]);
    let Work::Draw { draw, .. } = &mut frame.passes[2].work else { panic!("it draws") };
    *draw = Draw::Custom;
    assert_eq!(colors(&frame), [(named(&["geometry", "light"]), 2), (named(&["grass"]), 1)]);
}
