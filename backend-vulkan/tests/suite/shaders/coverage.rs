//! What a stage may leave as it was, read off its control flow and its declarations.

use super::{drawn, full_screen, library};
use framewright_graph::frame::Draw;
use framewright_graph::shader::{ShaderInterface, ShaderInterfaces, Variant};
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Op, StorageClass};

const COLOR: &str = "layout(location = 0) in vec2 uv; layout(location = 0) out vec4 color;\n";

fn reflected(fragment: &str) -> ShaderInterface {
    let quad =
        "#version 460\nlayout(location = 0) out vec2 uv;\nvoid main() { uv = vec2(0.0); gl_Position = vec4(0.0); }\n";
    let fragment = format!("#version 460\n{COLOR}{fragment}");
    drawn(Draw::FullScreen, &[("test.frag", &fragment), ("test.vert", quad)])
        .unwrap_or_else(|why| panic!("{fragment}: {why:?}"))
}

/// What a stage doesn't set, in words, and whether that is sure.
fn unset(fragment: &str) -> Vec<(String, bool)> {
    reflected(fragment).unset.into_iter().map(|unset| (unset.what, unset.refused)).collect()
}

#[test]
fn an_output_that_every_path_sets_is_set() {
    for fragment in [
        "void main() { color = vec4(1.0); }",
        "void main() { if (uv.x < 0.5) { color = vec4(1.0); return; } color = vec4(0.0); }",
        "void main() { if (uv.x < 0.5) color = vec4(1.0); else color = vec4(0.0); }",
        "void main() { color = vec4(0.0); for (int i = 0; i < 3; ++i) if (uv.x < 0.5) return; }",
        "void main() { color.rgb = vec3(1.0); color.a = uv.x; }",
        "void main() { color.xy = uv; color.w = 1.0; color[2] = 0.0; }",
        "void main() { if (uv.x < 0.5) discard; color = vec4(1.0); }",
        "void main() { if (uv.x > 0.5) color = vec4(1.0); else discard; }",
        "void main() { switch (int(uv.x * 4.0)) { case 0: color = vec4(0.0); break; case 1: default: color = vec4(1.0); } }",
        "void main() { while (true) { color = vec4(1.0); if (uv.x < 0.5) break; } }",
        "void main() { do { color = vec4(uv, 0.0, 1.0); } while (color.x > 0.5); }",
        "void set(float x) { if (x < 0.5) { color = vec4(0.0); return; } color = vec4(x); } void main() { set(uv.x); }",
        "void put(out vec4 to) { to = vec4(1.0); } void main() { put(color); }",
        "void ends() { discard; } void main() { if (uv.x < 0.5) color = vec4(1.0); else ends(); }",
        "layout(location = 1) out vec4 more[2]; void main() { color = vec4(0.0); more[0] = vec4(1.0); more[1].xyzw = vec4(0.0); }",
        "layout(location = 1) out vec4 more[2]; void main() { color = vec4(0.0); more = vec4[2](vec4(1.0), vec4(2.0)); }",
        "void main() { color.rgb = vec3(1.0); color.rgb *= uv.x; color.a = color.r; }",
        "void main() { color = vec4(0.0); for (int i = 0; i < 4; ++i) color += vec4(0.1); }",
        "layout(location = 1) out vec4 more[1]; void main() { color = vec4(0.0); more[0] = vec4(1.0); }",
        "layout(location = 1) out uint id; void main() { color = vec4(0.0); id = 7u; }",
        "void main() { color = vec4(0.0); gl_FragDepth = uv.x; }",
    ] {
        assert!(unset(fragment).is_empty(), "{fragment}: {:?}", unset(fragment));
    }
}

