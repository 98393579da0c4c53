//! What shaders declare, read or not: vertex attributes, varyings, blocks, macros and constants. Right on the device, under the
//! validation layer, or refused by `check` with the place.

use crate::testing::{Outcome, Place, Vulkan};

/// A pipeline with these images, buffers and passes whose output is `o`, of 8 × 8 texels.
fn pipeline(more: &str, passes: &str) -> String {
    format!(
        r#"Pipeline(
    version: 1,
    images: [(name: "o", format: R8G8B8A8_UNORM, size: Fixed(8, 8)){more}
    passes: [
{passes}
    ],
    outputs: [(image: "o", encoding: Unorm)],
)"#
    )
}

fn place(pipeline: &str, shaders: &[(&str, &str)]) -> Place {
    let place = Place::new();
    place.file("p.ron", pipeline);
    for (name, text) in shaders {
        place.file(name, format!("#version 460\n{text}"));
    }
    place
}

fn check(place: &Place, more: &[&str]) -> Outcome {
    place.run(&[&["check", "p.ron"], more].concat())
}

/// Draws it on each driver under the validation layer; every texel has the colour.
#[track_caller]
fn draws(place: &Place, more: &[&str], color: [u8; 4]) {
    for (at, vulkan) in [Vulkan::LAVAPIPE_CURRENT, Vulkan::LAVAPIPE_OLD, Vulkan::SWIFTSHADER_CURRENT].iter().enumerate()
    {
        let Some(variables) = vulkan.variables() else { continue };
        let name = format!("o{at}.png");
        let scene = ["--scene", "spheres_and_cubes"];
        let arguments = [&["run", "p.ron", "--validate", "--poison", "-o", &name], &scene[..], more].concat();
        place.run_with(&variables, &arguments).exits(0);
        let picture = image::open(place.path(&name)).expect("a picture").into_rgba8();
        let wrong = picture.pixels().filter(|pixel| pixel.0 != color).count();
        assert_eq!(wrong, 0, "{:?} and not {color:?}", picture.get_pixel(1, 1));
    }
}

const GREEN: [u8; 4] = [0, 255, 0, 255];

/// Writes these floats into the buffer `v`.
fn maker(floats: &[f32]) -> String {
    let list: Vec<String> = floats.iter().map(|float| format!("{float:?}")).collect();
    let count = floats.len();
    format!(
        "layout(local_size_x = 1) in;
        layout(set = 0, binding = 0) writeonly buffer V {{ float v[]; }} v;
        void main() {{
            const float values[{count}] = float[]({});
            for (int at = 0; at < {count}; at++) v.v[at] = values[at];
        }}",
        list.join(", ")
    )
}

/// The corners of a triangle that covers all.
const CORNERS: [[f32; 2]; 3] = [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]];

/// Draws three vertices, each a corner and these further words, by a vertex stage with these declarations that sets `handed` to
/// 1 where all is right.
fn vertices(declarations: &str, right: &str, further: &[f32]) -> Place {
    let all: Vec<f32> = CORNERS.iter().flat_map(|corner| [corner, further].concat()).collect();
    let bytes = all.len() * 4;
    let passes = r#"        (name: "make", dispatch: "make", groups: Count(1), storage: {"v": "v"}),
        (name: "draw", draw: Vertices(3), shader: "s", vertex: "v", color: [(image: "o", clear: (0.0, 0.0, 1.0, 1.0))])"#;
    let text = pipeline(&format!("], buffers: [(name: \"v\", bytes: {bytes})],"), passes);
    let vertex = format!(
        "layout(location = 0) in vec2 position;
        {declarations}
        layout(location = 0) out float handed;
        void main() {{ gl_Position = vec4(position, 0.5, 1.0); handed = {right} ? 1.0 : 0.25; }}"
    );
    let fragment = "layout(location = 0) in float handed; layout(location = 0) out vec4 c;
        void main() { c = vec4(0.0, handed, 0.0, 1.0); }";
    place(&text, &[("make.comp", &maker(&all)), ("s.vert", &vertex), ("s.frag", fragment)])
}

