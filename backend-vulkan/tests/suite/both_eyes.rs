//! What the shaders of both eyes are made of: nothing of it is left where there is one eye (ST-6), each look-up of what both eyes
//! have in layers is given its layer, and all that is made so is valid SPIR-V.

use framewright_graph::base::Root;
use framewright_graph::frame::{Draw, Eye, EyeForm};
use framewright_graph::shader::{DrawInterface, EyeSource, ShaderProblem, Variant};
use framewright_graph::vulkan::ImageShape;
use framewright_passes::shipped::SHADERS;
use framewright_vulkan::ShaderLibrary;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Capability, Op, StorageClass};
use std::fs;
use std::process::{Command, Stdio};

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

/// Gives a tool SPIR-V, and returns what it writes, if it is there.
fn tool(name: &str, arguments: &[&str], spirv: &[u32]) -> Option<Vec<u8>> {
    let bytes: Vec<u8> = spirv.iter().flat_map(|word| word.to_le_bytes()).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("in.spv"), bytes).expect("written");
    let mut command = Command::new(name);
    command.args(arguments).arg(path("in.spv")).stdin(Stdio::null());
    if name == "spirv-opt" {
        command.arg("-o").arg(path("out.spv"));
    }
    let Ok(output) = command.output() else {
        assert!(std::env::var_os("CI").is_none(), "`{name}` of spirv-tools isn't there");
        println!("skipped: `{name}` of spirv-tools isn't there");
        return None;
    };
    let said = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{name}: {said}\n{}", disassembled(spirv));
    Some(if name == "spirv-opt" { fs::read(path("out.spv")).expect("it is written") } else { Vec::new() })
}

fn valid(spirv: &[u32]) {
    tool("spirv-val", &["--target-env", "vulkan1.3"], spirv);
}

fn module(spirv: &[u32]) -> Module {
    rspirv::dr::load_words(spirv).expect("it is SPIR-V")
}

fn disassembled(spirv: &[u32]) -> String {
    use rspirv::binary::Disassemble;
    module(spirv).disassemble()
}

/// The instructions of all functions.
fn code(module: &Module) -> impl Iterator<Item = &Instruction> + Clone {
    module.functions.iter().flat_map(|it| &it.blocks).flat_map(|it| &it.instructions)
}

fn number(operand: Option<&Operand>) -> u32 {
    match operand {
        Some(Operand::LiteralBit32(number)) => *number,
        other => panic!("{other:?}"),
    }
}

/// Image variables by name, with whether they are arrays.
fn images(module: &Module) -> Vec<(String, bool)> {
    let global = |id: u32| module.types_global_values.iter().find(|it| it.result_id == Some(id)).expect("declared");
    let operand = |it: &Instruction, at: usize| it.operands[at].id_ref_any().expect("an id");
    let name = |id: u32| {
        let named = |it: &&Instruction| it.class.opcode == Op::Name && it.operands[0] == Operand::IdRef(id);
        match module.debug_names.iter().find(named).map(|it| &it.operands[1]) {
            Some(Operand::LiteralString(name)) => name.clone(),
            other => panic!("{other:?}"),
        }
    };
    let variables = module.types_global_values.iter().filter(|it| {
        it.class.opcode == Op::Variable && it.operands[0] == Operand::StorageClass(StorageClass::UniformConstant)
    });
    let of = |variable: &Instruction| {
        let pointer = global(variable.result_type.expect("a pointer"));
        let image = global(operand(global(operand(pointer, 1)), 0));
        (name(variable.result_id.expect("an id")), number(image.operands.get(3)) == 1)
    };
    let mut found: Vec<_> = variables.map(of).collect();
    found.sort();
    found
}

/// How many coordinates each look-up has, in order: a number of components of their type.
fn coordinates(module: &Module) -> Vec<(Op, u32)> {
    let looks_up = |it: &&Instruction| {
        let op = it.class.opcode;
        format!("{op:?}").starts_with("ImageSample") || matches!(op, Op::ImageFetch | Op::ImageGather)
    };
    let components = |value: u32| {
        let all = module.types_global_values.iter().chain(code(module));
        let all = all.chain(module.functions.iter().flat_map(|it| &it.parameters));
        let ty = all.clone().find(|it| it.result_id == Some(value)).and_then(|it| it.result_type).expect("a type");
        let ty = all.clone().find(|it| it.result_id == Some(ty)).expect("declared");
        if ty.class.opcode == Op::TypeVector { number(ty.operands.get(1)) } else { 1 }
    };
    let used = reachable(module);
    let functions = module.functions.iter().filter(|it| used.contains(&it.def.as_ref().and_then(|it| it.result_id)));
    let code = functions.flat_map(|it| &it.blocks).flat_map(|it| &it.instructions);
    code.filter(looks_up).map(|it| (it.class.opcode, components(it.operands[1].id_ref_any().expect("an id")))).collect()
}

