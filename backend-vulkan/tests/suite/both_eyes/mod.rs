//! SPIR-V of shaders for both eyes: none of the additions is left where there is one eye (ST-6), each look-up of an image that
//! both eyes have in layers is given its layer, and all that is made so is valid SPIR-V.

mod hlsl;
mod layers;
mod spirv;

use framewright_graph::base::Root;
use framewright_graph::frame::{Draw, Eye, EyeForm};
use framewright_graph::shader::{DrawInterface, EyeSource, ShaderProblem, Variant};
use framewright_graph::vulkan::ImageShape;
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::ShaderLibrary;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Capability, Op, StorageClass};
use spirv::{capabilities, code, disassembled, module, optimised, tool, valid};
use std::fs;

/// Ways to draw for both eyes at once.
const WAYS: [(EyeSource, EyeForm); 4] = [
    (EyeSource::ViewIndex, EyeForm::Layers),
    (EyeSource::InstanceParity, EyeForm::Layers),
    (EyeSource::InstanceParity, EyeForm::Halves),
    (EyeSource::InstanceBit, EyeForm::Halves),
];

const HEAD: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"include/stereo.glsl\"
#include \"include/texture.glsl\"
";

/// Drawing for both eyes so, with these images in the same form.
fn both(way: (EyeSource, EyeForm), eyes: &[&str]) -> Variant {
    let eyes = eyes.iter().map(|name| ((*name).into(), way.1, None)).collect();
    Variant { eye: Some(way.0), form: Some(way.1), eyes, ..Variant::default() }
}

struct Files(tempfile::TempDir);

impl Files {
    fn of(files: &[(&str, &str)]) -> Files {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, text) in files {
            fs::write(folder.path().join(name), text).expect("a file");
        }
        Files(folder)
    }

    fn library(&self) -> ShaderLibrary {
        ShaderLibrary::new(vec![Root::new(self.0.path().to_owned())], SHADERS, |_| DrawInterface::default())
    }

    /// Vertex and fragment stage of the shader `test`, each valid.
    fn compiled(&self, variant: &Variant) -> Result<[Vec<u32>; 2], ShaderProblem> {
        let compiled = self.library().compiled("test", Draw::FullScreen, variant)?;
        let fragment = compiled.fragment.expect("it draws colour").to_vec();
        let stages = [compiled.vertex.to_vec(), fragment];
        stages.iter().for_each(|stage| valid(stage));
        Ok(stages)
    }
}

/// The fragment stage with this text behind the usual head.
fn fragment(text: &str, variant: &Variant) -> Vec<u32> {
    let [_, fragment] = Files::of(&[("test.frag", &format!("{HEAD}{text}"))])
        .compiled(variant)
        .unwrap_or_else(|problem| panic!("{problem:?}"));
    fragment
}

fn refused(text: &str, variant: &Variant) -> String {
    match Files::of(&[("test.frag", &format!("{HEAD}{text}"))]).compiled(variant) {
        Err(ShaderProblem::Unsupported { what }) => what,
        other => panic!("{other:?}"),
    }
}

/// The seam of two halves that one draw fills is cut by a clip distance of the library's own (DO-4).
#[test]
fn clip_distances_of_a_shaders_own_are_refused_where_the_seam_is_cut_by_one() {
    let vertex = "#version 460\nvoid main() { gl_Position = vec4(1.0);\n    gl_ClipDistance[0] = 1.0; }";
    let files = Files::of(&[
        ("test.vert", vertex),
        ("test.frag", &format!("{HEAD}{DECLARED}void main() {{ color = vec4(1.0); }}")),
    ]);
    for way in WAYS {
        let compiled = files.compiled(&both(way, &[]));
        if way != (EyeSource::InstanceParity, EyeForm::Halves) {
            compiled.unwrap_or_else(|problem| panic!("{way:?}: {problem:?}"));
            continue;
        }
        let Err(ShaderProblem::Unsupported { what }) = compiled else { panic!("{way:?}") };
        assert!(what.contains("test.vert:3: it sets clip distances, and"), "{what}");
    }
}

