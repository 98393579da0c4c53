//! Outputs that leave the frame rotated: what is drawn so with them, what stays upright, and what can't be.

use crate::testing::plans::{compiled, on};
use crate::testing::raster::{self, Raster};
use framewright_graph::base::Diagnostic;
use framewright_graph::compile::{Compiler, Options, Reuse};
use framewright_graph::device::MemoryEstimate;
use framewright_graph::frame::{Blend, Frame, Image, ImageIndex, Lifetime};
use framewright_graph::plan::{Cause, Plan, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Format::{D32_SFLOAT, R8G8B8A8_SRGB, R16G16B16A16_SFLOAT};
use framewright_graph::vulkan::{Accesses, FillValue, Layout, Rotation, Stages, State};
use std::sync::Arc;

const TURN: Rotation = Rotation::Rotate90;

fn refused(frame: &Frame) -> Diagnostic {
    let errors = on(frame, &raster::device()).expect_err("it is refused");
    let [error] = <[Diagnostic; 1]>::try_from(errors).expect("one mistake");
    error
}

/// Makes an image of a frame wider than it is high.
fn wide(frame: &mut Frame) {
    frame.images.iter_mut().for_each(|image| image.extent = [96, 64, 1]);
}

/// Names of images that are turned, in the Plan's order, each with its size.
fn turned(plan: &Plan) -> Vec<(&str, [u32; 2])> {
    let turned = plan.images.iter().filter(|image| image.rotation.turns());
    turned.map(|image| (&*image.name, [image.extent[0], image.extent[1]])).collect()
}

/// Names of passes of rendering scopes that the compiler inserted.
fn inserted(plan: &Plan) -> Vec<(String, String)> {
    let scopes = plan.steps.iter().filter_map(|step| match &step.work {
        Work::Render(scope) => Some(scope),
        _ => None,
    });
    let passes = scopes.flat_map(|scope| &scope.passes);
    let because = passes.filter_map(|pass| match &pass.cause {
        Cause::Inserted(why) => Some((pass.name.to_string(), why.because.clone())),
        Cause::Written(_) => None,
    });
    because.collect()
}

/// PR-1, PR-2: what is tone-mapped stays upright, the output alone is turned, and nothing is drawn or copied more.
#[test]
fn the_output_is_drawn_rotated_without_a_pass_more_and_what_is_read_stays_upright() {
    for rotation in Rotation::ALL {
        let mut frame = raster::forward(4, true, true);
        wide(&mut frame);
        let upright = compiled(&frame);
        frame.outputs[0].rotation = rotation;
        let plan = compiled(&frame);
        assert_eq!((plan.steps.len(), plan.totals.passes), (upright.steps.len(), upright.totals.passes));
        assert_eq!((plan.totals.copies, plan.totals.inserted_passes), (0, 0));
        match rotation {
            Rotation::Identity => assert_eq!(plan, upright),
            Rotation::Rotate180 => assert_eq!(turned(&plan), [("screen", [96, 64])]),
            Rotation::Rotate90 | Rotation::Rotate270 => assert_eq!(turned(&plan), [("screen", [64, 96])]),
        }
    }
}

/// PR-2: a resolve turns nothing, so what is resolved into the output is turned, and its depth.
#[test]
fn what_is_resolved_into_the_output_is_rotated_with_its_depth() {
    let mut frame = raster::forward(4, false, false);
    wide(&mut frame);
    frame.outputs[0].rotation = TURN;
    let plan = compiled(&frame);
    assert_eq!(turned(&plan), [("color", [64, 96]), ("depth", [64, 96]), ("screen", [64, 96])], "{}", plan.tree());
    assert_eq!((plan.totals.folded_resolves, plan.totals.inserted_passes), (1, 0));

    // The same image of several samples leaves the frame itself.
    let mut raster = Raster::default();
    let [screen, depth] =
        [("screen", R8G8B8A8_SRGB), ("depth", D32_SFLOAT)].map(|(name, format)| raster.image(name, format, 4));
    raster.objects("opaque").clear(screen).clear_depth(depth);
    let mut frame = raster.rotated(screen, TURN);
    wide(&mut frame);
    let plan = compiled(&frame);
    let all = [("screen", [64, 96]), ("depth", [64, 96]), ("screen (resolved)", [64, 96])];
    assert_eq!(turned(&plan), all, "{}", plan.tree());
}

/// PR-2: passes into other images aren't affected, and depth that is read keeps all that is drawn with it upright.
#[test]
fn an_output_whose_depth_is_read_is_drawn_upright_and_turned_at_the_end() {
    let mut raster = Raster::default();
    let [screen, color] = ["screen", "color"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    let depth = raster.image("depth", D32_SFLOAT, 1);
    raster.objects("opaque").clear(screen).clear_depth(depth);
    raster.full_screen("fog").sample(depth).color(color, Blend::Replace);
    raster.full_screen("mix").sample(color).color(screen, Blend::Alpha);
    let mut frame = raster.rotated(screen, TURN);
    wide(&mut frame);
    let plan = compiled(&frame);
    assert_eq!(turned(&plan), [("screen", [64, 96])], "{}", plan.tree());
    let why = "`screen` leaves the frame rotated by 90°, and `fog` samples `depth`; orientations differ";
    assert_eq!(inserted(&plan), [("screen (rotated)".to_owned(), why.to_owned())]);
}

/// PR-2: an effect in place reads the upright version before itself, and draws the one that leaves.
#[test]
fn an_output_that_is_drawn_anew_is_upright_until_then() {
    let mut raster = Raster::default();
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    let depth = raster.image("depth", D32_SFLOAT, 1);
    raster.objects("opaque").clear(screen).clear_depth(depth);
    raster.full_screen("sharpen").sample(screen).color(screen, Blend::Replace);
    raster.full_screen("grain").color(screen, Blend::Alpha);
    let mut frame = raster.rotated(screen, TURN);
    wide(&mut frame);
    let plan = compiled(&frame);
    assert_eq!(turned(&plan), [("screen", [64, 96])], "{}", plan.tree());
    assert_eq!((plan.totals.passes, plan.totals.inserted_passes), (3, 0), "{}", plan.tree());
    let all: Vec<&str> = plan.images.iter().map(|image| &*image.name).collect();
    assert_eq!(all, ["screen (upright)", "depth", "screen"]);
}

/// An image that stays from frame to frame and is read again is upright; a second image leaves the frame.
#[test]
fn an_output_with_history_stays_upright_beside_a_rotated_one() {
    let mut raster = Raster::default();
    let screen = raster.image("screen", R16G16B16A16_SFLOAT, 1);
    raster.full_screen("blend").sample(screen).color(screen, Blend::Replace);
    let mut frame = raster.rotated(screen, TURN);
    wide(&mut frame);
    let initial = FillValue::Color([0.0; 4]);
    frame.images[0].lifetime = Lifetime::History { frames: 1, initial };
    frame.passes[0].sampled[0].frames_ago = 1;
    let plan = compiled(&frame);
    assert_eq!(turned(&plan), [("screen", [64, 96])], "{}", plan.tree());
    assert_eq!(plan.images.len(), 3);
}

/// PR-2: a dumped or otherwise further output is not for a screen, so what it is drawn with stays upright.
#[test]
fn other_outputs_stay_upright() {
    let mut frame = raster::forward(1, false, false);
    wide(&mut frame);
    frame.outputs[0].rotation = TURN;
    let mut both = frame.clone();
    let color = framewright_graph::frame::Resource::Image(ImageIndex(0));
    both.outputs.push(framewright_graph::frame::Output {
        resource: color,
        rotation: Rotation::Identity,
        ..frame.outputs[0].clone()
    });
    assert_eq!(turned(&compiled(&frame)).len(), 2, "one image of both names, and its depth");
    let plan = compiled(&both);
    assert_eq!(turned(&plan), [("screen", [64, 96])], "{}", plan.tree());
}

/// PR-7: the back buffer beside another target.
#[test]
fn an_output_beside_other_targets_is_refused_by_name() {
    let mut raster = Raster::default();
    let [screen, ids] = ["screen", "ids"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    let depth = raster.image("depth", D32_SFLOAT, 1);
    raster.objects("opaque").clear(screen).clear(ids).clear_depth(depth);
    let frame = raster.rotated(screen, TURN);
    let error = refused(&frame);
    let expected = "`opaque` draws into `screen`, which leaves the frame rotated by 90°, and into `ids`, which doesn't";
    assert_eq!(error.message, expected);
    assert!(error.help.is_some_and(|help| help.contains("another pass from that into `screen`")));
    let mut both = frame.clone();
    both.outputs.push(framewright_graph::frame::Output {
        resource: framewright_graph::frame::Resource::Image(ids),
        ..frame.outputs[0].clone()
    });
    assert_eq!(turned(&compiled(&both)).len(), 3, "both are shown");
    let mut upright = frame;
    upright.outputs[0].rotation = Rotation::Identity;
    compiled(&upright);
}

/// PR-6: a shader that can't draw what is turned is a mistake where it draws the back buffer, and keeps upright what is only
/// forwarded to it.
#[test]
fn a_shader_that_knows_of_no_rotation_is_refused_where_it_draws_the_back_buffer() {
    let why = || Some("has the shader `fog`, which reads `gl_FragCoord`".into());
    let mut frame = raster::forward(1, true, true);
    frame.outputs[0].rotation = TURN;
    frame.passes[3].no_rotation = why();
    let error = refused(&frame);
    let expected =
        "`tonemap` has the shader `fog`, which reads `gl_FragCoord`; it draws into `screen`, which is rotated by 90°";
    assert_eq!(error.message, expected);

    let mut frame = raster::forward(1, false, false);
    frame.outputs[0].rotation = TURN;
    frame.passes[1].no_rotation = why();
    let plan = compiled(&frame);
    assert_eq!(turned(&plan), [("screen", [64, 64])], "{}", plan.tree());
    assert_eq!(plan.totals.inserted_passes, 1);
}

/// PR-2: neither matters where the output is read and so stays upright, be it by a later pass.
#[test]
fn what_could_not_be_drawn_rotated_is_no_mistake_where_a_later_pass_reads_the_output_or_its_depth() {
    let why = Some("has the shader `opaque`, which reads `gl_FragCoord`".into());
    for (reads_depth, beside) in [(false, false), (false, true), (true, false), (true, true)] {
        let mut raster = Raster::default();
        let [screen, color, ids] = ["screen", "color", "ids"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
        let depth = raster.image("depth", D32_SFLOAT, 1);
        let opaque = raster.objects("opaque").clear(screen).clear_depth(depth);
        if beside {
            opaque.clear(ids);
        }
        raster.full_screen("fog").sample(if reads_depth { depth } else { screen }).color(color, Blend::Replace);
        raster.full_screen("mix").sample(color).color(screen, Blend::Alpha);
        let mut frame = raster.outputs(&[screen, ids][..1 + usize::from(beside)]);
        frame.outputs[0].rotation = TURN;
        wide(&mut frame);
        if !beside {
            frame.passes[0].no_rotation.clone_from(&why);
        }
        let plan = compiled(&frame);
        assert_eq!(turned(&plan), [("screen", [64, 96])], "{}", plan.tree());
        let read = if reads_depth { "depth" } else { "screen" };
        let why = format!("`screen` leaves the frame rotated by 90°, and `fog` samples `{read}`; orientations differ");
        assert_eq!(inserted(&plan), [("screen (rotated)".to_owned(), why)]);
    }
}

/// An image that is handed in is as it is: nobody turned it before.
#[test]
fn what_is_handed_in_stays_upright_where_it_is_forwarded_to_the_output() {
    let state = State { stages: Stages::COPY, accesses: Accesses::TRANSFER_WRITE, layout: Layout::TransferDstOptimal };
    let mut raster = Raster::default();
    let [picture, screen] = ["picture", "screen"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
    raster.objects("overlay").clear(picture);
    raster.forward("anti_aliasing", picture, screen);
    let mut frame = raster.rotated(screen, TURN);
    wide(&mut frame);
    let plan = compiled(&frame);
    assert_eq!(turned(&plan), [("screen", [64, 96])], "one image of both names");
    frame.images[0].lifetime = Lifetime::Imported { before: state, after: None, owner: None };
    frame.passes[0].color[0].clear = None;
    let plan = compiled(&frame);
    assert_eq!(turned(&plan), [("screen", [64, 96])], "{}", plan.tree());
    assert_eq!((plan.images.len(), plan.totals.inserted_passes), (2, 1), "{}", plan.tree());
}

/// What was presented is turned already: a picture over it is turned like it.
#[test]
fn what_is_drawn_over_a_presented_image_is_rotated_with_it() {
    let presented = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::PresentSrcKhr };
    let over = |reads: bool| {
        let mut raster = Raster::default();
        let [list, screen] = ["list", "screen"].map(|name| raster.image(name, R8G8B8A8_SRGB, 1));
        raster.objects("draw_list").clear(list);
        if reads {
            raster.full_screen("blur_below").sample(screen).clear(list);
        }
        raster.full_screen("show_list").sample(list).color(screen, Blend::Alpha);
        let mut frame = raster.rotated(screen, TURN);
        wide(&mut frame);
        frame.images[1].lifetime = Lifetime::Imported { before: presented, after: Some(presented), owner: None };
        frame
    };
    let plan = compiled(&over(false));
    assert_eq!(turned(&plan), [("screen", [64, 96])], "{}", plan.tree());
    assert_eq!((plan.totals.passes, plan.totals.inserted_passes), (2, 0), "{}", plan.tree());
    let read = refused(&over(true)).message;
    assert_eq!(read, "`screen` is handed in rotated by 90°, and `blur_below` samples `screen`");
}

#[test]
fn depth_contents_from_outside_and_what_is_turned_already_are_refused() {
    let wrong = |change: &dyn Fn(&mut Frame)| {
        let mut frame = raster::forward(1, true, true);
        frame.outputs[0].rotation = TURN;
        change(&mut frame);
        refused(&frame).message
    };
    let state = State { stages: Stages::COPY, accesses: Accesses::TRANSFER_WRITE, layout: Layout::TransferDstOptimal };
    let lifetime = Lifetime::Imported { before: state, after: None, owner: None };
    let contents = wrong(&|frame| frame.images[2].lifetime = lifetime.clone());
    assert_eq!(
        contents,
        "`screen` leaves the frame rotated by 90°, and is handed in with contents: nobody could tell how they are turned"
    );
    let depth = wrong(&|frame| {
        frame.outputs[0].resource = framewright_graph::frame::Resource::Image(ImageIndex(1));
    });
    assert_eq!(depth, "`depth` leaves the frame rotated by 90°, and holds depth: only colour can be rotated");
    let already = wrong(&|frame| frame.images[2].rotation = TURN);
    assert_eq!(already, "`screen` is turned, which only the compiler does");
}

/// A copy turns nothing; the checker says so of a Plan in which one should.
#[test]
fn a_copy_between_images_that_are_rotated_otherwise_is_caught() {
    let mut raster = Raster::default();
    let screen = raster.image("screen", R8G8B8A8_SRGB, 1);
    raster.objects("opaque").clear(screen);
    raster.full_screen("tint").sample(screen).color(screen, Blend::Alpha);
    let mut plan = compiled(&raster.output(screen));
    assert_eq!(plan.totals.copies, 1);
    plan.images[0].rotation = Rotation::Rotate180;
    let said = verify(&plan).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    assert!(said.contains("`screen (copy)`: is copied, and rotated on only one side"), "{said}");
}

/// A Plan that was compiled for one rotation serves for other sizes of it, and not for another rotation.
#[test]
fn a_frame_of_another_size_is_rotated_again_and_gives_what_compiling_anew_gives() {
    let device = Arc::new(raster::device());
    let mut compiler = Compiler::new();
    let mut compile_next = |frame: Frame| {
        let frame = Arc::new(frame);
        let plan = compiler
            .compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default())
            .expect("valid")
            .clone();
        assert_eq!(plan, compiled(&frame));
        let same = compiler
            .compile(&frame, &device, &mut MemoryEstimate(&device), &Options::default())
            .expect("valid")
            .clone();
        assert_eq!((plan.images.len(), compiler.reuse()), (same.images.len(), Reuse::Everything));
        plan
    };
    let frame = |extent: [u32; 3], rotation| {
        let mut frame = raster::forward(4, true, true);
        frame.images.iter_mut().for_each(|image: &mut Image| image.extent = extent);
        frame.outputs[0].rotation = rotation;
        frame
    };
    let first = compile_next(frame([96, 64, 1], TURN));
    assert_eq!(turned(&first), [("screen", [64, 96])]);
    let second = compile_next(frame([80, 60, 1], TURN));
    assert_eq!(turned(&second), [("screen", [60, 80])]);
    let third = compile_next(frame([80, 60, 1], Rotation::Rotate180));
    assert_eq!(turned(&third), [("screen", [80, 60])]);
}
