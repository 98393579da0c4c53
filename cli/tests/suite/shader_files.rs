//! Shaders: beside the file that names them, then beside the pipeline, then those that are shipped.

use crate::included_files::WITH_BLOOM;
use crate::testing::{Outcome, Place, Vulkan};

/// A full-screen shader whose one parameter is called `parameter`.
fn shader(parameter: &str) -> String {
    format!(
        "#version 460\n#include \"part.glsl\"\nlayout(set = 0, binding = 0) uniform Params {{ float {parameter}; }} params;\n\
         layout(location = 0) out vec4 color;\nvoid main() {{ color = vec4(part(params.{parameter})); }}\n"
    )
}

/// An included file: the function `part`.
fn part(body: &str) -> String {
    format!("float part(float x) {{ return {body}; }}\n")
}

const PIPELINE: &str = r#"Pipeline(
    version: 1,
    include: ["effects/glow.ron"],
    images: [(name: "first", format: Output, size: Output), (name: "screen", format: Output, size: Output)],
    passes: [
        (name: "own", draw: FullScreen("tint"), params: {"near": 1.0}, color: ["first"]),
        (use: "glow", name: "other", with: {"target": "screen"}),
    ],
    outputs: ["first", "screen"],
)"#;

const GLOW: &str = r#"Fragments(version: 1, fragments: [
    (name: "glow", parameters: [(name: "target", value: Image)],
        passes: [(name: "draw", draw: FullScreen("tint"), params: {"far": 1.0}, color: ["target"])]),
])"#;

/// `p.ron` and `effects/glow.ron`, each with a shader `tint` beside it that takes other parameters and includes another file.
fn place() -> Place {
    let place = Place::new();
    std::fs::create_dir(place.path("effects")).expect("a folder");
    place.file("p.ron", PIPELINE);
    place.file("effects/glow.ron", GLOW);
    place.file("tint.frag", shader("near"));
    place.file("effects/tint.frag", shader("far"));
    place.file("part.glsl", part("x"));
    place
}

fn check(place: &Place) -> Outcome {
    place.run(&["check", "p.ron"])
}

#[test]
fn a_fragment_has_the_shader_beside_its_own_file_and_the_plan_tells_it_from_the_pipelines_of_that_name() {
    let place = place();
    check(&place).exits(0);
    let plan = place.run(&["inspect", "p.ron"]).exits(0).out;
    assert!(plan.contains("`own` draws the full screen with shader `tint` (p.ron:6)"), "{plan}");
    assert!(
        plan.contains("`other.draw` draws the full screen with shader `effects/tint` (effects/glow.ron:3)"),
        "{plan}"
    );
    place.run(&["check", "p.ron", "--all-variants"]).exits(0);
    if let Some(variables) = Vulkan::LAVAPIPE.variables() {
        let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "16x16"];
        place.run_with(&variables, &run).exits(0);
    }

    // Its includes are looked for beside it too, then beside the pipeline.
    place.file("effects/part.glsl", part("beside"));
    check(&place).exits(1).mentions("./effects/part.glsl:1:30").mentions("^^^^^^ 'beside' : undeclared identifier");
}

