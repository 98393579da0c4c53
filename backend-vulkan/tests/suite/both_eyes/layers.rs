//! Each look-up of what both eyes have in layers is given its layer.

use super::spirv::*;
use super::*;
use rspirv::spirv::Decoration;

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
fn a_function_that_is_there_for_both_says_twice_which_numbers_differ_from_pixel_to_pixel() {
    let text = format!(
        "#extension GL_EXT_nonuniform_qualifier : require
        {TWO}
        layout(set = 0, binding = 2) uniform sampler2D many[4];
        vec4 chosen(sampler2D image, int number) {{
            return texture(image, uv) + texture(many[nonuniformEXT(number)], uv);
        }}
        void main() {{ color = chosen(own, int(uv.x)) + chosen(shared_one, int(uv.y)); }}"
    );
    for way in LAYERS {
        let spirv = fragment(&text, &both(way, &["own"]));
        let module = module(&spirv);
        let different: Vec<_> = (module.annotations.iter())
            .filter(|it| it.operands.get(1) == Some(&Operand::Decoration(Decoration::NonUniform)))
            .filter_map(|it| it.operands[0].id_ref_any())
            .collect();
        let many = (module.debug_names.iter())
            .find(|it| it.operands.get(1) == Some(&Operand::LiteralString("many".to_owned())))
            .and_then(|it| it.operands[0].id_ref_any());
        let chains = code(&module).filter(|it| it.class.opcode == Op::AccessChain);
        let chosen: Vec<_> = chains.filter(|it| it.operands[0].id_ref_any() == many).collect();
        assert_eq!(chosen.len(), 2, "{}", disassembled(&spirv));
        assert!(
            chosen.iter().all(|it| it.result_id.is_some_and(|id| different.contains(&id))),
            "{}",
            disassembled(&spirv)
        );
    }
}