#[test]
fn attributes_that_are_declared_have_their_place_in_a_vertex_whether_read_or_not() {
    for (declarations, right, further) in [
        ("layout(location = 1) in vec2 uv; layout(location = 2) in float a;", "a == 5.0", &[7.0, 7.0, 5.0][..]),
        (
            "layout(location = 2) in float a; layout(location = 5) in vec4 unused;",
            "a == 5.0",
            &[5.0, 7.0, 7.0, 7.0, 7.0],
        ),
        ("layout(location = 1) in mat3 unused; layout(location = 4) in float a;", "a == 5.0", &[7.0; 10][..9]),
        ("layout(location = 1) in vec3 unused[2]; layout(location = 3) in float a;", "a == 5.0", &[7.0; 7][..6]),
        ("layout(location = 1) in uint unused; layout(location = 2) in float a;", "a == 5.0", &[7.0, 5.0]),
    ] {
        // Behind a matrix or an array stands what is read.
        let mut further = further.to_vec();
        if matches!(further.len(), 9 | 6) {
            further.push(5.0);
        }
        let place = vertices(declarations, right, &further);
        check(&place, &[]).exits(0);
        draws(&place, &[], GREEN);
    }
}

#[test]
fn matrices_arrays_and_shared_locations_are_attributes() {
    let four: Vec<f32> = (1..=16_u8).map(f32::from).collect();
    for (declarations, right, further) in [
        (
            "layout(location = 1) in mat4 m;",
            "m == mat4(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16)",
            &four[..],
        ),
        ("layout(location = 1) in mat2x3 m;", "m == mat2x3(1, 2, 3, 4, 5, 6)", &four[..6]),
        ("layout(location = 1) in mat2 m[2];", "m[0] == mat2(1, 2, 3, 4) && m[1] == mat2(5, 6, 7, 8)", &four[..8]),
        ("layout(location = 1) in vec3 a[2];", "a[0] == vec3(1, 2, 3) && a[1] == vec3(4, 5, 6)", &four[..6]),
        (
            "layout(location = 1) in float a; layout(location = 1, component = 1) in float b;",
            "a == 1 && b == 2",
            &four[..2],
        ),
        (
            "layout(location = 1, component = 2) in vec2 b; layout(location = 1) in float a; layout(location = 2) in float c;",
            "a == 1 && b == vec2(3, 4) && c == 5",
            &four[..5],
        ),
        ("layout(location = 1, component = 1) in vec2 b;", "b == vec2(2, 3)", &four[..3]),
    ] {
        let place = vertices(declarations, right, further);
        check(&place, &[]).exits(0);
        draws(&place, &[], GREEN);
    }
}

#[test]
fn attributes_that_no_buffer_holds_are_refused_with_their_line() {
    for (declarations, said) in [
        ("layout(location = 1) in float a; layout(location = 1, component = 1) in int b;", "is of another type"),
        ("layout(location = 1) in dvec2 a;", "is a dvec2, and vertices hold numbers of 32 bits"),
        ("layout(location = 1) in uint64_t a;", "is a uint64_t, and vertices hold numbers of 32 bits"),
    ] {
        let place = vertices(declarations, "true", &[0.0]);
        if declarations.contains("uint64_t") {
            let text = std::fs::read_to_string(place.path("s.vert")).expect("a text");
            let extension = "#version 460\n#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require";
            place.file("s.vert", text.replace("#version 460", extension).replace("handed =", "handed = a == 7ul || "));
        } else if declarations.contains("dvec2") {
            let text = std::fs::read_to_string(place.path("s.vert")).expect("a text");
            place.file("s.vert", text.replace("handed =", "handed = a.x == 7.0 || "));
        }
        let line = if declarations.contains("uint64_t") { 4 } else { 3 };
        check(&place, &[]).exits(1).mentions(&format!("s.vert:{line}: ")).mentions(said);
    }
}

#[test]
fn locations_that_not_every_device_has_are_refused_with_their_line() {
    let last = vertices("layout(location = 15) in float a;", "a == 5.0", &[5.0]);
    check(&last, &["--device", "all"]).exits(0);
    draws(&last, &[], GREEN);
    for (declared, name, stage, most) in [
        ("layout(location = 16) in float a;", "a", "vert", 15),
        ("layout(location = 13) in mat4 m;", "m", "vert", 15),
        ("layout(location = 14) in vec2 a[3];", "a", "vert", 15),
        ("layout(location = 14) out float a;", "a", "vert", 13),
        ("layout(location = 13) out mat2 m;", "m", "vert", 13),
        ("layout(location = 14) in float a;", "a", "frag", 13),
    ] {
        let place = vertices("", "true", &[0.0]);
        let file = format!("s.{stage}");
        let text = std::fs::read_to_string(place.path(&file)).expect("a text");
        place.file(&file, text.replacen("#version 460\n", &format!("#version 460\n{declared}\n"), 1));
        let said = format!("{file}:2: `{name}` at location {}: locations go up to {most}", most + 1);
        check(&place, &["--device", "all"]).exits(1).mentions(&said).mentions("p.ron:6:");
    }
}

