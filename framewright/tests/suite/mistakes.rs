//! What is wrong is an error with data, and the renderer goes on (EM-1).

use crate::testing::{EXTENT, Place, draw, renderer};
use framewright::vulkan::Blame;
use framewright::{Error, Renderer, RendererOptions, load_scene};
use framewright_tests::render;

#[test]
fn a_wrong_choice_is_an_error_of_its_call_and_changes_nothing() {
    let Some(device) = render::device() else { return };
    let mut renderer = renderer(device, "forward");
    let (_, picture) = draw(&mut renderer, 1);
    for (error, said) in [
        (renderer.set("masa", 4), "there is no setting named `masa`"),
        (renderer.set("msaa", 3), "`msaa`"),
        (renderer.set("white_point", f64::NAN), "`white_point`"),
        (renderer.set("hdr", "maybe"), "`hdr`"),
        (renderer.preset(Some("best")), "`best`"),
        (renderer.set_extent([0, 1]), "the frame can't be 0×1"),
        (renderer.set_extent([1, 20_000]), "the frame can't be 1×20000"),
    ] {
        let error = error.expect_err(said);
        assert!(error.to_string().contains(said), "{said}: {error}");
        assert_eq!(error.diagnostics().map(|(_, mistakes)| mistakes.len()), Some(1), "{error}");
        assert_eq!(format!("{error:?}"), error.to_string(), "a main that returns it prints it");
    }
    assert_eq!(draw(&mut renderer, 1), (framewright::Change::Nothing, picture));
}

/// Values that are allowed by themselves, and not together.
#[test]
fn choices_that_no_plan_can_be_made_for_go_back_to_the_last_good_ones() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let text = r#"Pipeline(version: 1, settings: [
            (name: "width", value: Integer(default: 4, min: 1, max: 4)), (name: "less", value: Integer(default: 0, min: 0, max: 3))],
        images: [(name: "wide", format: Color(hdr: false), size: Fixed("width - less", 4)), (name: "screen", format: Output, size: Output)],
        passes: [(name: "opaque", draw: Objects(Opaque), shader: "lit", color: [(image: "wide", clear: (0.0, 0.0, 0.0, 1.0))]),
            (name: "show", draw: FullScreen("copy"), sample: {"source": "wide"}, color: ["screen"])],
        outputs: ["screen"])"#;
    let mut renderer = renderer(device, place.file("wide.ron", text));
    let (_, picture) = draw(&mut renderer, 1);
    renderer.set("width", 2).expect("allowed by itself");
    renderer.set("less", 2).expect("allowed by itself");
    let error = renderer.prepare().map(drop).expect_err("no image has no width");
    assert!(error.to_string().contains("wide.ron:3:"), "{error}");
    assert_eq!(draw(&mut renderer, 1), (framewright::Change::Nothing, picture.clone()));
    renderer.set("less", 1).expect("allowed");
    assert_eq!(renderer.prepare().expect("planned").plan.settings[0].value, "4", "both went back");
}

#[test]
fn what_is_not_there_is_told_with_what_is() {
    let Some(device) = render::device() else { return };
    let open = |name: &str| Renderer::open(device, name, RendererOptions::default()).map(drop);
    let error = open("forwards").expect_err("there is none");
    assert!(
        matches!(&error, Error::Missing { what: "pipeline", shipped, .. } if shipped.contains(&"forward")),
        "{error}"
    );
    assert!(error.to_string().contains("there is no pipeline `forwards`"), "{error}");
    assert!(matches!(load_scene("spheres"), Err(Error::Missing { what: "scene", .. })));
    let place = Place::new();
    let binary = place.file("binary.ron", [0xff, 0xfe]);
    let error = open(&binary.to_string_lossy()).expect_err("no text");
    assert!(error.to_string().contains("this is not a text file"), "{error}");
    assert!(matches!(open(&place.path("").to_string_lossy()), Err(Error::Unreadable { .. })), "a folder");

    let mut renderer = renderer(device, "forward");
    assert!(matches!(renderer.read("screen"), Err(Error::Vulkan(error)) if error.blame() == Blame::Program));
    assert!(renderer.wait(0).is_err() && renderer.report(0).is_err());
    draw(&mut renderer, 1);
    let error = renderer.read("scren").map(drop).expect_err("there is none");
    assert_eq!(error.to_string(), "there is no output `scren`: there are `screen`");
}

#[test]
fn mistakes_in_files_are_told_with_their_places() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let file = place.file("mine.ron", "Pipeline(\n    version: 1,\n    extends: \"forwards.ron\",\n)\n");
    let error = Renderer::open(device, &file, RendererOptions::default()).map(drop).expect_err("wrong");
    assert!(error.to_string().contains("mine.ron:3:14"), "{error}");
    let (sources, mistakes) = error.diagnostics().expect("mistakes");
    let place = sources.place(mistakes[0].labels[0].span).expect("in the file");
    assert_eq!((place.line, place.column), (3, 14));
}

#[test]
fn a_scene_without_draws_of_its_own_is_an_error_of_the_draw_source() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let text = r#"Pipeline(version: 1, images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "mine", custom: "mine", writes: ["screen"])], outputs: ["screen"])"#;
    let mut renderer = renderer(device, place.file("custom.ron", text));
    let plan = renderer.prepare().expect("planned").plan;
    let mut objects =
        framewright::SceneDrawSource::for_plan(device, &crate::testing::scene(), EXTENT, plan).expect("uploaded");
    let error = renderer.frame(&mut objects).expect_err("nobody records it");
    assert!(error.to_string().contains("nobody records `mine`"), "{error}");
}