#[test]
fn locations_between_stages_have_one_limit_in_every_way_to_draw_for_both_eyes() {
    let head = "#version 460\n";
    let plain = "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }";
    let ways = WAYS.map(|way| both(way, &[])).into_iter().chain([Variant::default()]);
    for variant in ways {
        for (declared, last) in [
            ("layout(location = 14) WAY vec4 far;", 14),
            ("layout(location = 11) WAY mat4 far;", 14),
            ("layout(location = 12) WAY vec4 far[3];", 14),
            ("layout(location = 13) WAY far { vec4 a; vec4 b; };", 14),
            ("WAY far { layout(location = 14) vec4 a; };", 14),
            ("layout(location = 20) WAY vec4 far;", 20),
        ] {
            let limit = format!(":2: `far` at location {last}: locations go up to 13");
            // Declared and not used is as bad.
            let fragment = format!("{head}{}\n{plain}", declared.replace("WAY", "in"));
            let vertex =
                format!("{head}{}\nvoid main() {{ gl_Position = vec4(1.0); }}", declared.replace("WAY", "out"));
            let white = format!("{head}{plain}");
            for (ending, files) in [
                ("frag", vec![("test.frag", fragment.as_str())]),
                ("vert", vec![("test.vert", vertex.as_str()), ("test.frag", &white)]),
            ] {
                let problem = Files::of(&files).compiled(&variant).expect_err(declared);
                let ShaderProblem::Unsupported { what } = &problem else { panic!("{declared}: {problem:?}") };
                assert!(what.ends_with(&format!("test.{ending}{limit}")), "{variant:?}, {declared}: {what}");
            }
        }
        let passed_on = |way: &str| format!("{head}layout(location = 10) {way} mat4 near;\n");
        let vertex = passed_on("out") + "void main() { gl_Position = vec4(1.0); near = mat4(1.0); }";
        let fragment = passed_on("in") + "layout(location = 0) out vec4 color;\nvoid main() { color = near[3]; }";
        Files::of(&[("test.vert", &vertex), ("test.frag", &fragment)]).compiled(&variant).expect("13 is the last one");
    }
}

const DECLARED: &str = "layout(set = 0, binding = 0) uniform sampler2D source;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
";

#[test]
fn nothing_of_the_helpers_is_left_where_there_is_one_eye() {
    let with = "void main() {
        const vec2 at = screen_uv(uv);
        const vec4 pair = uv_clamp(uv_adjust(screen_uv(uv.xyyx), source_st), source_st, textureSize(source, 0));
        color = texture(source, uv_clamp(uv_adjust(at, source_st), source_st, textureSize(source, 0)));
        color += texture(source, pair.xy) * texture(source, pair.zw);
        color += texture(source, uv_unadjust(uv_adjust(uv, source_st, 1.0), source_st));
        color += found_in(source, source_st, uv) + texel_in(source, source_st, ivec2(3, 4));
        color += scale_offset * float(eye_index);
        color.xy += vec2(used_of(source, source_st));
        color.xyz += non_stereo_screen_pos(uv.xyxy) + screen_pos(uv.xyxy);
    }";
    let without = "void main() {
        const ivec2 size = textureSize(source, 0);
        color = texture(source, uv);
        const vec4 pair = uv.xyyx;
        color += texture(source, pair.xy) * texture(source, pair.zw);
        color += texture(source, uv);
        color += found_at(source, uv, 0, 0) + texelFetch(source, ivec2(3, 4), 0);
        color += vec4(0.0);
        color.xy += vec2(size);
        const vec4 clip = uv.xyxy;
        color.xyz += vec3(0.5 * (clip.xy + clip.w), clip.w) + vec3(0.5 * (clip.xy + clip.w), clip.w);
    }";
    let one = [Variant::default(), Variant { eye: Some(EyeSource::One(Eye::Left)), ..Variant::default() }];
    for variant in one {
        let [with, without] = [with, without].map(|text| fragment(&format!("{DECLARED}{text}"), &variant));
        let raw = module(&with);
        assert!(!disassembled(&with).contains("framewright_eye"), "{}", disassembled(&with));
        let found = capabilities(&raw);
        let expected = [Capability::Shader, Capability::ImageQuery];
        assert!(found.iter().all(|it| expected.contains(it)), "{found:?}");
        let storage = |it: &Instruction| it.operands.first().cloned();
        let variables: Vec<_> = raw.types_global_values.iter().filter(|it| it.class.opcode == Op::Variable).collect();
        for class in [StorageClass::PushConstant, StorageClass::Private] {
            assert!(variables.iter().all(|it| storage(it) != Some(Operand::StorageClass(class))), "{class:?}");
        }
        let (Some(with), Some(without)) = (optimised(&with), optimised(&without)) else { return };
        assert_eq!(with, without, "the same is left of both");
    }
}