#[test]
fn an_output_that_some_path_leaves_is_told_with_its_components() {
    let on_every_path = |what: &str| format!("doesn't set `{what}` on every path");
    let never = |what: &str| format!("never sets `{what}`");
    for (fragment, expected) in [
        ("void main() { if (uv.x < 0.5) return; color = vec4(1.0); }", on_every_path("color")),
        ("void main() { if (uv.x < 0.5) color = vec4(1.0); }", on_every_path("color")),
        ("void main() { color.rgb = vec3(1.0); if (uv.x < 0.5) color.a = 1.0; }", on_every_path("color.w")),
        (
            "void main() { switch (int(uv.x * 4.0)) { case 0: color = vec4(0.0); break; case 1: color = vec4(1.0); } }",
            on_every_path("color"),
        ),
        ("void set(float x) { if (x < 0.5) color = vec4(x); } void main() { set(uv.x); }", on_every_path("color")),
        ("void main() { color = vec4(0.0); if (uv.x < 0.5) gl_FragDepth = uv.x; }", on_every_path("gl_FragDepth")),
        ("void main() { color.rgb = vec3(1.0); }", never("color.w")),
        ("void main() { color.xz = uv; }", never("color.yw")),
        ("layout(location = 1) out vec4 more; void main() { color = vec4(0.0); }", never("more")),
        (
            "layout(location = 1) out vec4 more[2]; void main() { color = vec4(0.0); more[0] = vec4(0.0); }",
            never("more[1]"),
        ),
        (
            "layout(location = 1) out vec4 more[2]; void main() { color = more[0] = vec4(0.0); if (uv.x < 0.5) more[1] = vec4(1.0); }",
            on_every_path("more[1]"),
        ),
        ("void main() { color += vec4(0.5); }", "reads `color` before it sets it".to_owned()),
        (
            "void main() { if (color.x < 0.5) color = vec4(0.0); else color = vec4(1.0); }",
            "reads `color` before it sets it".to_owned(),
        ),
    ] {
        let found = unset(fragment);
        assert_eq!(found, [(expected, true)], "{fragment}");
    }
}

#[test]
fn what_hangs_on_the_rounds_of_a_loop_or_on_an_index_is_not_sure() {
    for fragment in [
        "void main() { for (int i = 0; i < int(uv.x); ++i) color = vec4(1.0); }",
        "void main() { int i = 0; while (i < int(uv.x)) { ++i; color = vec4(1.0); } }",
        "void main() { for (int i = 0; i < 4; ++i) color[i] = 1.0; }",
        "void main() { color[int(uv.x * 3.0)] = 1.0; }",
        "void main() { for (int i = 0; i < 4; ++i) { if (uv.x < 0.5) continue; color = vec4(1.0); } color.x = 0.0; }",
    ] {
        let found = unset(fragment);
        let [(what, refused)] = &found[..] else { panic!("{fragment}: {found:?}") };
        assert_eq!(*refused, fragment.contains("continue"), "{fragment}: {what}");
    }
    let array = "layout(location = 1) out vec4 more[2];
        void main() { color = vec4(0.0); for (int i = 0; i < 2; ++i) more[i] = vec4(float(i)); }";
    let found = unset(array);
    assert!(found.len() == 2 && found.iter().all(|(_, refused)| !refused), "{found:?}");
}

#[test]
fn what_is_not_set_has_its_location_and_its_line() {
    let unset =
        reflected("layout(location = 3) out vec4 more[2];\nvoid main() { color = vec4(0.0); more[0] = color; }").unset;
    let [unset] = &unset[..] else { panic!("{unset:?}") };
    assert_eq!((unset.location, unset.refused), (Some(4), true));
    assert!(unset.place.as_deref().is_some_and(|place| place.ends_with("test.frag:3")), "{unset:?}");
}

#[test]
fn a_written_sample_mask_leaves_out_samples_and_a_read_one_tells_them_apart() {
    let of = |fragment: &str| {
        let found = reflected(fragment);
        (found.discards, found.masks_samples, found.per_sample, found.leaves_out_at.is_some())
    };
    assert_eq!(of("void main() { color = vec4(1.0); }"), (false, false, false, false));
    assert_eq!(of("void main() { color = vec4(1.0); gl_SampleMask[0] = 1; }"), (false, true, true, true));
    assert_eq!(
        of("void mask(int to) { gl_SampleMask[0] = to; } void main() { color = vec4(1.0); mask(1); }"),
        (false, true, true, true)
    );
    assert_eq!(of("void main() { color = vec4(float(gl_SampleMaskIn[0])); }"), (false, false, true, false));
    assert_eq!(of("void main() { if (uv.x < 0.5) discard; color = vec4(1.0); }"), (true, false, false, true));
    let demoting = "#extension GL_EXT_demote_to_helper_invocation : require\nlayout(location = 0) out vec4 color;
        void main() { if (gl_FragCoord.x < 9.0) demote; color = vec4(1.0); }";
    assert!(full_screen(demoting).expect("it compiles").discards, "a demotion leaves out what a discard does");
}

