//! What a file draws by vertices of its own for two eyes: a camera in a buffer is one for both.

use crate::testing::{Outcome, Place, Vulkan};

const STRUCT: &str = "struct CameraData { mat4 world_to_clip; vec4 place; };";
const FRAGMENT: &str = "#version 460
layout(location = 0) out vec4 color;
void main() { color = vec4(0.0, 1.0, 0.0, 1.0); }";
const MAKE: &str = "#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) writeonly buffer Camera { mat4 world_to_clip; vec4 place; } camera;
layout(set = 0, binding = 1, std430) writeonly buffer Counts { uint words[4]; } counts;
void main() {
    camera.world_to_clip = mat4(1.0);
    camera.place = vec4(0.0);
    for (uint i = 0; i < 4; ++i) counts.words[i] = uint[](6, 1, 0, 0)[i];
}";

/// A pass that draws by what it binds, into `screen`, which is there once or for each eye.
fn check(draw: &str, given: &str, vertex: &str, per_eye: bool, more: &[&str]) -> Outcome {
    let place = Place::new();
    let text = format!(
        r#"Pipeline(version: 1,
            images: [(name: "screen", format: Output, size: Output, per_eye: {per_eye})],
            buffers: [(name: "camera", bytes: 80), (name: "counts", bytes: 16)],
            passes: [
                (name: "make", dispatch: "make", groups: Count(1),
                    storage: {{"camera": (buffer: "camera", access: Write), "counts": (buffer: "counts", access: Write)}}),
                (name: "cube", draw: {draw}, shader: "cube", {given}, color: [(image: "screen", clear: (0, 0, 0, 1))]),
            ],
            outputs: ["screen"])"#
    );
    place.file("p.ron", text);
    place.file("make.comp", MAKE);
    place.file("cube.frag", FRAGMENT);
    let head = format!("#version 460\n#extension GL_GOOGLE_include_directive : require\n{STRUCT}\n");
    place.file("cube.vert", head + vertex);
    place.run(&[&["check", "p.ron"][..], more].concat()).exits(0)
}

const UNIFORM: &str = r#"uniform: {"camera": "camera"}"#;
const BY_UNIFORM: &str = "layout(set = 0, binding = 0, std140) uniform Camera { CameraData data; } camera;
void main() { gl_Position = camera.data.world_to_clip * vec4(float(gl_VertexIndex)); }";