#[test]
fn an_image_that_is_not_packed_leaves_nothing_of_its_adjustment_in_any_mode() {
    let adjusted = "void main() { color = found_in(source, source_st, uv) + texel_in(source, source_st, ivec2(uv)); }";
    let plain = "void main() { color = found_at(source, uv, 0, 0) + texelFetch(source, ivec2(uv), 0); }";
    for way in WAYS {
        // Shared by both eyes.
        let [a, b] = [adjusted, plain].map(|text| optimised(&fragment(&format!("{DECLARED}{text}"), &both(way, &[]))));
        assert_eq!(a, b, "{way:?}");
        // Each eye's, in a layer of its own.
        if way.1 == EyeForm::Layers {
            let variant = both(way, &["source"]);
            let [a, b] = [adjusted, plain].map(|text| optimised(&fragment(&format!("{DECLARED}{text}"), &variant)));
            assert_eq!(a, b, "{way:?}");
        }
    }
}

#[test]
fn each_way_takes_of_a_device_what_it_needs_and_no_more() {
    let text = format!("{DECLARED}void main() {{ color = vec4(float(eye_index)); }}");
    let files = Files::of(&[("test.frag", &format!("{HEAD}{text}"))]);
    use Capability::{ClipDistance, MultiView, Shader, ShaderLayer};
    for (way, vertex, pixel) in [
        (WAYS[0], vec![MultiView, Shader], vec![MultiView, Shader]),
        (WAYS[1], vec![Shader, ShaderLayer], vec![Shader]),
        (WAYS[2], vec![ClipDistance, Shader], vec![Shader]),
        (WAYS[3], vec![Shader], vec![Shader]),
    ] {
        let stages = files.compiled(&both(way, &[])).expect("it compiles");
        let found = stages.map(|it| {
            let mut found = capabilities(&module(&it));
            found.sort_by_key(|it| format!("{it:?}"));
            found
        });
        assert_eq!(found, [vertex, pixel], "{way:?}");
    }
}

#[test]
fn every_shipped_shader_is_valid_in_every_way() {
    if tool("spirv-val", &["--version"], &[]).is_none() {
        return;
    }
    let mut library = ShaderLibrary::new(Vec::new(), SHADERS, |_| DrawInterface::default());
    let mut seen = 0;
    for (file, text) in SHADERS {
        let Some(name) = file.strip_suffix(".frag") else { continue };
        let draw = if ["objects", "lit", "g_buffer", "motion", "casters"].iter().any(|it| name.starts_with(it)) {
            Draw::Objects(framewright_graph::frame::DrawList::Opaque)
        } else if name.contains("sky") {
            Draw::Sky
        } else {
            Draw::FullScreen
        };
        // All that it samples as flat is in the form of the way.
        let words: Vec<&str> = text.split(|it: char| it != '_' && !it.is_ascii_alphanumeric()).collect();
        let sampled = words.windows(3).filter(|it| it[0] == "uniform").filter(|it| it[1] == "sampler2D");
        let set = |name: &str| {
            let line = text.lines().find(|line| line.contains("uniform") && line.contains(&format!(" {name};")));
            line.is_some_and(|line| line.contains("set = 0"))
        };
        let own: Vec<&str> = sampled.map(|it| it[2]).filter(|name| set(name)).collect();
        for way in WAYS {
            match library.compiled(&format!("shipped:{name}"), draw, &both(way, &own)) {
                Ok(compiled) => {
                    valid(&compiled.vertex);
                    compiled.fragment.iter().for_each(|it| valid(it));
                    seen += 1;
                }
                Err(problem) => panic!("{name} {way:?}: {problem:?}"),
            }
        }
    }
    assert!(seen > 80, "{seen}");
}