/// Functions that are called, by their ids.
fn reachable(module: &Module) -> Vec<Option<u32>> {
    let mut found = vec![module.entry_points[0].operands[1].id_ref_any()];
    let mut at = 0;
    while at < found.len() {
        let function = module.functions.iter().find(|it| it.def.as_ref().and_then(|it| it.result_id) == found[at]);
        let code = function.expect("declared").blocks.iter().flat_map(|it| &it.instructions);
        let called = code.filter(|it| it.class.opcode == Op::FunctionCall).map(|it| it.operands[0].id_ref_any());
        let new: Vec<_> = called.filter(|it| !found.contains(it)).collect();
        found.extend(new);
        at += 1;
    }
    found
}

fn capabilities(module: &Module) -> Vec<Capability> {
    let of = |it: &Instruction| match it.operands[0] {
        Operand::Capability(capability) => capability,
        _ => panic!("{it:?}"),
    };
    module.capabilities.iter().map(of).collect()
}

/// The instructions that are left of a stage's functions once it is optimised, by name, sorted.
fn optimised(spirv: &[u32]) -> Option<Vec<String>> {
    let bytes = tool("spirv-opt", &["-O", "--strip-debug", "--compact-ids"], spirv)?;
    let words: Vec<u32> = bytes.chunks(4).map(|it| u32::from_le_bytes([it[0], it[1], it[2], it[3]])).collect();
    let mut left: Vec<String> = code(&module(&words)).map(|it| format!("{:?}", it.class.opcode)).collect();
    left.sort();
    Some(left)
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

const TWO: &str = "layout(set = 0, binding = 0) uniform sampler2D own;
layout(set = 0, binding = 1) uniform sampler2D shared_one;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
";

const LAYERS: [(EyeSource, EyeForm); 2] = [WAYS[0], WAYS[1]];

#[test]
fn only_what_each_eye_has_of_its_own_is_in_layers() {
    let text = format!("{TWO}void main() {{ color = texture(own, uv) + texture(shared_one, uv); }}");
    for way in LAYERS {
        let spirv = fragment(&text, &both(way, &["own"]));
        let module = module(&spirv);
        assert_eq!(images(&module), [("own".to_owned(), true), ("shared_one".to_owned(), false)]);
        let op = Op::ImageSampleImplicitLod;
        assert_eq!(coordinates(&module), [(op, 3), (op, 2)], "{}", disassembled(&spirv));
        // Neither where one eye's is named, or where there is one.
        let one = Variant { eyes: vec![("own".into(), EyeForm::Layers, Some(Eye::Right))], ..both(way, &[]) };
        for variant in [one, both(way, &[]), Variant::default()] {
            assert!(images(&self::module(&fragment(&text, &variant))).iter().all(|(_, arrayed)| !arrayed));
        }
    }
}

#[test]
fn functions_that_get_both_kinds_of_images_are_there_for_both() {
    let text = format!(
        "{TWO}
        vec4 inner(sampler2D image, vec2 at) {{ return texture(image, at) + texelFetch(image, ivec2(at), 0); }}
        vec4 outer(sampler2D one, sampler2D other) {{
            vec4 sum = vec4(0.0);
            for (int i = 0; i < 3; ++i) {{ sum += inner(one, uv * float(i)) - inner(other, uv); }}
            return sum + vec4(textureSize(one, 0), textureSize(other, 0));
        }}
        void main() {{
            color = outer(own, shared_one) + outer(shared_one, own) + outer(own, own) + outer(shared_one, shared_one);
            if (uv.x > 0.5) {{ color += inner(own, uv); }}
        }}"
    );
    for way in LAYERS {
        let spirv = fragment(&text, &both(way, &["own"]));
        let module = module(&spirv);
        assert_eq!(images(&module), [("own".to_owned(), true), ("shared_one".to_owned(), false)]);
        let mut found = coordinates(&module);
        found.sort_by_key(|(op, components)| (format!("{op:?}"), *components));
        let expected = [
            (Op::ImageFetch, 2),
            (Op::ImageFetch, 3),
            (Op::ImageSampleImplicitLod, 2),
            (Op::ImageSampleImplicitLod, 3),
        ];
        assert_eq!(found, expected, "{}", disassembled(&spirv));
    }
}

#[test]
fn every_kind_of_flat_image_and_look_up_has_its_layer() {
    let shape = |multisampled, component| ImageShape {
        dimension: framewright_graph::vulkan::Dimension::D2,
        arrayed: false,
        multisampled,
        component,
    };
    use framewright_graph::vulkan::Component;
    let text = "
        layout(set = 0, binding = 0) uniform sampler2DMS samples;
        layout(set = 0, binding = 1) uniform usampler2D counts;
        layout(set = 0, binding = 2) uniform isampler2D signs;
        layout(set = 0, binding = 3) uniform TEXTURE_any any;
        layout(set = 0, binding = 4) uniform sampler2DArray already;
        layout(set = 0, binding = 5) uniform sampler2D own;
        layout(location = 0) in vec2 uv;
        layout(location = 0) out vec4 color;
        void main() {
            const ivec2 at = ivec2(gl_FragCoord.xy);
            color = texelFetch(samples, at, 2) + vec4(texelFetch(counts, at, 0)) + vec4(texelFetch(signs, at, 0));
            color += texel_in(any, any_st, at, 0, 1) + texture(already, vec3(uv, 1.0));
            color += textureGrad(own, uv, uv.xy, uv.yx) + textureLod(own, uv, 1.5) + texture(own, uv, 0.5);
            color += textureOffset(own, uv, ivec2(1, -1)) + texelFetchOffset(own, at, 0, ivec2(1));
            color += textureLodOffset(own, uv, 0.0, ivec2(2)) + textureGradOffset(own, uv, uv, uv, ivec2(1));
            color += textureGather(own, uv) + textureGather(own, uv, 2) + textureGatherOffset(own, uv, ivec2(1, 1), 1);
            color.xy += vec2(textureSize(samples) + textureSize(counts, 0) + textureSize(any) + textureSize(own, 1));
            color.z += float(textureQueryLevels(own) + textureSamples(samples));
            color.xy += textureQueryLod(own, uv);
            color += vec4(texelFetch(counts, ivec2(1, 2), 0)) + texture(own, vec2(0.25, 0.75));
        }";
    for way in LAYERS {
        let textures = vec![("any".into(), shape(true, Component::Float))];
        let own = ["samples", "counts", "signs", "any", "own"];
        let spirv = fragment(text, &Variant { textures, ..both(way, &own) });
        let module = module(&spirv);
        assert!(images(&module).iter().all(|(_, arrayed)| *arrayed), "{:?}", images(&module));
        let found = coordinates(&module);
        assert!(found.iter().all(|(_, components)| *components == 3), "{found:?}\n{}", disassembled(&spirv));
        assert_eq!(found.len(), 4 + 1 + 3 + 2 + 2 + 3 + 2, "{found:?}");
        // A size is that of one layer.
        assert!(code(&module).filter(|it| it.class.opcode == Op::VectorShuffle).count() >= 4);
    }
}

#[test]
fn a_vertex_shader_samples_its_eyes_layer() {
    let vertex = format!(
        "{HEAD}layout(set = 0, binding = 0) uniform sampler2D own;
        layout(location = 0) out vec2 uv;
        void main() {{
            uv = textureLod(own, vec2(0.5), 0.0).xy;
            gl_Position = vec4(uv, float(gl_InstanceIndex), 1.0);
        }}"
    );
    let pixel = format!("{HEAD}{DECLARED}void main() {{ color = vec4(uv, texture(source, uv).xy); }}");
    let pixel = pixel.replace("binding = 0) uniform sampler2D source", "binding = 1) uniform sampler2D source");
    let files = Files::of(&[("test.vert", &vertex), ("test.frag", &pixel)]);
    for way in LAYERS {
        let [vertex, pixel] = files.compiled(&both(way, &["own"])).expect("it compiles");
        assert_eq!(coordinates(&module(&vertex)), [(Op::ImageSampleExplicitLod, 3)]);
        assert_eq!(images(&module(&pixel)), [("source".to_owned(), false)]);
    }
}

#[test]
fn look_ups_that_can_not_be_given_a_layer_are_refused_in_words() {
    for (look_up, expected) in [
        (
            "textureProj(own, vec3(uv, 1.0))",
            "OpImageSampleProjImplicitLod of an image that both eyes have of their own",
        ),
        ("textureProjLod(own, vec3(uv, 1.0), 0.0)", "OpImageSampleProjExplicitLod of an image that both eyes"),
    ] {
        let text = format!("{TWO}void main() {{ color = {look_up} + texture(shared_one, uv); }}");
        for way in LAYERS {
            let said = refused(&text, &both(way, &["own"]));
            assert!(said.contains("test.frag: ") && said.contains(expected), "{said}");
            // Of what both share, or in halves, there is nothing against it.
            fragment(&text, &both(way, &["shared_one"]));
        }
        fragment(&text, &both(WAYS[2], &["own"]));
    }
    let deep = "layout(set = 0, binding = 0) uniform sampler3D own; layout(location = 0) out vec4 color;
        void main() { color = texture(own, vec3(0.5)); }";
    let said = refused(deep, &both(WAYS[0], &["own"]));
    assert!(said.ends_with("`own` isn't declared flat"), "{said}");
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
