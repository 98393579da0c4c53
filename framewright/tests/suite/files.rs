//! A program finds the files of a pipeline as the command does (EM-1).

use crate::testing::{Place, draw, renderer, renderer_with};
use framewright::passes::shipped;
use framewright::{Error, Reach, Renderer, RendererOptions, Root};
use framewright_tests::render;
use std::path::PathBuf;

#[test]
fn every_shipped_pipeline_is_opened_by_its_name() {
    let Some(device) = render::device() else { return };
    for name in shipped::names(shipped::PIPELINES) {
        let mut renderer = renderer(device, name);
        assert!(renderer.prepare().is_ok_and(|prepared| !prepared.plan.steps.is_empty()), "{name}");
    }
}

#[test]
fn a_pipeline_of_the_program_includes_and_extends_what_is_shipped_and_what_lies_beside_it() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    place.file(
        "parts/tint.frag",
        "#version 460\nlayout(set = 0, binding = 0) uniform sampler2D source;\n\
        layout(location = 0) out vec4 color;\n\
        void main() { color = vec4(texelFetch(source, ivec2(gl_FragCoord.xy), 0).r, 0.0, 0.0, 1.0); }\n",
    );
    place.file(
        "parts/tint.ron",
        r#"Fragments(version: 1, fragments: [(name: "tint",
        parameters: [(name: "source", value: Image), (name: "target", value: Image)],
        passes: [(name: "tint", draw: FullScreen("tint"), sample: {"source": (image: "source", filter: Nearest)},
            color: ["target"])])])"#,
    );
    let text = r#"Pipeline(version: 1, extends: "forward.ron", include: ["library/bloom.ron", "parts/tint.ron"],
        images: [(name: "bloomed", format: Like("color"), size: Like("color")),
            (name: "shown", format: Like("screen"), size: Like("screen"))],
        changes: [
            Insert(before: "tone_map", passes: [(use: "bloom", name: "glow",
                with: {"source": "color", "target": "bloomed", "strength": 0.2})]),
            Set(pass: "tone_map", to: (sample: {"source": (image: "bloomed", filter: Nearest)}, color: ["shown"],
                otherwise: Forward(from: "bloomed", to: "shown"))),
            Insert(after: "tone_map", passes: [(use: "tint", name: "red", with: {"source": "shown", "target": "screen"})]),
        ])"#;
    let mut renderer = renderer(device, place.file("mine.ron", text));
    let (_, picture) = draw(&mut renderer, 1);
    assert!(picture.as_chunks::<4>().0.iter().all(|texel| texel[1..3] == [0, 0]));
    assert!(picture.as_chunks::<4>().0.iter().any(|texel| texel[0] > 50));
    render::silent(device).expect("silent");
}

#[test]
fn pictures_beside_a_pipeline_are_its_textures() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    image::RgbaImage::from_pixel(2, 2, image::Rgba([10, 200, 30, 255])).save(place.path("green.png")).expect("written");
    let text = r#"Pipeline(version: 1,
        textures: [(name: "green", file: "green.png")],
        images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "show", draw: FullScreen("copy"), sample: {"source": "green"}, color: ["screen"])],
        outputs: ["screen"])"#;
    let mut renderer = renderer(device, place.file("picture.ron", text));
    assert_eq!(draw(&mut renderer, 1).1[..4], [10, 200, 30, 255]);
}

#[test]
fn files_outside_of_the_folder_are_read_only_where_that_is_allowed() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    place.file("base.ron", "Pipeline(version: 1, extends: \"forward.ron\")\n");
    let inner = place.file("inner/mine.ron", "Pipeline(version: 1, extends: \"../base.ron\")\n");
    let open = |reach: Reach| {
        let mut options = RendererOptions::default();
        options.files.reach = reach;
        Renderer::open(device, &inner, options).map(drop)
    };
    let error = open(Reach::OwnFolder).expect_err("outside");
    assert!(error.to_string().contains("leads out of"), "{error}");
    open(Reach::Within(place.path(""))).expect("within");
    open(Reach::Anywhere).expect("anywhere");
    place.file("other/file", "");
    assert!(matches!(open(Reach::Within(place.path("other"))), Err(Error::OutsideRoot { .. })));
}