#[test]
fn where_there_is_none_beside_the_fragment_the_pipelines_is_taken_then_a_shipped_one() {
    let place = place();
    std::fs::remove_file(place.path("effects/tint.frag")).expect("gone");
    check(&place).exits(1).mentions("error: shader `tint` needs the parameter `near`").mentions("effects/glow.ron:3:");
    place.file("tint.frag", shader("far"));
    place.file("p.ron", PIPELINE.replace("near", "far"));
    check(&place).exits(0);
    std::fs::remove_file(place.path("tint.frag")).expect("gone");
    check(&place)
        .exits(1)
        .mentions("error: there is no shader named `tint`")
        .mentions("looked for in ./effects, ., the shipped shaders");
    let copy = |source: &str| format!(r#""copy"), sample: {{"source": "{source}"}}, color"#);
    let glow = GLOW.replace("parameters: [", r#"parameters: [(name: "from", value: Image), "#);
    place.file("effects/glow.ron", glow.replace(r#""tint"), params: {"far": 1.0}, color"#, &copy("from")));
    let cleared = r#"Sky, color: [(image: "first", clear: (0.0, 0.0, 0.0, 1.0))]"#;
    let sky = PIPELINE.replace(r#"FullScreen("tint"), params: {"near": 1.0}, color: ["first"]"#, cleared);
    place.file("p.ron", sky.replace("with: {", r#"with: {"from": "first", "#));
    check(&place).exits(0);
}

#[test]
fn a_shipped_fragment_keeps_the_shipped_shader_whatever_lies_beside_the_pipeline() {
    let place = Place::new();
    place.file("bloom_shrink.frag", "this is no shader");
    place.file("full_screen.vert", "nor is this");
    place.file("p.ron", WITH_BLOOM);
    check(&place).exits(0);
    let plan = place.run(&["inspect", "p.ron"]).exits(0).out;
    assert!(plan.contains("with shader `shipped:bloom_shrink` (shipped:library/bloom.ron:"), "{plan}");
}

#[cfg(unix)]
#[test]
fn no_shader_outside_the_root_is_read_from_a_fragments_folder_either() {
    let place = place();
    let outside = tempfile::tempdir().expect("a folder");
    let secret = outside.path().join("tint.frag");
    std::fs::write(&secret, "top secret").expect("a file");
    std::fs::remove_file(place.path("effects/tint.frag")).expect("gone");
    std::os::unix::fs::symlink(&secret, place.path("effects/tint.frag")).expect("a link");
    let outcome = check(&place).exits(1).mentions("effects/tint.frag leads out of `.`");
    assert!(!outcome.err.contains("top"), "{}", outcome.err);
}

#[test]
fn a_users_file_that_is_called_like_a_shipped_one_is_the_users() {
    let place = place();
    let text = PIPELINE.replace("effects/glow.ron", "glow.ron");
    place.file("shipped:forward.ron", text);
    place.file("glow.ron", GLOW);
    place.file("tint.frag", shader("far"));
    place.file("shipped:forward.ron", PIPELINE.replace("effects/glow.ron", "glow.ron").replace("near", "far"));
    let plan = place.run(&["inspect", "./shipped:forward.ron"]).exits(0).out;
    assert!(plan.contains("(./shipped:forward.ron:6)"), "{plan}");
}

#[test]
fn what_a_shader_includes_is_looked_for_in_all_of_the_users_folders_before_the_shipped_files() {
    let place = place();
    // A shipped file has that path, counted from the including file's folder; the user's own lies beside the pipeline.
    std::fs::create_dir(place.path("include")).expect("a folder");
    place.file("include/tools.glsl", "#include \"random.glsl\"\n");
    place.file("random.glsl", "float own_random(float x) { return x; }\n");
    let text = shader("near").replace("part.glsl", "include/tools.glsl").replace("part(", "own_random(");
    place.file("tint.frag", text);
    check(&place).exits(0);
}

#[test]
fn a_shipped_vertex_shader_goes_with_the_shipped_fragment_shader_of_its_name_only() {
    let place = place();
    let text = PIPELINE.replace("FullScreen(\"tint\")", "FullScreen(\"snow\")");
    place.file("p.ron", text);
    place.file("snow.frag", shader("near"));
    check(&place).exits(0);
}

#[test]
fn what_the_compiler_inserts_is_drawn_by_shipped_shaders_whatever_the_user_calls_his_own() {
    let place = Place::new();
    place.file(
        "p.ron",
        r#"Pipeline(
            version: 1,
            settings: [(name: "map", value: Bool(default: false))],
            images: [
                (name: "color", format: Color(hdr: true), size: Scaled(0.5)),
                (name: "screen", format: Output, size: Output),
            ],
            passes: [
                (name: "sky", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
                (name: "map", when: "map", draw: FullScreen("reinhard"), sample: {"source": "color"}, color: ["screen"],
                    otherwise: Forward(from: "color", to: "screen")),
            ],
            outputs: ["screen"],
        )"#,
    );
    let drawn = |file: &str| {
        let variables = Vulkan::LAVAPIPE.variables()?;
        let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "32x18", "-o", file];
        place.run_with(&variables, &run).exits(0);
        Some(std::fs::read(place.path(file)).expect("a picture"))
    };
    let before = drawn("before.png");
    let red = "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0, 0.0, 0.0, 1.0); }\n";
    place.file("copy.frag", red);
    assert!(drawn("after.png") == before, "the user's `copy` was drawn");
    let plan = place.run(&["inspect", "p.ron"]).exits(0).out;
    assert!(plan.contains("with shader `shipped:copy`"), "{plan}");
}
