//! Shaders that would mix up both eyes' pictures where they lie side by side are found before anything is drawn (ST-9), at the
//! pass's place in the file; where each eye has an image or a layer of its own nothing is wrong with them.

use crate::testing::{self, Place};

const PIPELINE: &str = r#"Pipeline(
    version: 1,
    images: [
        (name: "color", format: Color(hdr: true), size: Output, per_eye: true),
        (name: "noise", format: Color(hdr: true), size: Output),
        (name: "screen", format: Output, size: Like("color")),
    ],
    passes: [
        (name: "noise", draw: FullScreen("grain"), color: ["noise"]),
        (name: "sky", draw: Sky, color: [(image: "color", clear: (0.0, 0.0, 0.0, 1.0))]),
        (name: "effect", draw: FullScreen("effect"), sample: {"source": "color"}, color: ["screen"]),
    ],
    outputs: ["screen"],
)"#;

/// The pipeline with a shader `effect` of this body beside it.
fn place(body: &str) -> Place {
    let place = Place::new();
    let noise = "        (name: \"noise\", draw: FullScreen(\"grain\"), color: [\"noise\"]),\n";
    place.file("p.ron", PIPELINE.replace(noise, ""));
    place.file("effect.frag", shader(body));
    place
}

fn shader(body: &str) -> String {
    format!(
        "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"include/stereo.glsl\"
#include \"include/texture.glsl\"
#include \"include/rotation.glsl\"
layout(set = 0, binding = 0) uniform sampler2D source;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {{ color = {body}; }}
"
    )
}

fn check(place: &Place, stereo: &str, device: &str) -> testing::Outcome {
    place.run(&["check", "p.ron", "--stereo", stereo, "--device", device])
}

/// On SwiftShader instances are drawn into halves as well, on lavapipe into layers.
const IN_HALVES: [(&str, &str); 3] =
    [("double-wide", "swiftshader"), ("double-wide", "lavapipe"), ("instanced", "swiftshader")];
const ELSEWHERE: [(&str, &str); 5] = [
    ("off", "swiftshader"),
    ("multi-pass", "swiftshader"),
    ("multi-pass", "lavapipe"),
    ("instanced", "lavapipe"),
    ("multiview", "swiftshader"),
];

#[test]
fn a_shader_that_does_not_ask_which_half_is_its_eyes_is_found_in_halves_and_only_there() {
    let place = place("textureLod(source, uv, 0.0)");
    for (stereo, device) in IN_HALVES {
        let said = check(&place, stereo, device).exits(1);
        let said = said.mentions(
            "error: shader `effect` samples `source` and doesn't ask which half of `color` is its eye's\n  --> p.ron:10:73\n",
        );
        let said = said.mentions("both eyes' pictures lie side by side in it");
        let said = said.mentions(
            "include `include/texture.glsl` and look it up by `found_in(source, source_st, uv)` or `texel_in(source, source_st, texel)`",
        );
        assert_eq!(said.err.matches("error: ").count(), 1, "{stereo} on {device}: {}", said.err);
    }
    for (stereo, device) in ELSEWHERE {
        check(&place, stereo, device).exits(0);
    }
}

#[test]
fn a_shader_that_asks_is_fine_in_every_mode() {
    for body in [
        "found_in(source, source_st, uv)",
        "texel_in(source, source_st, ivec2(3))",
        "texture(source, uv_clamp(uv_adjust(uv, source_st), source_st, textureSize(source, 0)))",
        "textureLod(source, uv * source_st.xy + source_st.zw, 0.0) + frag_coord()",
    ] {
        let place = place(body);
        for (stereo, device) in IN_HALVES.into_iter().chain(ELSEWHERE) {
            check(&place, stereo, device).exits(0);
        }
    }
}

/// A shader in HLSL is told the words and the file that HLSL has.
#[test]
fn a_shader_in_hlsl_is_told_what_hlsl_has_for_halves() {
    let place = Place::new();
    place.file(
        "p.ron",
        r#"Pipeline(version: 1, images: [(name: "screen", format: Output, size: Output, per_eye: true)],
            passes: [(name: "effect", draw: FullScreen("effect.hlsl"), color: ["screen"])], outputs: ["screen"])"#,
    );
    let text = |place: &str| {
        format!(
            "#include \"include/rotation.hlsl\"\n
            float4 main(float4 at : SV_Position) : SV_Target0 {{ return float4({place}.xy / 64.0, 0.0, 1.0); }}"
        )
    };
    for (stereo, device) in IN_HALVES {
        place.file("effect.hlsl", text("at"));
        let said = check(&place, stereo, device).exits(1);
        let said = said.mentions("error: shader `effect.hlsl` reads `SV_Position` without `frag_coord(position)`");
        said.mentions("`frag_coord(position)` of `include/rotation.hlsl` is the place in the eye's own picture");
        place.file("effect.hlsl", text("frag_coord(at)"));
        check(&place, stereo, device).exits(0);
    }
}

#[test]
fn raw_fragment_coordinates_are_found_in_halves_and_only_there() {
    let place = place("found_in(source, source_st, gl_FragCoord.xy)");
    for (stereo, device) in IN_HALVES {
        let said = check(&place, stereo, device).exits(1);
        let said =
            said.mentions("error: shader `effect` reads `gl_FragCoord` without `frag_coord()`\n  --> p.ron:10:43\n");
        let said = said.mentions("both eyes' pictures lie side by side in `screen`");
        let said = said.mentions("`frag_coord()` of `include/rotation.glsl` is the place in the eye's own picture");
        assert_eq!(said.err.matches("error: ").count(), 1, "{stereo} on {device}: {}", said.err);
    }
    for (stereo, device) in ELSEWHERE {
        check(&place, stereo, device).exits(0);
    }
    // Depth is the same wherever the picture lies.
    let depth = self::place("found_in(source, source_st, uv) * gl_FragCoord.z");
    for (stereo, device) in IN_HALVES {
        check(&depth, stereo, device).exits(0);
    }
}

#[test]
fn both_mistakes_of_a_shader_are_told_and_each_once() {
    let place = place("textureLod(source, gl_FragCoord.xy, 0.0)");
    let said = check(&place, "double-wide", "swiftshader").exits(1);
    let said = said.mentions("doesn't ask which half").mentions("reads `gl_FragCoord`");
    assert_eq!(said.err.matches("error: ").count(), 2, "{}", said.err);
}

#[test]
fn what_both_eyes_share_is_read_and_drawn_raw() {
    let place = Place::new();
    place.file("p.ron", PIPELINE.replace("{\"source\": \"color\"}", "{\"source\": \"color\", \"noise\": \"noise\"}"));
    place.file(
        "grain.frag",
        "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(gl_FragCoord.xy, 0.0, 1.0); }\n",
    );
    let effect = shader("found_in(source, source_st, uv) + textureLod(noise, uv, 0.0)");
    let noise = "layout(set = 0, binding = 1) uniform sampler2D noise;\nlayout(location = 0) in";
    place.file("effect.frag", effect.replace("layout(location = 0) in", noise));
    for (stereo, device) in IN_HALVES.into_iter().chain(ELSEWHERE) {
        check(&place, stereo, device).exits(0);
    }
}
