//! Stages in HLSL are told of both eyes as stages in GLSL are (DO-2). What they draw, `tests/tests/suite/drawn/stereo/languages.rs` sees.

use super::spirv::*;
use super::*;
use rspirv::spirv::{BuiltIn, Decoration};

/// An effect whose vertex stage is its own. `words` stand in its fragment stage.
fn stages(words: &str, way: (EyeSource, EyeForm)) -> Result<[Vec<u32>; 2], ShaderProblem> {
    let text = format!(
        "#include \"include/stereo.hlsl\"
#include \"include/part.hlsl\"
Texture2D source;
Texture2D mono;
SamplerState smooth;
static const float4 shares[2] = {{ float4(1, 0, 0, 0), float4(0, 1, 0, 0) }};
static float own = float(eye_index) * 0.5;
struct Shift {{ float4 by; }};
StructuredBuffer<Shift> shifts;
struct Triangle {{ float4 position : SV_Position; [[vk::location(0)]] float2 uv : TEXCOORD0; }};
Triangle VSMain(uint vertex : SV_VertexID, uint instance : SV_InstanceID, uint view : SV_ViewID) {{
    Triangle it;
    it.uv = float2((vertex << 1) & 2, vertex & 2) + (eye_index == 1 ? 0.25 : 0.5) * instance + view + shifts[instance].by.xy;
    it.position = float4(screen_uv(it.uv) * 2.0 - 1.0, own, 1.0);
    return it;
}}
float4 PSMain(Triangle it) : SV_Target0 {{
    float4 sum = shares[eye_index] * own;
    {words}
    return sum;
}}\n"
    );
    let files = Files::of(&[("test.hlsl", &text)]);
    let eyes = if words.contains("source") { &["source"][..] } else { &[] };
    let name = "vertex test.hlsl:VSMain, fragment test.hlsl:PSMain";
    let compiled = files.library().compiled(name, Draw::FullScreen, &both(way, eyes))?;
    let stages = [compiled.vertex.to_vec(), compiled.fragment.expect("it draws colour").to_vec()];
    stages.iter().for_each(|stage| valid(stage));
    Ok(stages)
}

#[test]
fn a_stage_in_hlsl_knows_the_eye_in_each_way() {
    use Capability::{ClipDistance, MultiView, Shader, ShaderLayer};
    let words = "uint2 texels; source.GetDimensions(texels.x, texels.y);
    sum += source.Sample(smooth, uv_adjust(it.uv, source_st)) + mono.Sample(smooth, it.uv) + source.Load(int3(texels, 0));
    for (int i = 0; i < eye_index + 2; ++i) { sum += source.SampleLevel(smooth, it.uv, i); }";
    for (way, vertex) in WAYS.into_iter().zip([
        vec![MultiView, Shader],
        vec![Shader, ShaderLayer],
        vec![ClipDistance, Shader],
        vec![Shader],
    ]) {
        let [vertices, fragments] = stages(words, way).unwrap_or_else(|problem| panic!("{way:?}: {problem:?}"));
        let mut found = capabilities(&module(&vertices));
        found.sort_by_key(|it| format!("{it:?}"));
        assert_eq!(found, vertex, "{way:?}");
        // Nothing stands for the eye any more, and no view is asked for where the device draws none.
        let built_in = |module: &Module, wanted: BuiltIn| {
            module.annotations.iter().any(|it| it.operands.contains(&Operand::BuiltIn(wanted)))
        };
        for stage in [&vertices, &fragments] {
            let module = module(stage);
            let has = |wanted: Decoration| {
                module.annotations.iter().any(|it| it.operands.get(1) == Some(&Operand::Decoration(wanted)))
            };
            assert!(!has(Decoration::SpecId), "{}", disassembled(stage));
            assert_eq!(built_in(&module, BuiltIn::ViewIndex), way.0 == EyeSource::ViewIndex, "{way:?}");
        }
        assert_eq!(built_in(&module(&vertices), BuiltIn::Layer), way == WAYS[1], "{way:?}");
        // The image of each eye is looked up by three numbers, in layers.
        let mut lookups: Vec<u32> = coordinates(&module(&fragments)).into_iter().map(|(_, length)| length).collect();
        lookups.sort_unstable();
        let own = if way.1 == EyeForm::Layers { 3 } else { 2 };
        assert!(lookups.contains(&2) && lookups.last() == Some(&own), "{way:?}: {lookups:?}");
    }
}

#[test]
fn what_is_the_same_for_both_eyes_cant_follow_from_the_eye() {
    for way in WAYS {
        let refused = stages("float many[2 + eye_index]; many[0] = it.uv.x; sum += many[0];", way);
        let Err(ShaderProblem::Unsupported { what }) = refused else { panic!("{way:?}: {refused:?}") };
        assert!(what.contains("test.hlsl:7: the length of an array, or a type, depends on the eye"), "{what}");
    }
}

#[test]
fn a_stage_that_chooses_its_layer_is_refused_where_the_eye_chooses_it() {
    let text = "struct Corner { float4 position : SV_Position; uint layer : SV_RenderTargetArrayIndex; };
Corner VSMain(uint vertex : SV_VertexID) {
    Corner it;
    it.position = float4(float2((vertex << 1) & 2, vertex & 2) * 2.0 - 1.0, 0.0, 1.0);
    it.layer = 1;
    return it;
}
float4 PSMain() : SV_Target0 { return float4(1.0, 1.0, 1.0, 1.0); }\n";
    let files = Files::of(&[("test.hlsl", text)]);
    for way in WAYS {
        let name = "vertex test.hlsl:VSMain, fragment test.hlsl:PSMain";
        let compiled = files.library().compiled(name, Draw::FullScreen, &both(way, &[]));
        let what = match compiled {
            Err(ShaderProblem::Unsupported { what }) => what,
            Err(problem) => panic!("{way:?}: {problem:?}"),
            Ok(_) => String::new(),
        };
        let refused = what.contains("it chooses its layer, and so does a draw for both eyes");
        assert_eq!(refused, way == (EyeSource::InstanceParity, EyeForm::Layers), "{way:?}: {what}");
    }
}

#[test]
fn glsl_is_told_by_the_index_of_a_view_in_each_way_too() {
    let head = "#version 460\n#extension GL_EXT_multiview : require\n";
    let declared = "layout(location = 0) in vec2 uv;\nlayout(location = 0) out vec4 color;\n";
    let text = format!("{head}{declared}void main() {{ color = vec4(float(gl_ViewIndex)); }}");
    let files = Files::of(&[("test.frag", &text)]);
    let one = |eye| Variant { eye: Some(EyeSource::One(eye)), ..Variant::default() };
    for variant in WAYS.map(|way| both(way, &[])) {
        let [_, fragment] = files.compiled(&variant).unwrap_or_else(|problem| panic!("{variant:?}: {problem:?}"));
        let by_views = variant.eye == Some(EyeSource::ViewIndex);
        assert_eq!(capabilities(&module(&fragment)).contains(&Capability::MultiView), by_views, "{variant:?}");
    }
    // One eye is a constant.
    let [none, left, right] = [Variant::default(), one(Eye::Left), one(Eye::Right)].map(|variant| {
        let [_, fragment] = files.compiled(&variant).unwrap_or_else(|problem| panic!("{variant:?}: {problem:?}"));
        assert_eq!(capabilities(&module(&fragment)), [Capability::Shader]);
        fragment
    });
    assert!(none == left && left != right);
}