#[test]
fn a_vertex_buffer_that_is_shorter_than_its_vertices_is_refused() {
    let place = vertices("layout(location = 1) in mat4 m;", "m[0][0] == 1.0", &[1.0; 16]);
    check(&place, &[]).exits(0);
    let text = std::fs::read_to_string(place.path("p.ron")).expect("a text");
    place.file("p.ron", text.replace("bytes: 216", "bytes: 212"));
    check(&place, &[]).exits(1).mentions("`v` has 212 bytes; 3 vertices of 72 bytes take 216").mentions("p.ron:6:");
}

#[test]
fn a_block_that_is_longer_than_its_buffer_is_refused() {
    for (block, bytes) in [
        ("readonly buffer B { vec4 a; float b[3]; } b;", 28),
        ("readonly buffer B { uint count; uint more; uint all[]; } b;", 8),
        ("uniform B { vec4 a; float b[2]; } b;", 48),
    ] {
        let how = if block.starts_with("uniform") { "uniform" } else { "storage" };
        for (there, fits) in [(bytes, true), (bytes - 4, false)] {
            let passes = format!(
                r#"        (name: "zero", fill: (to: "b", value: 0)),
        (name: "draw", draw: FullScreen("s"), {how}: {{"b": "b"}}, color: ["o"])"#
            );
            let text = pipeline(&format!("], buffers: [(name: \"b\", bytes: {})],", there), &passes);
            let read = if block.contains("count") { "float(b.count)" } else { "b.a.x" };
            let fragment = format!(
                "layout(set = 0, binding = 0) {block} layout(location = 0) out vec4 c;
                void main() {{ c = vec4({read}, 1.0, 0.0, 1.0); }}"
            );
            let place = place(&text, &[("s.frag", &fragment)]);
            if fits {
                check(&place, &[]).exits(0);
                draws(&place, &[], GREEN);
            } else {
                let said = format!("the members of the block `b` take {bytes}");
                check(&place, &[]).exits(1).mentions(&said).mentions("p.ron:6:");
            }
        }
    }
}

const LATER: &str = "layout(location = 0) out vec4 c;\nvoid main() { c = vec4(0.0, 1.0, 0.0, 1.0); }";

#[test]
fn objects_may_declare_attributes_that_they_do_not_read_if_the_scene_has_them() {
    let passes = r#"        (name: "draw", draw: Objects(Opaque), shader: "s", color: [(image: "o", clear: (0, 1, 0, 1))], depth: (image: "d", clear: 0.0))"#;
    let text = pipeline(", (name: \"d\", format: Depth, size: Fixed(8, 8))],", passes);
    let vertex = "#extension GL_GOOGLE_include_directive : require
        #include \"include/rotation.glsl\"
        #include \"include/scene.glsl\"
        layout(location = 0) in vec3 position;
        layout(location = 1) in vec3 normal;
        layout(location = 2) in vec2 uv;
        void main() {
            mat4 to_world = objects.object[gl_InstanceIndex].object_to_world;
            gl_Position = rotate_clip(view.world_to_clip * to_world * vec4(position, 1.0));
        }";
    let place = place(&text, &[("s.vert", vertex), ("s.frag", LATER)]);
    check(&place, &[]).exits(0);
    draws(&place, &[], GREEN);
    place.file("s.vert", format!("#version 460\n{}", vertex.replace("vec2 uv", "vec4 tint")));
    check(&place, &[]).exits(1).mentions("shader `s` declares the vertex attribute `tint`, which doesn't exist");
}

#[test]
fn draws_without_vertices_may_not_declare_attributes() {
    let vertex = "layout(location = 0) in vec2 unused;
        void main() { gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0); }";
    for (draw, said) in [
        (
            "draw: Vertices(3), shader: \"s\"",
            "shader `s` declares the vertex attribute `unused`, and pass `draw` has no buffer",
        ),
        ("draw: FullScreen(\"s\")", "shader `s` declares the vertex attribute `unused`, which doesn't exist"),
    ] {
        let passes = format!("        (name: \"draw\", {draw}, color: [(image: \"o\", clear: (0, 0, 0, 1))])");
        let place = place(&pipeline("],", &passes), &[("s.vert", vertex), ("s.frag", LATER)]);
        check(&place, &[]).exits(1).mentions(said).mentions("p.ron:5:");
    }
}

