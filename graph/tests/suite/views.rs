//! The views of a frame: what a frame may say of them, and what a Plan says then.

use crate::testing::plans::compiled;
use crate::testing::raster::{self, Raster};
use framewright_graph::base::Span;
use framewright_graph::compile::{Compiler, Options, Reuse, compile};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::{Allowances, Blend, Frame, View, ViewIndex};
use framewright_graph::plan::{Plan, ViewId, Work};
use framewright_graph::vulkan::Format;
use std::sync::Arc;

fn view(name: &str, extent: [u32; 2], camera: Option<&str>) -> View {
    let (camera, allows) = (camera.map(Into::into), Allowances::default());
    View { name: name.into(), span: Span::NONE, extent, camera, allows, jitter: None, eye: None }
}

/// Two pictures, drawn for a view each, one after the other in one image.
fn frame() -> Frame {
    let mut raster = Raster::default();
    let screen = raster.image("screen", Format::R8G8B8A8_SRGB, 1);
    raster.objects("all").clear(screen);
    raster.objects("map").color(screen, Blend::Alpha);
    let mut frame = raster.output(screen);
    let preview = Allowances { msaa: false, hdr: false, ..Allowances::default() };
    frame.views = vec![view("main", [64, 64], None), View { allows: preview, ..view("map", [32, 16], Some("top")) }];
    frame.passes[1].view = ViewIndex(1);
    frame
}

fn views_of_passes(plan: &Plan) -> Vec<Option<ViewId>> {
    let passes = plan.steps.iter().filter_map(|step| match &step.work {
        Work::Render(scope) => Some(scope.passes.iter().map(|pass| pass.view)),
        _ => None,
    });
    passes.flatten().collect()
}

#[test]
fn each_pass_names_its_view_and_the_plan_lists_them() {
    let plan = compiled(&frame());
    assert_eq!(views_of_passes(&plan), [Some(ViewId(0)), Some(ViewId(1))]);
    let json = plan.to_json().expect("it has one");
    assert_eq!(Plan::from_json(&json).expect("it is read"), plan);
    let tree = plan.tree();
    for said in ["`main` 64×64, default camera", "`map` 32×16, camera `top`, without MSAA, HDR", "for view `map`"] {
        assert!(tree.contains(said), "{said}\n{tree}");
    }
    assert!(Plan::from_json(&json.replace("\"view\": 1", "\"view\": 2")).is_err(), "there are two");
}

#[test]
fn a_frame_without_views_makes_a_plan_without() {
    let mut frame = frame();
    frame.views.clear();
    frame.passes[1].view = ViewIndex(0);
    let plan = compiled(&frame);
    assert_eq!((plan.views.len(), views_of_passes(&plan)), (0, vec![None, None]));
}

#[test]
fn views_have_names_of_their_own_and_sizes_and_exist() {
    let refused = |change: fn(&mut Frame)| {
        let (mut frame, device) = (frame(), raster::device());
        change(&mut frame);
        let errors =
            compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default()).expect_err("it is wrong");
        errors.into_iter().map(|error| error.message).collect::<Vec<_>>()
    };
    assert_eq!(refused(|frame| frame.views[1].name = "main".into()), ["two views are named `main`"]);
    assert_eq!(refused(|frame| frame.views[1].extent[0] = 0), ["view `map` is 0×16; each side has at least 1 texel"]);
    let missing = ["`map` draws for view number 1, which does not exist"];
    assert_eq!(refused(|frame| frame.views.truncate(1)), missing);
    assert_eq!(refused(|frame| frame.views.clear()), missing);
}

#[test]
fn another_size_and_another_camera_of_a_view_are_compiled_anew() {
    let (device, options) = (Arc::new(raster::device()), Options::default());
    let mut compiler = Compiler::new();
    let mut reuse = |frame: &Frame| {
        let plan = compiler.compile(&Arc::new(frame.clone()), &device, &mut MemoryEstimate(&device), &options);
        assert_eq!(*plan.expect("a Plan"), compiled(frame));
        compiler.reuse()
    };
    let mut frame = frame();
    reuse(&frame);
    frame.views[1].extent = [48, 16];
    assert_eq!(reuse(&frame), Reuse::Nothing);
    frame.views[1].camera = None;
    assert_eq!(reuse(&frame), Reuse::Nothing);
}

#[test]
fn a_compiler_that_remembers_the_last_frame_refuses_a_view_without_texels_too() {
    let (device, options) = (Arc::new(raster::device()), Options::default());
    let mut compiler = Compiler::new();
    let mut compile = |frame: Frame| {
        let plan = compiler.compile(&Arc::new(frame), &device, &mut MemoryEstimate(&device), &options);
        plan.map(|_| ()).map_err(|errors| errors.into_iter().map(|error| error.message).collect::<Vec<_>>())
    };
    let (whole, mut empty) = (frame(), frame());
    empty.views[1].extent[0] = 0;
    assert_eq!(compile(whole), Ok(()));
    assert_eq!(compile(empty), Err(vec!["view `map` is 0×16; each side has at least 1 texel".to_owned()]));
}
