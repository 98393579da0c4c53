//! What shaders do with the alpha of what they sample is read off their SPIR-V.

use framewright_graph::base::Root;
use framewright_graph::frame::Draw;
use framewright_graph::shader::{AlphaUse, DrawInterface, ShaderInterfaces, Variant};
use framewright_vulkan::ShaderLibrary;

const VERTEX: &[(&str, &str)] = &[("full_screen.vert", "#version 460\nvoid main() { gl_Position = vec4(0.0); }\n")];

/// What becomes of the alpha of `source`.
fn of(functions: &str, main: &str) -> Option<AlphaUse> {
    let folder = tempfile::tempdir().expect("a folder");
    let text = format!(
        "#version 460
        layout(set = 0, binding = 0) uniform sampler2D source;
        layout(set = 0, binding = 1, rgba16f) uniform writeonly image2D stored;
        layout(location = 0) out vec4 color;
        const vec2 uv = vec2(0.5);
        {functions}
        void main() {{ {main} }}"
    );
    std::fs::write(folder.path().join("test.frag"), text).expect("a file");
    let mut library =
        ShaderLibrary::new(vec![Root::new(folder.path().to_owned())], VERTEX, |_| DrawInterface::default());
    let interface = library.draw_shader("test", Draw::FullScreen, &Variant::default()).expect("it compiles");
    interface.alpha.iter().find(|(name, _)| name == "source").map(|(_, used)| *used)
}

const GUARD: &str = "
    float guard(float it) { const uint bits = floatBitsToUint(it); return bits > 7u ? 0.0 : uintBitsToFloat(min(bits, 5u)); }
    vec4 guarded(vec4 it) { return vec4(vec3(guard(it.r), guard(it.g), guard(it.b)), min(guard(it.a), 1.0)); }";

#[test]
fn alpha_that_nobody_looks_at_is_not_used() {
    for main in [
        "color = vec4(texture(source, uv).rgb, 1.0);",
        "vec4 found = texture(source, uv); found.a = 1.0; color = vec4(found.r + found.g, found.bb, 1.0);",
        "vec3 sum = vec3(0.0); for (int i = 0; i < 4; ++i) sum += texture(source, uv * float(i)).rgb; color = sum.rgbr;",
        "color = vec4(vec2(textureSize(source, 0)), textureGather(source, uv, 1).xw);",
    ] {
        assert_eq!(of("", main), None, "{main}");
    }
    assert_eq!(of(GUARD, "color = vec4(guarded(texture(source, uv)).rgb, 1.0);"), None);
    assert_eq!(
        of("vec3 light(sampler2D of) { return texture(of, uv).rgb; }", "color = vec4(light(source), 1.0);"),
        None
    );
}

#[test]
fn alpha_that_becomes_alpha_is_passed_on() {
    for main in [
        "color = texture(source, uv);",
        "const vec4 found = texture(source, uv); color = vec4(found.rgb * 2.0, found.a);",
        "vec4 sum = vec4(0.0); for (int i = 0; i < 4; ++i) sum += texture(source, uv) * 0.25; color = sum;",
        "color = mix(texture(source, uv), vec4(1.0), 0.5).bgra;",
        "vec4 found = vec4(1.0); found.a = texture(source, uv).a; color = found;",
        "color.a = texture(source, uv).a;",
    ] {
        assert_eq!(of("", main), Some(AlphaUse::Passed), "{main}");
    }
    assert_eq!(of(GUARD, "color = guarded(texture(source, uv));"), Some(AlphaUse::Passed));
    let through = "void look(sampler2D of, out vec4 it) { it = texelFetch(of, ivec2(0), 0); }";
    assert_eq!(of(through, "vec4 it; look(source, it); color = it;"), Some(AlphaUse::Passed));
    assert_eq!(of("vec4 kept;", "kept = texture(source, uv); color = kept;"), Some(AlphaUse::Passed));
}

#[test]
fn alpha_that_reaches_anything_else_is_read() {
    for main in [
        "const vec4 found = texture(source, uv); color = vec4(found.rgb * found.a, 1.0);",
        "color = texture(source, uv).abgr;",
        "color = vec4(dot(texture(source, uv), vec4(1.0)));",
        "if (texture(source, uv).a < 0.5) discard; color = vec4(1.0);",
        "color = vec4(length(texture(source, uv)));",
        "color = texture(source, uv).a > 0.5 ? vec4(1.0) : vec4(0.0);",
        "imageStore(stored, ivec2(0), texture(source, uv));",
        "color = textureGather(source, uv, 3);",
        "const vec4 found = texture(source, uv); float light = 0.0; for (int i = 0; i < 4; ++i) light += found[i]; color = vec4(light);",
        "vec4 taps[2]; taps[0] = texture(source, uv); color = vec4(taps[0].rgb, 1.0);",
    ] {
        assert_eq!(of("", main), Some(AlphaUse::Read), "{main}");
    }
    let branches = "vec3 tint(vec4 it) { if (it.a > 0.5) return vec3(1.0); return vec3(0.0); }";
    assert_eq!(of(branches, "color = vec4(tint(texture(source, uv)), 1.0);"), Some(AlphaUse::Read));
    let stores = "vec4 kept = vec4(0.0); float mark(float it) { if (it > 0.5) { kept = vec4(1.0); } return 1.0; }";
    assert_eq!(of(stores, "color = vec4(mark(texture(source, uv).a)) + kept;"), Some(AlphaUse::Read));
}

#[test]
fn alpha_that_is_handed_on_deeper_than_is_followed_counts_as_read() {
    let chain = |deep: u32| {
        let next = |at: u32| format!("vec3 f{at}(vec4 it) {{ return f{}(it); }}\n", at - 1);
        "vec3 f0(vec4 it) { return it.rgb; }\n".to_owned() + &(1..=deep).map(next).collect::<String>()
    };
    let main = |deep: u32| format!("color = vec4(f{deep}(texture(source, uv)), 1.0);");
    assert_eq!(of(&chain(50), &main(50)), None);
    assert_eq!(of(&chain(3000), &main(3000)), Some(AlphaUse::Read));
}