#[test]
fn a_camera_in_a_buffer_for_both_eyes_is_noted() {
    let storage = r#"storage: {"camera": (buffer: "camera", access: Read)}"#;
    let by_storage = "layout(set = 0, binding = 0, std430) readonly buffer Camera { CameraData all[]; } camera;
        void main() { gl_Position = camera.all[0].world_to_clip * vec4(float(gl_VertexIndex)); }";
    for (draw, given, vertex) in [
        ("Vertices(6)", UNIFORM, BY_UNIFORM),
        (r#"Indirect("counts")"#, UNIFORM, BY_UNIFORM),
        ("Vertices(6)", storage, by_storage),
        (r#"Indirect("counts")"#, storage, by_storage),
    ] {
        for mode in ["multi-pass", "double-wide", "instanced"] {
            let outcome = check(draw, given, vertex, true, &["--stereo", mode]);
            let told = outcome.out.matches("holds a matrix and is the same for both eyes").count();
            assert_eq!(told, 1, "{draw} {mode}: {}", outcome.out);
            assert!(outcome.out.contains("choose by `eye_index` of `include/stereo.glsl` (p.ron:"), "{}", outcome.out);
        }
    }
}

/// The vertex stage's language says what the stage includes.
#[test]
fn a_camera_for_both_eyes_in_hlsl_is_noted_with_what_hlsl_includes() {
    let place = Place::new();
    place.file(
        "p.ron",
        r#"Pipeline(version: 1,
            images: [(name: "screen", format: Output, size: Output, per_eye: true)],
            buffers: [(name: "camera", bytes: 80)],
            passes: [
                (name: "set", fill: (to: "camera", value: 0)),
                (name: "cube", draw: Vertices(6), shader: (vertex: "cube.hlsl:place", fragment: "cube"),
                    uniform: {"camera": "camera"}, color: [(image: "screen", clear: (0, 0, 0, 1))]),
            ],
            outputs: ["screen"])"#,
    );
    place.file("cube.frag", FRAGMENT);
    place.file(
        "cube.hlsl",
        "cbuffer camera : register(b0) { float4x4 world_to_clip; float4 place_of; };
        float4 place(uint vertex : SV_VertexID) : SV_Position { return mul(world_to_clip, float4(vertex, vertex, 0, 1)); }",
    );
    let outcome = place.run(&["check", "p.ron", "--stereo", "multi-pass"]).exits(0);
    assert!(outcome.out.contains("choose by `eye_index` of `include/stereo.hlsl` (p.ron:"), "{}", outcome.out);
}

#[test]
fn what_has_no_camera_or_asks_for_the_eye_is_not_noted() {
    let by_eye = "#include \"include/stereo.glsl\"
        layout(set = 0, binding = 0, std140) uniform Camera { CameraData data; } camera;
        void main() { gl_Position = camera.data.world_to_clip * vec4(float(gl_VertexIndex + eye_index)); }";
    let no_matrix = "layout(set = 0, binding = 0, std140) uniform Camera { vec4 place; } camera;
        void main() { gl_Position = camera.place * float(gl_VertexIndex); }";
    let quiet = |vertex: &str, per_eye: bool, more: &[&str]| {
        let outcome = check("Vertices(6)", UNIFORM, vertex, per_eye, more);
        assert!(!outcome.out.contains("both eyes"), "{}", outcome.out);
    };
    for mode in ["multi-pass", "double-wide", "instanced"] {
        quiet(by_eye, true, &["--stereo", mode]);
        quiet(no_matrix, true, &["--stereo", mode]);
        quiet(BY_UNIFORM, false, &["--stereo", mode]);
    }
    quiet(BY_UNIFORM, true, &[]);
}

/// Depth that is drawn again with one sample leaves nothing without a taker, although its stage discards and so is drawn too: the
/// validation layer would say so of each draw.
#[test]
fn depth_that_is_drawn_again_leaves_no_output_unused() {
    let Some(variables) = Vulkan::LAVAPIPE_CURRENT.variables() else { return };
    let place = Place::new();
    place.file(
        "p.ron",
        r#"Pipeline(version: 1,
            images: [(name: "a", format: R8G8B8A8_UNORM, size: Output, samples: 4), (name: "d", format: Depth, size: Output, samples: 4),
                     (name: "o", format: R8G8B8A8_UNORM, size: Output)],
            passes: [
                (name: "holes", draw: Objects(Opaque), shader: "holes", color: [(image: "a", clear: (0, 0, 0, 1))], depth: (image: "d", clear: 0.0)),
                (name: "show", draw: FullScreen("show"), sample: {"a": "a", "d": "d"}, color: ["o"]),
            ], outputs: [(image: "o", encoding: Unorm)])"#,
    );
    place.file(
        "show.frag",
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D a; layout(set = 0, binding = 1) uniform sampler2D d;
        layout(location = 0) out vec4 color;
        void main() { color = texelFetch(a, ivec2(gl_FragCoord.xy), 0) + texelFetch(d, ivec2(gl_FragCoord.xy), 0); }",
    );
    for set in ["color = vec4(1.0);", "color.rgb = vec3(1.0); color.a = 0.5;", "put(color);"] {
        place.file(
            "holes.frag",
            format!(
                "#version 460\nlayout(location = 0) out vec4 color; void put(out vec4 to) {{ to = vec4(1.0); }}
                void main() {{ if ((int(gl_FragCoord.x) & 1) == 0) discard; {set} }}"
            ),
        );
        let plan = place.run(&["inspect", "p.ron", "--scene", "spheres_and_cubes", "--format", "json"]).exits(0).out;
        assert!(plan.contains("is drawn again with 1"), "{plan}");
        let run = ["run", "p.ron", "--scene", "spheres_and_cubes", "--size", "16x16", "--validate"];
        let out = place.run_with(&variables, &run).exits(0).out;
        assert!(out.contains("validation: silent; ") && !out.contains("OutputNotConsumed"), "{set}: {out}");
    }
}

/// Vulkan allows outputs that nothing takes, and the validation layer warns of them: `check` says so before.
#[test]
fn an_output_that_goes_nowhere_is_noted() {
    let place = Place::new();
    place.file(
        "two.frag",
        "#version 460
        layout(location = 0) out vec4 color;
        layout(location = 1) out vec4 motion;
        void main() { color = vec4(1.0); motion = vec4(0.0); }",
    );
    place.file(
        "p.ron",
        r#"Pipeline(version: 1,
            images: [(name: "d", format: Depth, size: Output), (name: "o", format: R8G8B8A8_UNORM, size: Output), (name: "m", format: R8G8B8A8_UNORM, size: Output)],
            passes: [
                (name: "prepass", draw: Objects(Opaque), shader: "two", depth: (image: "d", clear: 0.0)),
                (name: "one", draw: Objects(Opaque), shader: "two", color: [(image: "o", clear: (0, 0, 0, 1))], depth: (image: "d", test: Equal, write: false)),
                (name: "both", draw: FullScreen("two"), color: ["o", "m"]),
            ], outputs: ["o", "m"])"#,
    );
    let outcome = place.run(&["check", "p.ron"]).exits(0);
    let told: Vec<&str> = outcome.out.lines().filter(|line| line.contains("goes nowhere")).collect();
    assert_eq!(told.len(), 2, "{}", outcome.out);
    assert!(told[0].contains("`two` writes `color` (location 0) and `motion` (location 1)"), "{}", told[0]);
    assert!(told[1].contains("`two` writes `motion` (location 1), which goes nowhere: the pass has one colour target"));
}