#[test]
fn extensions_and_settings_files_are_options_and_further_images_can_be_read() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let mut options = RendererOptions::default();
    options.files.extensions = vec![place.file("more.ron", r#"Extension(version: 1, changes: [Remove(pass: "sky")])"#)];
    options.settings = vec![place.file("chosen.ron", r#"Settings(version: 1, set: {"msaa": 2})"#)];
    let mut renderer = renderer_with(device, "forward", options.clone());
    let wrong = renderer.set_dump(&["depht"]).expect_err("no image").to_string();
    assert!(wrong.contains("there is no image named `depht` to dump"), "{wrong}");
    renderer.set_dump(&["depth"]).expect("an image");
    let plan = renderer.prepare().expect("planned").plan;
    assert!(!plan.tree().contains("`sky` draws"), "{}", plan.tree());
    assert!(plan.settings.iter().any(|used| *used.name == *"msaa" && used.value == "2"), "{:?}", plan.settings);
    draw(&mut renderer, 1);
    assert_eq!(renderer.read("depth").expect("it leaves the frame").extent[..2], crate::testing::EXTENT);
    options.settings = vec![PathBuf::from("none.ron")];
    assert!(matches!(Renderer::open(device, "forward", options), Err(Error::Unreadable { what: "settings file", .. })));
}

/// What a program carries within itself: with shipped fragments, and with mistakes at their places.
#[test]
fn a_pipeline_is_read_from_a_text() {
    let Some(device) = render::device() else { return };
    let carried = |text: &str| Renderer::carried(device, "within", text, RendererOptions::default());
    let text = r#"Pipeline(version: 1, extends: "forward.ron", include: ["library/overlay.ron"], changes: [
        Insert(at: "overlays", passes: [(use: "overlay", name: "show", with: {"shown": "depth", "target": "screen"})])])"#;
    let mut renderer = carried(text).expect("it is right");
    renderer.set_extent([64, 36]).expect("allowed");
    let (_, picture) = draw(&mut renderer, 1);
    assert!(!renderer.files_changed());
    renderer.reload().expect("it is there");
    assert_eq!(draw(&mut renderer, 1).1, picture);
    assert_eq!(draw(&mut renderer.try_clone().expect("it is there"), 1).1, picture);
    assert!(!renderer.is_shipped());
    let error = carried(&text.replace("forward.ron", "mine.ron")).map(drop).expect_err("no such file").to_string();
    assert!(error.contains("within:1:31") && error.contains("mine.ron"), "{error}");
}

/// The files beside a text of the program's own: extensions, settings, and the shaders of a folder.
#[test]
fn files_beside_a_pipeline_of_the_program_count_and_are_followed() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let shader = |red: &str| {
        format!(
            "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() {{ color = vec4({red}, 0.0, 0.0, 1.0); }}\n"
        )
    };
    place.file("red.frag", shader("1.0"));
    let extension = |name: &str| {
        format!(
            r#"Extension(version: 1, changes: [Insert(after: "tone_map", passes: [
                (name: "{name}", draw: FullScreen("red"), color: ["screen"])])])"#
        )
    };
    let settings = |msaa: u32| format!(r#"Settings(version: 1, set: {{"msaa": {msaa}}})"#);
    let mut options = RendererOptions::default();
    options.files.extensions = vec![place.file("more.ron", extension("first"))];
    options.settings = vec![place.file("chosen.ron", settings(2))];
    options.shaders = vec![Root::new(place.path(""))];
    let text = r#"Pipeline(version: 1, extends: "forward.ron")"#;
    let mut renderer = Renderer::carried(device, "within", text, options.clone()).expect("it is right");
    renderer.set_extent([64, 36]).expect("allowed");
    assert_eq!(draw(&mut renderer, 1).1[..4], [255, 0, 0, 255]);
    let plan = renderer.plan().expect("drawn");
    assert!(plan.settings.iter().any(|used| *used.name == *"msaa" && used.value == "2"), "{:?}", plan.settings);
    for (file, changed) in [("more.ron", extension("second")), ("chosen.ron", settings(4)), ("red.frag", shader("0.5"))]
    {
        assert!(!renderer.files_changed(), "{file}");
        place.file(file, &changed);
        assert!(renderer.files_changed(), "{file}");
        renderer.reload().expect("it is right");
    }
    assert!((180..195).contains(&draw(&mut renderer, 1).1[0]), "half of the light");
    let tree = renderer.plan().expect("drawn").tree();
    assert!(tree.contains("`second`") && !tree.contains("`first`"), "{tree}");
    options.files.extensions = vec![PathBuf::from("none.ron")];
    let refused = Renderer::carried(device, "within", text, options).map(drop);
    assert!(matches!(refused, Err(Error::Unreadable { what: "extension", .. })), "{refused:?}");
}