#[test]
fn an_input_that_is_not_read_need_not_be_handed_over() {
    let passes = r#"        (name: "draw", draw: FullScreen("s"), color: ["o"])"#;
    for (declared, body) in [
        ("layout(location = 1) in vec3 normal;", "vec4(uv * 0.0, 0.0, 1.0)"),
        ("layout(location = 1) flat in ivec2 a[3];", "vec4(uv * 0.0, 0.0, 1.0)"),
        ("layout(location = 1) in Block { vec3 a; mat3 b; } block;", "vec4(uv * 0.0, 0.0, 1.0)"),
        ("layout(location = 0, component = 2) in float more;", "vec4(uv * 0.0, 0.0, 1.0)"),
    ] {
        let fragment = format!(
            "layout(location = 0) in vec2 uv; {declared} layout(location = 0) out vec4 c;
            void main() {{ c = {body} + vec4(0.0, 1.0, 0.0, 0.0); }}"
        );
        let place = place(&pipeline("],", passes), &[("s.frag", &fragment)]);
        check(&place, &[]).exits(0);
        draws(&place, &[], GREEN);
    }
    for (declared, body, said) in [
        ("layout(location = 1) in vec3 normal;", "normal.x", "reads `vec3 normal` at location 1"),
        ("layout(location = 1) in Block { vec3 a; vec2 b; } block;", "block.b.x", "reads `vec3 a` at location 1"),
        ("layout(location = 1, component = 3) in float a;", "a", "reads `float a` at location 1, component 3"),
    ] {
        let fragment = format!(
            "layout(location = 0) in vec2 uv;\n{declared}\nlayout(location = 0) out vec4 c;
            void main() {{ c = vec4(uv, {body}, 1.0); }}"
        );
        let place = place(&pipeline("],", passes), &[("s.frag", &fragment)]);
        check(&place, &[]).exits(1).mentions(said).mentions("s.frag:3: ").mentions("hands over nothing");
    }
}

#[test]
fn values_between_stages_meet_by_location_component_and_block() {
    let passes =
        r#"        (name: "draw", draw: Vertices(3), shader: "s", color: [(image: "o", clear: (0, 0, 1, 1))])"#;
    for (out, set, taken, right) in [
        (
            "layout(location = 0) out float a; layout(location = 0, component = 1) out float b;",
            "a = 2.0; b = 3.0;",
            "layout(location = 0, component = 1) in float b;",
            "b == 3.0",
        ),
        (
            "layout(location = 1) out Block { vec2 a; mat2 b; float c; } it;",
            "it.a = vec2(1.0); it.b = mat2(1, 2, 3, 4); it.c = 5.0;",
            "layout(location = 1) in Block { vec2 a; mat2 b; float c; } it;",
            "abs(it.c - 5.0) < 0.01 && abs(it.b[1][1] - 4.0) < 0.01",
        ),
    ] {
        let vertex = format!(
            "{out} void main() {{
                gl_Position = vec4(vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4.0 - 1.0, 0.5, 1.0); {set} }}"
        );
        let fragment = format!(
            "{taken} layout(location = 0) out vec4 c; void main() {{ c = {right} ? vec4(0, 1, 0, 1) : vec4(1, 0, 0, 1); }}"
        );
        let place = place(&pipeline("],", passes), &[("s.vert", &vertex), ("s.frag", &fragment)]);
        check(&place, &[]).exits(0);
        draws(&place, &[], GREEN);
    }
}

