//! What passes leave in images of a frame that a program draws (LV-5).

use crate::testing::{draw, renderer, renderer_with};
use framewright::graph::frame::CaptureName;
use framewright::vulkan::Error;
use framewright::{Change, Draw, DrawSource, Recorder, Renderer, RendererOptions};
use framewright_tests::render;

fn name(pass: &str, image: &str) -> CaptureName {
    CaptureName { pass: pass.into(), image: image.into(), mip: 0, layer: 0, stencil: false }
}

/// All that can be captured of the frame.
fn all(renderer: &mut Renderer) -> Vec<CaptureName> {
    renderer.captures().expect("planned").of_passes.iter().map(framewright::graph::frame::Capture::name).collect()
}

/// The pictures of six frames, of which one is captured with `wanted`.
fn pictures(renderer: &mut Renderer, captured: Option<usize>) -> Vec<Vec<u8>> {
    let mut pictures = vec![draw(renderer, 1).1];
    let (plan, plans) = (renderer.plan().cloned(), renderer.plans());
    for frame in 1..6 {
        let now = captured == Some(frame);
        if now {
            let wanted = all(renderer);
            renderer.capture(&wanted);
            assert!(renderer.captured().expect("read").is_none(), "no frame was drawn since");
        }
        let (change, picture) = draw(renderer, 1);
        assert_eq!(renderer.is_capturing(), now);
        if now {
            let Change::Executor { carried_over } = change else { panic!("{change:?}") };
            assert!(carried_over.iter().any(|name| name.contains("steady")), "{carried_over:?}");
            let texels = renderer.captured().expect("read").expect("drawn");
            let of_screen = texels.iter().rev().find(|(name, _)| *name.image == *"screen").expect("it is written");
            assert!(of_screen.1.as_ref().expect("captured").bytes == picture, "the texels are those of a readback");
            assert!(texels.iter().all(|(_, texels)| texels.is_ok()) && texels.len() > 5, "{}", texels.len());
        }
        pictures.push(picture);
    }
    assert!(renderer.plan().cloned() == plan && renderer.plans() == plans, "the Plan is the one of before");
    pictures
}

#[test]
fn lv_5_a_captured_frame_has_the_texels_of_a_readback_and_histories_go_on() {
    let Some(device) = render::device() else { return };
    let expected = pictures(&mut renderer(device, "temporal"), None);
    assert!(expected[4] != expected[5], "each frame is another one");
    let seen = pictures(&mut renderer(device, "temporal"), Some(3));
    assert!(expected == seen, "a capture changes no picture");
    render::silent(device).expect("silent");
}

#[test]
fn lv_5_what_can_not_be_captured_is_said_and_changes_nothing() {
    let Some(device) = render::device() else { return };
    let mut renderer = renderer(device, "forward");
    assert!(all(&mut renderer).is_empty(), "nothing is planned");
    let wanted = [name("nobody", "screen"), name("opaque", "nothing")];
    renderer.capture(&wanted);
    draw(&mut renderer, 1);
    let words = |renderer: &mut Renderer| -> Vec<String> {
        let told = renderer.captured().expect("read").expect("answered");
        told.into_iter().map(|(_, texels)| texels.expect_err("there is none")).collect()
    };
    assert_eq!(words(&mut renderer), ["no frame was drawn yet"; 2]);
    let plan = renderer.plan().cloned();
    renderer.capture(&wanted);
    assert_eq!(draw(&mut renderer, 1).0, Change::Nothing);
    assert!(!renderer.is_capturing() && renderer.plan().cloned() == plan);
    let told = words(&mut renderer);
    assert_eq!(told[0], "no pass `nobody` writes `screen`");
    assert_eq!(told[1], "no pass of the frame writes an image `nothing` that has a picture");
    // Another Plan before the frame.
    let wanted = all(&mut renderer)[..1].to_vec();
    renderer.capture(&wanted);
    assert!(renderer.prepare().expect("planned").plan.outputs.len() > 1);
    renderer.set("msaa", 2).expect("allowed");
    draw(&mut renderer, 1);
    assert_eq!(words(&mut renderer), ["the frame was planned anew before it was captured"]);
    // A wrong setting after the captures were taken: the Plan of before comes back all the same.
    renderer.capture(&wanted);
    draw(&mut renderer, 1);
    assert!(renderer.captured().expect("read").expect("drawn")[0].1.is_ok());
    renderer.set("msaa", 3).expect_err("no such value");
    draw(&mut renderer, 1);
    assert!(!renderer.is_capturing());
    render::silent(device).expect("silent");
}

struct Nothing;

impl DrawSource for Nothing {
    fn record(&mut self, _: Draw, _: &mut Recorder<'_>) -> Result<u32, Error> {
        Ok(0)
    }
}

#[test]
fn lv_5_a_frame_with_something_of_the_programs_is_not_captured() {
    let Some(device) = render::device() else { return };
    let text = r#"Pipeline(version: 1,
        images: [
            (name: "of_program", format: R8G8B8A8_UNORM, size: Output, lifetime: Imported(before: (stages: [FRAGMENT_SHADER], accesses: [SHADER_SAMPLED_READ], layout: SHADER_READ_ONLY_OPTIMAL))),
            (name: "screen", format: R8G8B8A8_UNORM, size: Output),
        ],
        passes: [(name: "show", draw: FullScreen("copy"), sample: {"source": "of_program"}, color: ["screen"])],
        outputs: ["screen"])"#;
    let mut renderer = Renderer::carried(device, "imports.ron", text, RendererOptions::default()).expect("it is right");
    renderer.set_extent([16, 16]).expect("allowed");
    renderer.frame(&mut Nothing).expect("drawn");
    let wanted = all(&mut renderer);
    assert_eq!(wanted, [name("show", "screen")]);
    renderer.capture(&wanted);
    renderer.frame(&mut Nothing).expect("drawn");
    let told = renderer.captured().expect("read").expect("answered");
    let why = told[0].1.as_ref().expect_err("refused");
    assert!(why.starts_with("the program imports `of_program`"), "{why}");
    render::silent(device).expect("silent");
}

#[test]
fn lv_5_depth_and_frames_in_flight_are_captured_too() {
    let Some(device) = render::device() else { return };
    let mut options = RendererOptions::default();
    options.executor.readback = true;
    let mut renderer = renderer_with(device, "forward", options);
    draw(&mut renderer, 3);
    let wanted: Vec<_> = all(&mut renderer).into_iter().filter(|name| *name.image == *"depth").collect();
    renderer.capture(&wanted);
    draw(&mut renderer, 3);
    let texels = renderer.captured().expect("read").expect("drawn");
    assert!(!texels.is_empty());
    for (name, texels) in texels {
        let bytes = texels.expect("captured").bytes;
        assert!(bytes.iter().any(|byte| *byte != bytes[0]), "{name:?} is drawn");
    }
    render::silent(device).expect("silent");
}
