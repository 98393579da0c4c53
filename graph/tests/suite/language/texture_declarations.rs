//! A shader may leave to the pass as what it declares an image: the pass's own image says it, and the Plan.

use crate::testing::pipelines::{INPUTS, frame, right, set};
use crate::testing::plans::{on, shipped};
use framewright_graph::compile::{Options, compile};
use framewright_graph::device::{MemoryEstimate, Profile};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::Frame;
use framewright_graph::plan::{Plan, Work};

/// A pipeline whose last pass samples `source`, which is `image` without its name.
fn pipeline(image: &str, source: &str) -> String {
    format!(
        "Pipeline(version: 1, settings: [(name: \"msaa\", value: OneOf(default: 4, of: [1, 4])),
            (name: \"layers\", value: Integer(default: 1, min: 1, max: 9))],
        images: [(name: \"given\", {image}), (name: \"screen\", format: Output, size: Output)],
        passes: [(name: \"fill\", fill: (to: \"given\", value: 0)),
            (name: \"show\", draw: FullScreen(\"any_texture\"), sample: {{\"source\": {source}}}, color: [\"screen\"])],
        outputs: [\"screen\"])"
    )
}

/// As what the last pass's shader declares its image, in GLSL's words.
fn declared(frame: &Frame) -> String {
    frame.passes.last().and_then(|pass| pass.sampled[0].texture).expect("the pass decides").to_string()
}

#[test]
fn what_a_shader_declares_follows_from_what_the_pass_gives() {
    let flat = "format: R16G16B16A16_SFLOAT, size: Output";
    let [samples, layers, depth] = [", samples: \"msaa\"", ", layers: 3", "format: Depth, size: Output"];
    let cube = "format: R8_UNORM, size: Fixed(8, 8), shape: Cube";
    let cases = [
        (flat.to_owned(), "\"given\"", "sampler2D"),
        (format!("{flat}{layers}"), "\"given\"", "sampler2DArray"),
        (format!("{flat}{layers}"), "(image: \"given\", layer: 1)", "sampler2D"),
        (format!("{flat}{layers}"), "(image: \"given\", layer: 1, layers: Rest)", "sampler2DArray"),
        (format!("{flat}{samples}"), "\"given\"", "sampler2D"),
        (format!("{flat}{samples}"), "Resolved(\"given\")", "sampler2D"),
        (format!("{flat}{samples}"), "Samples(\"given\")", "sampler2DMS"),
        (format!("{flat}{samples}"), "(image: Samples(\"given\"), filter: Linear)", "sampler2DMS"),
        (format!("{flat}{samples}{layers}"), "Samples(\"given\")", "sampler2DMSArray"),
        (format!("{flat}, samples: 1"), "Samples(\"given\")", "sampler2D"),
        ("format: R32_UINT, size: Output".to_owned(), "\"given\"", "usampler2D"),
        // A shader that can take depth as it is gets it so.
        (format!("{depth}{samples}"), "\"given\"", "sampler2DMS"),
        (format!("{depth}{samples}"), "Resolved(\"given\")", "sampler2D"),
        (format!("{depth}{samples}"), "DepthOnly(\"given\")", "sampler2D"),
        (depth.to_owned(), "\"given\"", "sampler2D"),
        ("format: DepthStencil, size: Output".to_owned(), "\"given\"", "sampler2D"),
        ("format: DepthStencil, size: Output".to_owned(), "(image: \"given\", plane: Stencil)", "usampler2D"),
        ("format: R8_UNORM, size: Fixed(8, 8), shape: D3(8)".to_owned(), "\"given\"", "sampler3D"),
        (cube.to_owned(), "\"given\"", "samplerCube"),
        (format!("{cube}, layers: 12"), "\"given\"", "samplerCubeArray"),
        (cube.to_owned(), "(image: \"given\", layer: 4)", "sampler2D"),
        (cube.to_owned(), "(image: \"given\", layer: 1, layers: 2)", "sampler2DArray"),
    ];
    for (image, source, expected) in cases {
        let text = pipeline(&image, source);
        // Of floating point alone the fill is a colour.
        assert_eq!(declared(&right(&text, &INPUTS)), expected, "{image}, {source}");
    }
}

fn planned(text: &str, inputs: &Inputs<'_>, device: &Profile) -> Plan {
    on(&right(text, inputs), device).unwrap_or_else(|wrong| panic!("{wrong:?}"))
}

/// The texture type that the Plan has the shader of its last step declare.
fn in_plan(plan: &Plan) -> Option<String> {
    let Some(Work::Render(scope)) = plan.steps.last().map(|step| &step.work) else { panic!("{}", plan.tree()) };
    let binding = scope.passes[0].accesses.iter().find_map(|access| access.binding.as_ref());
    binding.expect("the pass samples").texture.map(|texture| texture.to_string())
}

fn lavapipe() -> Profile {
    shipped("lavapipe")
}

/// Cleared by a draw, since what is multisampled isn't filled.
const SAMPLED: &str = "Pipeline(version: 1, settings: [(name: \"msaa\", value: OneOf(default: 4, of: [1, 4]))],
    images: [(name: \"given\", format: Color(hdr: true), size: Output, samples: \"msaa\"),
        (name: \"screen\", format: Output, size: Output)],
    passes: [(name: \"objects\", draw: Objects(Opaque), shader: \"lit\",
            color: [(image: \"given\", clear: (0.0, 0.0, 0.0, 1.0))]),
        (name: \"show\", draw: FullScreen(\"any_texture\"), sample: {\"source\": Samples(\"given\")}, color: [\"screen\"])],
    outputs: [\"screen\"])";

#[test]
fn a_plan_says_as_what_its_shader_is_compiled_in_both_forms() {
    for (msaa, declared) in [("4", "sampler2DMS"), ("1", "sampler2D")] {
        let set = set(&[("msaa", msaa)]);
        let plan = planned(SAMPLED, &Inputs { set: &set, ..INPUTS }, &lavapipe());
        assert_eq!(in_plan(&plan).as_deref(), Some(declared));
        assert_eq!(plan.totals.resolves, 0, "{}", plan.tree());
        assert!(plan.tree().contains(&format!("source = `given`, sampled as {declared}, ")), "{}", plan.tree());
        let json = plan.to_json().expect("it has a JSON form");
        assert!(json.contains(&format!("\"texture\": \"{declared}\"")), "{json}");
        assert_eq!(Plan::from_json(&json).expect("it is read"), plan);
        assert!(Plan::from_json(&json.replace(declared, "sampler4D")).is_err());
    }
}

#[test]
fn a_shader_that_adapts_does_without_the_samples_that_a_device_lacks() {
    let mut device = lavapipe();
    device.formats.iter_mut().for_each(|format| format.samples = vec![1]);
    let plan = planned(SAMPLED, &INPUTS, &device);
    assert_eq!(in_plan(&plan).as_deref(), Some("sampler2D"));
    let fixed = SAMPLED.replace("any_texture", "custom_resolve");
    let wrong = compile(&right(&fixed, &INPUTS), &device, &mut MemoryEstimate(&device), &Options::default());
    let help = wrong.err().and_then(|wrong| wrong[0].help.clone()).expect("a shader that doesn't adapt is refused");
    assert!(help.contains("declare it `TEXTURE_source source`"), "{help}");
}

#[test]
fn a_shader_with_a_declaration_of_its_own_is_left_as_it_is() {
    let text = SAMPLED.replace("any_texture", "reinhard").replace("Samples(\"given\")", "\"given\"");
    assert_eq!(in_plan(&planned(&text, &INPUTS, &lavapipe())), None);
}

#[test]
fn a_misspelt_name_is_told_by_the_shader_without_its_image() {
    let text = pipeline("format: R16G16B16A16_SFLOAT, size: Output", "\"given\"").replace("\"source\"", "\"sorce\"");
    let said = frame(&text, &INPUTS).expect_err("there is no such image");
    assert!(said.contains("samples no image named `sorce`") && said.contains("did you mean `source`?"), "{said}");
}