#[test]
fn what_leaves_texels_out_has_its_line_outside_of_comments_and_in_included_files() {
    let place = |files: &[(&str, &str)]| {
        let found = drawn(Draw::FullScreen, files).expect("it compiles").leaves_out_at.expect("a place");
        found.rsplit_once('/').map_or(found.clone(), |(_, file)| file.to_owned())
    };
    let head = "#version 460\nlayout(location = 0) out vec4 color;\n// discard, gl_SampleMask\n";
    let [discards, masks] = ["if (gl_FragCoord.x < 4.0) discard;", "gl_SampleMask[0] = 1;"];
    let of = |lines: &str| format!("{head}void main() {{\n    color = vec4(1.0);\n{lines}}}\n");
    assert_eq!(place(&[("test.frag", &of(&format!("{discards}\n")))]), "test.frag:6");
    assert_eq!(place(&[("test.frag", &of(&format!("{masks}\n")))]), "test.frag:6");
    // A stage that does both is said to discard.
    assert_eq!(place(&[("test.frag", &of(&format!("{masks}\n{discards}\n")))]), "test.frag:7");
    let included = format!("{head}#include \"holes.glsl\"\nvoid main() {{ leave(); color = vec4(1.0); }}\n");
    let holes = format!("/* discard\n*/ void leave() {{\n{discards} }}\n");
    assert_eq!(place(&[("test.frag", &included), ("holes.glsl", &holes)]), "holes.glsl:3");
}

#[test]
fn what_is_only_written_has_the_line_that_declares_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "#version 460
        layout(local_size_x = 8) in; // to
        layout(set = 0, binding = 0, rgba8) uniform writeonly image2D to;
        layout(set = 0, binding = 1) writeonly buffer Counts { uint words[]; } counts;
        layout(set = 0, binding = 2) writeonly buffer Bare { uint bare_words[]; };
        layout(set = 0, binding = 3) buffer Both { uint words[]; } both;
        layout(set = 0, binding = 4) readonly buffer From { uint words[]; } from;
        void main() {
            imageStore(to, ivec2(0), vec4(from.words[0]));
            counts.words[0] = both.words[0]++;
            bare_words[1] = 1;
        }";
    std::fs::write(folder.path().join("test.comp"), text).expect("written");
    let interface = library(folder.path()).compute_shader("test", &Variant::default()).expect("it compiles");
    let places = interface.only_written_at.iter();
    let places = places.map(|(name, place)| (&**name, place.rsplit_once('/').map_or(&**place, |(_, file)| file)));
    let expected = [("to", "test.comp:3"), ("counts", "test.comp:4"), ("Bare", "test.comp:5")];
    assert_eq!(places.collect::<Vec<_>>(), expected);
}

/// Depth is drawn again by a stage whose colours go nowhere, which the validation layer would say of each draw.
#[test]
fn a_stage_that_draws_depth_alone_has_no_colour_however_the_text_sets_it() {
    for body in [
        "color = vec4(1.0);",
        "color.rgb = vec3(0.5); color[3] = 1.0; color.xy *= 0.5;",
        "put(color);",
        "if (gl_FragCoord.y < 2.0) { color = vec4(0.0); return; } color = vec4(1.0); more[1] = color;",
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let text = format!(
            "#version 460\nlayout(location = 0) out vec4 color; layout(location = 1) out vec4 more[2];
            void put(out vec4 to) {{ to = vec4(1.0); }}
            void main() {{ if (gl_FragCoord.x < 4.0) discard; gl_FragDepth = 0.5; more[0] = vec4(0.0); {body} }}"
        );
        std::fs::write(folder.path().join("test.frag"), text).expect("written");
        let outputs = |depth_only: bool| {
            let variant = Variant { depth_only, ..Variant::default() };
            let compiled = library(folder.path()).compiled("test", Draw::FullScreen, &variant).expect("it compiles");
            let module = rspirv::dr::load_words(compiled.fragment.expect("it discards")).expect("SPIR-V");
            let is_output = |it: &&Instruction| {
                it.class.opcode == Op::Variable && it.operands[0] == Operand::StorageClass(StorageClass::Output)
            };
            module.types_global_values.iter().filter(is_output).count()
        };
        // Depth stays.
        assert_eq!((outputs(false), outputs(true)), (3, 1), "{body}");
    }
}

#[test]
fn only_the_usual_vertex_stage_is_known_to_fill_the_screen() {
    let fragment = "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n";
    let vertex = "#version 460\nvoid main() { gl_Position = vec4(0.0); }\n";
    let own = |draw, files: &[(&str, &str)]| drawn(draw, files).expect("it compiles").own_vertices;
    let both = [("test.frag", fragment), ("test.vert", vertex)];
    assert_eq!(own(Draw::FullScreen, &both[..1]), None);
    assert!(own(Draw::FullScreen, &both).is_some_and(|file| file.ends_with("test.vert")));
    // A vertex stage that stands in for the usual one.
    assert!(own(Draw::FullScreen, &[("test.frag", fragment), ("full_screen.vert", vertex)]).is_some());
    assert_eq!(own(Draw::Vertices { count: 3, instances: 1 }, &both), None);
}
