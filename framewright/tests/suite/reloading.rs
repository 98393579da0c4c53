//! Files that change while they are drawn (EM-1).

use crate::testing::{Place, draw, renderer, renderer_with};
use framewright::{Change, RendererOptions};
use framewright_tests::render;

/// Extends a shipped pipeline.
fn extending(changes: &str) -> String {
    format!(
        "Pipeline(version: 1, extends: \"forward.ron\", include: [\"library/overlay.ron\"], changes: [{changes}])\n"
    )
}

const OVERLAY: &str = r#"Insert(at: "overlays", passes: [
    (use: "overlay", name: "show", with: {"shown": "depth", "target": "screen", "farthest": 20.0}),
])"#;

#[test]
fn a_file_that_changes_is_drawn_as_it_is_then() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let file = place.file("mine.ron", extending(""));
    let mut renderer = renderer(device, &file);
    let (_, plain) = draw(&mut renderer, 1);
    assert!(!renderer.files_changed());
    place.file("mine.ron", extending(OVERLAY));
    assert!(renderer.files_changed());
    assert_eq!(draw(&mut renderer, 1), (Change::Nothing, plain.clone()), "nothing is read before it is asked for");
    assert!(matches!(renderer.reload().expect("right"), Change::Executor { .. }));
    assert!(!renderer.files_changed());
    let (change, overlaid) = draw(&mut renderer, 1);
    assert_eq!(change, Change::Nothing, "a reload plans");
    assert_ne!(plain, overlaid);
    render::silent(device).expect("silent");
}

#[test]
fn mistakes_leave_what_is_drawn_until_they_are_mended() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let file = place.file("mine.ron", extending(""));
    let mut renderer = renderer(device, &file);
    renderer.set("white_point", 3).expect("allowed");
    let (_, plain) = draw(&mut renderer, 1);
    for (text, said) in [
        ("Pipeline(".to_owned(), "mine.ron:1:"),
        (extending(&OVERLAY.replace("library", "")).replace("overlay.ron", "overlays.ron"), "mine.ron:1:"),
        (extending(&OVERLAY.replace("overlay\"", "overlap\"")), "did you mean `overlay`?"),
        // Found by the reader of shaders, when the frame is expanded.
        (extending(r#"Set(pass: "tone_map", to: (draw: FullScreen("tone_mop")))"#), "tone_mop"),
    ] {
        place.file("mine.ron", text);
        assert!(renderer.files_changed());
        let error = renderer.reload().expect_err("wrong");
        assert!(error.to_string().contains(said), "{said}: {error}");
        assert!(error.diagnostics().is_some_and(|(_, mistakes)| !mistakes.is_empty()));
        assert!(!renderer.files_changed(), "a mistake is told once");
        assert_eq!(draw(&mut renderer, 1), (Change::Nothing, plain.clone()), "{said}");
        // Choices are still those of the pipeline that is drawn.
        renderer.set("white_point", 2).expect("allowed");
        assert_eq!(draw(&mut renderer, 1).0, Change::Values, "{said}");
        renderer.set("white_point", 3).expect("allowed");
        assert_eq!(draw(&mut renderer, 1), (Change::Values, plain.clone()), "{said}");
    }
    place.file("mine.ron", extending(OVERLAY));
    assert!(renderer.files_changed());
    renderer.reload().expect("mended");
    assert_ne!(draw(&mut renderer, 1).1, plain);
    render::silent(device).expect("silent");
}

#[test]
fn a_choice_before_a_reload_that_fails_is_kept() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let mut renderer = renderer(device, place.file("mine.ron", extending("")));
    draw(&mut renderer, 1);
    renderer.set("msaa", 1).expect("allowed");
    place.file("mine.ron", "Pipeline(");
    renderer.reload().expect_err("wrong");
    let (change, picture) = draw(&mut renderer, 1);
    assert!(matches!(change, Change::Executor { .. }));
    let mut other = crate::testing::renderer(device, "forward");
    other.set("msaa", 1).expect("allowed");
    assert_eq!(picture, draw(&mut other, 1).1);
}

#[test]
fn a_setting_that_the_file_loses_waits_until_it_is_back() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let with = extending("").replace("changes", "settings: [(name: \"mine\", value: Bool(default: false))], changes");
    let mut renderer = renderer(device, place.file("mine.ron", &with));
    renderer.set("mine", true).expect("it has it");
    let in_force = |renderer: &mut framewright::Renderer| {
        let plan = renderer.prepare().expect("planned").plan;
        plan.settings.iter().find(|used| *used.name == *"mine").map(|used| used.value.clone())
    };
    assert_eq!(in_force(&mut renderer).as_deref(), Some("true"));
    place.file("mine.ron", extending(""));
    renderer.reload().expect("right");
    assert_eq!(in_force(&mut renderer), None);
    renderer.set("mine", true).expect_err("it doesn't have it now");
    place.file("mine.ron", &with);
    renderer.reload().expect("right");
    assert_eq!(in_force(&mut renderer).as_deref(), Some("true"));
}