#[test]
fn what_an_included_file_asks_of_an_image_is_answered() {
    let passes = r#"        (name: "f", fill: (to: "x", value: 0.5)),
        (name: "draw", draw: FullScreen("s"), sample: {"source": "x"}, color: ["o"])"#;
    let text = pipeline(", (name: \"x\", format: R8_UNORM, size: Fixed(8, 8))],", passes);
    let declared = "layout(set = 0, binding = 0) uniform sampler2D source;";
    for (asked, declaration) in [
        ("#ifdef HAS_source\nconst bool right = true;\n#else\nconst bool right = false;\n#endif", declared),
        ("const bool right = COMPONENTS_source == 1;", declared),
        ("#define right (source_st == vec4(1.0, 1.0, 0.0, 0.0))", declared),
        ("layout(set = 0, binding = 0) uniform TEXTURE_source source;\nconst bool right = true;", ""),
    ] {
        let fragment = format!(
            "#extension GL_GOOGLE_include_directive : require
            {declaration}
            #include \"deep/outer.glsl\"
            layout(location = 0) out vec4 c;
            void main() {{
                float x = texelFetch(source, ivec2(gl_FragCoord.xy), 0).r;
                c = right && x > 0.4 ? vec4(0, 1, 0, 1) : vec4(1, 0, 0, 1);
            }}"
        );
        let place = place(&text, &[("s.frag", &fragment)]);
        std::fs::create_dir(place.path("deep")).expect("a folder");
        place.file("deep/outer.glsl", "#include \"inner.glsl\"\n");
        place.file("deep/inner.glsl", format!("{asked}\n"));
        check(&place, &[]).exits(0);
        draws(&place, &[], GREEN);
    }
}

#[test]
fn names_of_macros_that_a_shader_declares_itself_are_its_own() {
    let passes = r#"        (name: "f", fill: (to: "x", value: 0.5)),
        (name: "draw", draw: FullScreen("s"), sample: {"source": "x"}, params: {"source_st": (0, 1, 0, 1)}, color: ["o"])"#;
    let text = pipeline(", (name: \"x\", format: R8_UNORM, size: Fixed(8, 8))],", passes);
    let fragment = "#extension GL_GOOGLE_include_directive : require
        layout(set = 0, binding = 0) uniform sampler2D source;
        layout(set = 0, binding = 1) uniform params { vec4 source_st; };
        #include \"help.glsl\"
        const int COMPONENTS_source = 3;
        const bool HAS_source = true, DEPTH_ONLY = false;
        layout(location = 0) out vec4 c;
        void main() {
            int eye_index = 0;
            bool right = HAS_source && COMPONENTS_source == 3 && eye_index == 0 && !DEPTH_ONLY;
            c = right ? help(source, source_st) : vec4(1, 0, 0, 1);
        }";
    let place = place(&text, &[("s.frag", fragment)]);
    place.file("help.glsl", "vec4 help(sampler2D source, vec4 source_st) { return source_st; }\n");
    check(&place, &[]).exits(0);
    draws(&place, &[], GREEN);
}

#[test]
fn constants_in_the_place_of_those_that_turn_pictures_are_refused() {
    let passes = r#"        (name: "draw", draw: FullScreen("s"), color: ["o"])"#;
    for (number, declared) in [
        (100, "const int TAPS = 7"),
        (101, "const bool ON = true"),
        (102, "const float SCALE = 1.0"),
        (103, "const int EYE = 1"),
    ] {
        let name = declared.split(' ').nth(2).expect("a name");
        let fragment = format!("layout(constant_id = {number}) {declared};\n{LATER}");
        let place = place(&pipeline("],", passes), &[("s.frag", &fragment)]);
        let said = format!("s.frag:2: `{name}` has the `constant_id` {number}: 100 to 103 say how pictures are turned");
        check(&place, &[]).exits(1).mentions(&said);
    }
    for number in [99, 104] {
        let fragment = format!("layout(constant_id = {number}) const int TAPS = 7;\n{LATER}");
        check(&place(&pipeline("],", passes), &[("s.frag", &fragment)]), &[]).exits(0);
    }
}

#[test]
fn outputs_that_share_a_location_write_their_components_together() {
    let passes = r#"(name: "fill", draw: FullScreen("fill"), color: ["o"])"#;
    let two = "layout(location = 0, component = 0) out vec2 rg; layout(location = 0, component = 2) out vec2 ba;";
    let right = format!("{two} void main() {{ rg = vec2(0, 1); ba = vec2(0, 1); }}");
    draws(&place(&pipeline("],", passes), &[("fill.frag", &right)]), &[], GREEN);
    let three = "layout(location = 0, component = 0) out vec2 rg; layout(location = 0, component = 3) out float a;";
    let wrong = format!("{three} void main() {{ rg = vec2(0, 1); a = 1.0; }}");
    let place = place(&pipeline("],", passes), &[("fill.frag", &wrong)]);
    check(&place, &[]).exits(1).mentions("writes 3 of the 4 components of `o`");
}
