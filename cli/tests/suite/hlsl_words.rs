//! Mistakes in HLSL and in SPIR-V files are told in the words of their language, with what their language has to mend them (DO-2).

use crate::testing::{Outcome, Place};

const HLSL: &str = "#include \"include/part.hlsl\"
#include \"include/rotation.hlsl\"
Texture2D<float4> source : register(t0);
SamplerState linear_clamp : register(s0);
cbuffer Lens : register(b0) {
    float factor;
};
struct PSIn { float4 pos : SV_Position; float2 uv : TEXCOORD1; };
float4 PSMain(PSIn i) : SV_Target {
    uint width, height;
    source.GetDimensions(width, height);
    float2 at = uv_clamp(uv_adjust(i.uv, source_st), source_st, int2(width, height));
    float4 color = source.SampleLevel(linear_clamp, at, 0);
    return color * factor + frag_coord(i.pos).x;
}
";

fn pipeline(shader: &str) -> String {
    format!(
        "Pipeline(version: 1, images: [
    (name: \"light\", format: Color(hdr: true), size: Output, per_eye: true),
    (name: \"screen\", format: Output, size: Output, per_eye: true)], passes: [
    (name: \"sky\", draw: Sky, color: [(image: \"light\", clear: (0, 0, 0, 1))]),
    (name: \"lens\", draw: FullScreen(\"{shader}\"), sample: {{\"source\": \"light\"}}, params: {{\"factor\": 1}}, color: [\"screen\"]),
], outputs: [\"screen\"])"
    )
}

/// What `check` says of HLSL like the one above, but for one change.
fn changed(from: &str, to: &str, arguments: &[&str]) -> Outcome {
    let place = Place::new();
    place.file("p.ron", pipeline("lens.hlsl:PSMain"));
    let text = HLSL.replace(from, to);
    assert!(from.is_empty() || text != HLSL, "{from}");
    place.file("lens.hlsl", text);
    place.run(&[&["check", "p.ron"][..], arguments].concat())
}

/// ST-9: each name in the help is one that HLSL has.
#[test]
fn st_9_hlsl_that_mixes_up_both_eyes_is_told_what_hlsl_has_for_that() {
    let in_halves = ["--stereo", "double-wide"];
    changed("", "", &in_halves).exits(0);
    let said = changed("frag_coord(i.pos)", "i.pos", &in_halves).exits(1);
    let said =
        said.mentions("error: shader `lens.hlsl:PSMain` reads `SV_Position` without `frag_coord(position)` [E1004]");
    let said =
        said.mentions("help: `frag_coord(position)` of `include/rotation.hlsl` is the place in the eye's own picture");
    assert!(!said.err.contains("gl_FragCoord"), "{}", said.err);
    let half = "uv_clamp(uv_adjust(i.uv, source_st), source_st, int2(width, height))";
    changed(half, "i.uv", &in_halves).exits(1).mentions(
        "include `include/part.hlsl` and look it up by `uv_clamp(uv_adjust(uv, source_st), source_st, size)`, where `size` is the \
         image's width and height in texels",
    );
}

/// DO-2: the built-in compiler's own words and its last line, which says nothing more, are left out.
#[test]
fn do_2_a_mistake_in_hlsl_is_told_without_the_compilers_own_words() {
    let missing = changed("color * factor", "color.x factor", &[]).exits(1).mentions("lens.hlsl:14");
    assert!(!missing.err.contains("parsing failed"), "{}", missing.err);
    let missing = missing.mentions("help: DXC tells more of a mistake in HLSL");
    missing.mentions("--shader-compiler");
    let unknown = changed("source.SampleLevel", "source.SmapleLevel", &[]).exits(1);
    let unknown = unknown.mentions("'SmapleLevel' : no matching overloaded function found");
    assert!(!unknown.err.contains("__BI_"), "{}", unknown.err);
}

/// DO-2: a block of parameters in another set is one mistake, with the set where it belongs.
#[test]
fn do_2_a_constant_buffer_in_another_space_is_one_mistake() {
    let said = changed("register(b0)", "register(b0, space1)", &[]).exits(1);
    let said = said.mentions("uses `Lens` (set 1, binding 0), which the draw source doesn't bring along [E0823]");
    let said = said.mentions("help: in the shader: move `Lens` to `space0`");
    assert_eq!(said.err.matches("error: ").count(), 1, "{}", said.err);
    // What the pass gives to no block at all is told without a name that HLSL needs not.
    let said = changed("color * factor", "color", &[]).exits(1);
    said.mentions("help: shader `lens.hlsl:PSMain` has no constant buffer in `space0`");
}

/// DO-2: what a full-screen pass doesn't hand over is told by the types of HLSL.
#[test]
fn do_2_an_input_that_nobody_hands_over_is_told_in_types_of_hlsl() {
    let place = Place::new();
    place.file("p.ron", pipeline("lens.hlsl:PSMain"));
    let text = HLSL.replace("float2 uv : TEXCOORD1", "float4 tone : COLOR0; float2 uv : TEXCOORD0");
    place.file("lens.hlsl", text.replace("color * factor", "color * factor * i.tone.a"));
    let said = place.run(&["check", "p.ron"]).exits(1);
    let said = said.mentions(
        "lens.hlsl:8: it reads `float4 i.tone` at location 0, where shipped:full_screen.vert hands over `float2 uv`",
    );
    said.mentions("leave it out, or name a vertex stage that hands it over; semantics of HLSL count for nothing");
}

/// DO-2: registers that meet in SPIR-V are told with the flags that part them.
#[test]
fn do_2_registers_that_meet_are_told_with_the_flags_that_part_them() {
    let high = HLSL.replace("(t0)", "(t40)").replace("(b0)", "(b40)");
    let module = include_bytes!("../../../tests/shaders/spirv/post_hlsl.spv");
    let meeting: Vec<u8> = {
        // `OpDecorate` of four words with `Binding`: each gets the number 0.
        let mut words: Vec<u32> = module.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        let places: Vec<usize> =
            (0..words.len() - 3).filter(|at| words[*at] == 0x0004_0047 && words[at + 2] == 33).collect();
        places.into_iter().for_each(|at| words[at + 3] = 0);
        words.into_iter().flat_map(u32::to_le_bytes).collect()
    };
    for (file, bytes) in [("lens.hlsl", high.as_bytes()), ("lens.spv", meeting.as_slice())] {
        let place = Place::new();
        place.file(
            "p.ron",
            pipeline(&format!("{file}:PSMain")).replace("\"factor\": 1", "\"factor\": 1, \"tint\": (1, 1, 1)"),
        );
        place.file(file, bytes);
        let said = place.run(&["check", "p.ron"]).exits(1);
        let said = said.mentions("[E0803]").mentions("at the same place: set 0, binding ");
        said.mentions(
            "leave out the registers, or let DXC move those of each kind: `-fvk-t-shift 10 0 -fvk-s-shift 20 0",
        );
    }
}

/// DO-2: files that are included are offered for no shader's name.
#[test]
fn do_2_files_that_are_included_are_offered_for_no_shader() {
    let place = Place::new();
    place.file("p.ron", pipeline("lens.hlsl:PSMain"));
    let said = place.run(&["check", "p.ron"]).exits(1).mentions("there is no shader named `lens.hlsl:PSMain` [E0801]");
    assert!(!said.err.contains("include/"), "{}", said.err);
    place.file("lenz.hlsl", HLSL);
    place.run(&["check", "p.ron"]).exits(1).mentions("there is only `lenz.hlsl`");
}

/// DO-2: slangc without its library is no mistake of the shader.
#[cfg(unix)]
#[test]
fn do_2_a_library_that_slangc_lacks_is_told_with_what_does_without() {
    let place = Place::new();
    place.file("p.ron", pipeline("lens.hlsl:PSMain"));
    place.file("lens.hlsl", HLSL);
    let lines = "for at in 1 2 3 4 5 6 7 8 9 10 11 12; do
    echo \"warning[E39029]: D3D register without Vulkan binding or shift\"; echo \" --> lens.hlsl:3:28\"; done
echo \"error[E00100]: failed to load downstream compiler 'spirv-opt'\"
exit 1
";
    place.file("slangc.sh", lines);
    let command = format!("hlsl=sh {} {{output}} {{input}}", place.path("slangc.sh").display());
    let said = place.run(&["check", "p.ron", "--shader-compiler", &command]).exits(3);
    let said = said
        .mentions("isn't compiled: its compiler `sh` lacks a library of its own [E1310]")
        .mentions("help: try `slangc -O0`, which calls none");
    let said = said.mentions("error[E00100]: failed to load downstream compiler 'spirv-opt'");
    assert!(!said.err.contains("warning"), "{}", said.err);
}