#[test]
fn a_shader_that_changes_is_compiled_anew_though_the_plan_is_the_same() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let shader = |color: &str| {
        format!("#version 460\nlayout(location = 0) out vec4 color;\nvoid main() {{ color = {color}; }}\n")
    };
    place.file("flat.frag", shader("vec4(1.0, 0.0, 0.0, 1.0)"));
    let text = r#"Pipeline(version: 1, images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "flat", draw: FullScreen("flat"), color: ["screen"])], outputs: ["screen"])"#;
    let mut renderer = renderer(device, place.file("flat.ron", text));
    assert_eq!(draw(&mut renderer, 1).1[..4], [255, 0, 0, 255]);
    place.file("flat.frag", shader("nothing"));
    assert!(renderer.files_changed());
    let error = renderer.reload().expect_err("it doesn't compile");
    assert!(error.to_string().contains("flat.frag:3"), "{error}");
    assert_eq!(draw(&mut renderer, 1).1[..4], [255, 0, 0, 255]);
    place.file("flat.frag", shader("vec4(0.0, 1.0, 0.0, 1.0)"));
    assert!(renderer.files_changed());
    renderer.reload().expect("it compiles");
    assert_eq!(draw(&mut renderer, 1).1[..4], [0, 255, 0, 255]);
}

/// SPIR-V of the program, and then of a file that appears and changes (DO-1).
#[test]
fn a_module_of_the_program_is_drawn_until_a_file_takes_its_place_and_that_is_followed() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let text = r#"Pipeline(version: 1,
        images: [(name: "light", format: R16G16B16A16_SFLOAT, size: Output), (name: "screen", format: Output, size: Output)],
        passes: [
            (name: "sky", draw: Sky, color: [(image: "light", clear: (0, 0, 0, 1))]),
            (name: "post", draw: FullScreen("post.spv"), sample: {"source": "light"}, params: {"factor": 1, "tint": (1, 1, 1)},
                color: ["screen"]),
        ],
        outputs: ["screen"])"#;
    let module: &[u8] = include_bytes!("../../../tests/shaders/spirv/post_hlsl.spv");
    // Its only constant of a number is 1.0, the alpha.
    let with_alpha = |alpha: f32| {
        let words = module.as_chunks::<4>().0.iter();
        let words = words.map(|word| if *word == 1.0_f32.to_le_bytes() { alpha.to_le_bytes() } else { *word });
        words.flatten().collect::<Vec<u8>>()
    };
    let file = place.file("mine.ron", text);
    let mut options = RendererOptions::default();
    options.spirv = vec![("post.spv".into(), module.into())];
    let mut renderer = renderer_with(device, &file, options);
    let alpha = |picture: &[u8]| picture.as_chunks::<4>().0[0][3];
    assert_eq!(alpha(&draw(&mut renderer, 1).1), 255);
    for (shown, written) in [(0, 0.0), (51, 0.2)] {
        place.file("post.spv", with_alpha(written));
        assert!(renderer.files_changed());
        renderer.reload().expect("right");
        assert_eq!(alpha(&draw(&mut renderer, 1).1), shown);
    }
    place.file("post.spv", &module[..40]);
    assert!(renderer.reload().expect_err("cut off").to_string().contains("cut off"));
    render::silent(device).expect("silent");
}

/// HLSL and what it includes, and a compiler that the program names (DO-2).
#[test]
fn hlsl_and_what_it_includes_are_followed_whatever_compiles_them() {
    let Some(device) = render::device() else { return };
    let place = Place::new();
    let text = r#"Pipeline(version: 1,
        images: [(name: "screen", format: Output, size: Output)],
        passes: [(name: "post", draw: FullScreen("post.hlsl:PSMain"), color: ["screen"])],
        outputs: ["screen"])"#;
    let file = place.file("mine.ron", text);
    place.file("post.hlsl", "#include \"light.hlsli\"\nfloat4 PSMain() : SV_Target0 { return light(); }\n");
    let light =
        |green: &str| place.file("light.hlsli", format!("float4 light() {{ return float4(0, {green}, 0, 1); }}\n"));
    light("0.0");
    let mut options = RendererOptions::default();
    let mut renderer = renderer_with(device, &file, options.clone());
    let green = |picture: &[u8]| picture.as_chunks::<4>().0[0][1];
    assert_eq!(green(&draw(&mut renderer, 1).1), 0);
    for (shown, written) in [(255, "1.0"), (0, "0.0")] {
        light(written);
        assert!(renderer.files_changed());
        renderer.reload().expect("right");
        assert_eq!(green(&draw(&mut renderer, 1).1), shown);
    }
    light("nothing");
    let error = renderer.reload().expect_err("wrong").to_string();
    assert!(error.contains("light.hlsli:1"), "{error}");
    // The compiler that the program names is the one that is asked.
    options.shader_compilers.set_named("hlsl=no-such-compiler {input} {output}").expect("a command");
    light("1.0");
    let mut other = renderer_with(device, &file, options);
    let told = other.prepare().map(|_| ()).expect_err("it isn't there").to_string();
    assert!(told.contains("`no-such-compiler` isn't there"), "{told}");
    render::silent(device).expect("silent");
}