#[test]
fn a_text_may_begin_with_anything_that_glsl_allows() {
    let body = "layout(location = 0) out vec4 color;\nvoid main() { color = vec4(float(eye_index)); }\n";
    let include = "#extension GL_GOOGLE_include_directive : require\n#include \"include/stereo.glsl\"\n";
    for head in [
        "#version 460\n",
        "// For #version 460.\n#version 460\n",
        "/* Some\n   words */\n#version 460 core\n",
        "#  version 460\n",
        "// No version.\n",
        "/* No version\n   in several lines. */\n",
        "\n\n#version 460\n",
        "",
    ] {
        let text = format!("{head}{include}{body}");
        let files = Files::of(&[("test.frag", &text)]);
        assert!(files.compiled(&Variant::default()).is_ok(), "{head:?}");
        for way in WAYS {
            let compiled = files.compiled(&both(way, &[]));
            assert!(compiled.is_ok(), "{way:?}: {head:?}: {compiled:?}");
        }
    }
}

#[test]
fn mistakes_stand_at_their_own_lines_in_every_way() {
    let text = "#version 460\n\nlayout(location = 0) out vec4 color;\nvoid main() {\n    color = vec4(nothing);\n}\n";
    let files = Files::of(&[("test.frag", text)]);
    let said = |variant: &Variant| match files.compiled(variant) {
        Err(ShaderProblem::DoesNotCompile { messages }) => messages,
        other => panic!("{other:?}"),
    };
    let expected = said(&Variant::default());
    assert!(expected[0].text.contains("test.frag:5:"), "{expected:?}");
    for way in WAYS {
        assert_eq!(said(&both(way, &[])), expected, "{way:?}");
    }
}

#[test]
fn which_eye_is_drawn_for_is_known_in_files_that_are_included_too() {
    let files = Files::of(&[
        ("tint.glsl", "#include \"include/stereo.glsl\"\nvec4 tint() { return vec4(float(eye_index)); }\n"),
        (
            "test.frag",
            "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"tint.glsl\"
            layout(location = 0) out vec4 color;\nvoid main() { color = tint(); }\n",
        ),
    ]);
    let of =
        |eye| files.compiled(&Variant { eye: Some(EyeSource::One(eye)), ..Variant::default() }).expect("it compiles");
    let [left, right] = [of(Eye::Left), of(Eye::Right)];
    assert_ne!(left[1], right[1], "the right eye's is another shader");
    assert_eq!(left[0], right[0], "vertices don't ask");
}

/// ST-5: an instance's number less the first one's is what it is for one eye. What counts both eyes' instances also counts the first.
#[test]
fn the_first_instance_of_a_draw_is_told_without_the_eye() {
    let names = ["gl_BaseInstance", "gl_BaseInstanceARB", "0"];
    let counted = |name: &str, way: (EyeSource, EyeForm)| {
        let head = "#version 460\n#extension GL_ARB_shader_draw_parameters : require\n";
        let vertex = format!("{head}void main() {{ gl_Position = vec4(float(gl_InstanceIndex - {name})); }}");
        let files = Files::of(&[
            ("test.vert", &vertex),
            ("test.frag", &format!("{HEAD}{DECLARED}void main() {{ color = vec4(1.0); }}")),
        ]);
        let [vertex, _] = files.compiled(&both(way, &[])).unwrap_or_else(|problem| panic!("{way:?}: {problem:?}"));
        valid(&vertex);
        let module = module(&vertex);
        let count = |op: Op| code(&module).filter(|it| it.class.opcode == op).count();
        [count(Op::BitwiseAnd), count(Op::ShiftRightLogical)]
    };
    for way in WAYS {
        let [own, by_extension, without] = names.map(|name| counted(name, way));
        let more = match way.0 {
            EyeSource::InstanceBit => [1, 0],
            EyeSource::InstanceParity => [0, 1],
            EyeSource::ViewIndex | EyeSource::One(_) => [0, 0],
        };
        assert_eq!(own, [without[0] + more[0], without[1] + more[1]], "{way:?}");
        assert_eq!(by_extension, own, "{way:?}");
    }
}
