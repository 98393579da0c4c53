//! Samplers (DO-6): their states in a Plan, and what refuses them.

use crate::testing::pipelines::{INPUTS, right, set};
use crate::testing::plans::{on, shipped};
use framewright_graph::base;
use framewright_graph::expand::Inputs;
use framewright_graph::plan::{BindingKind, Plan, Work};
use framewright_graph::verify::verify;
use framewright_graph::vulkan::{AddressMode, BorderColor, Sampler, SamplerReductionMode};

fn text(sampler: &str) -> String {
    format!(
        r#"Pipeline(version: 1,
    settings: [(name: "slant", value: OneOf(default: 8, of: [1, 8, 16])), (name: "bias", value: Number(default: 1.5, min: -40.0, max: 40.0))],
    images: [(name: "color", format: R32_SFLOAT, size: Output), (name: "half", format: R16G16B16A16_SFLOAT, size: Output), (name: "screen", format: Output, size: Output)],
    passes: [(name: "draw", draw: FullScreen("plain"), color: ["color"]), (name: "draw_half", draw: FullScreen("plain"), color: ["half"]),
(name: "look", draw: FullScreen("copy"), color: ["screen"], sample: {{"source": ({sampler})}})],
    outputs: ["screen"])"#
    )
}

fn sampler_mut(plan: &mut Plan) -> &mut Sampler {
    let scopes = plan
        .steps
        .iter_mut()
        .filter_map(|step| if let Work::Render(scope) = &mut step.work { Some(scope) } else { None });
    let passes = scopes.flat_map(|scope| &mut scope.passes).filter(|pass| &*pass.name == "look");
    let mut samplers =
        passes.flat_map(|pass| &mut pass.accesses).filter_map(|access| match &mut access.binding.as_mut()?.kind {
            BindingKind::Sampled(sampler) => Some(sampler),
            BindingKind::Storage | BindingKind::InputAttachment => None,
        });
    samplers.next().expect("it samples")
}

fn plan_with(sampler: &str, chosen: &[(&str, &str)]) -> Plan {
    let set = set(chosen);
    let frame = right(&text(sampler), &Inputs { set: &set, ..INPUTS });
    on(&frame, &shipped("lavapipe")).unwrap_or_else(|errors| panic!("{sampler}: {errors:?}"))
}

#[test]
fn states_stand_in_the_plan_where_they_say_something_and_nowhere_else() {
    let usual = plan_with(r#"image: "color", filter: Nearest"#, &[]);
    let json = usual.to_json().expect("it is written");
    for field in ["border", "reduction", "anisotropy", "lod_bias", "min_lod", "max_lod"] {
        assert!(!json.contains(&format!("\"{field}\"")), "{field}");
    }
    let mut all = plan_with(
        r#"image: "color", filter: Linear, address: Border, border: FloatOpaqueWhite, reduction: Max, anisotropy: "slant",
           lod_bias: "bias", min_lod: 0.5, max_lod: 3.0"#,
        &[("slant", "16"), ("bias", "-2.5")],
    );
    let json = all.to_json().expect("it is written");
    assert_eq!(Plan::from_json(&json).expect("it is read"), all);
    let words =
        "CLAMP_TO_BORDER, border FLOAT_OPAQUE_WHITE, reduced to MAX, anisotropy 16, level bias -2.5, levels 0.5 to 3";
    // Long lines are broken.
    let tree = all.tree().replace(['│', '\n'], " ").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(tree.contains(words), "{tree}");
    let sampler = *sampler_mut(&mut all);
    assert_eq!((sampler.address, sampler.border), (AddressMode::ClampToBorder, Some(BorderColor::FloatOpaqueWhite)));
    assert_eq!((sampler.reduction, sampler.anisotropy), (SamplerReductionMode::Max, 16));
}

#[test]
fn a_border_of_nothing_is_that_of_the_image() {
    let mut plan = plan_with(r#"image: "color", address: Border"#, &[]);
    assert_eq!(sampler_mut(&mut plan).border, Some(BorderColor::FloatTransparentBlack));
}

#[test]
fn what_a_device_lacks_is_refused_with_feature_place_and_device() {
    let cases = [
        ("samplerFilterMinmax", r#"image: "color", filter: Linear, reduction: Min"#),
        ("samplerAnisotropy", r#"image: "color", filter: Linear, anisotropy: 2"#),
        ("samplerMirrorClampToEdge", r#"image: "color", address: MirrorOnce"#),
    ];
    let refused = |sampler: &str, change: &dyn Fn(&mut framewright_graph::device::Profile)| {
        let frame = right(&text(sampler), &INPUTS);
        let mut device = shipped("lavapipe");
        change(&mut device);
        on(&frame, &device).map(|_| ()).map_err(|errors| base::render(&frame.sources, &errors))
    };
    for (feature, sampler) in cases {
        for (missing, _) in cases {
            let without =
                refused(sampler, &|device| device.features.as_mut().expect("known").retain(|it| it != missing));
            if feature != missing {
                assert_eq!(without, Ok(()), "{feature} without {missing}");
                continue;
            }
            let answer = without.expect_err(feature);
            for part in [feature, "`lavapipe`", "test.ron:5:", "E1114"] {
                assert!(answer.contains(part), "{part}: {answer}");
            }
        }
    }
    let no_format = refused(cases[0].1, &|device| device.formats.iter_mut().for_each(|it| it.minmax_filter = false));
    assert!(no_format.expect_err("no format").contains("no least and greatest of R32_SFLOAT"));
    let half = refused(r#"image: "half", filter: Linear, reduction: Min"#, &|_| {});
    assert!(half.expect_err("another format").contains("no least and greatest of R16G16B16A16_SFLOAT"));
    let slant = refused(r#"image: "color", filter: Linear, anisotropy: 16"#, &|device| {
        device.limits.as_mut().expect("known").anisotropy = 8;
    });
    assert!(slant.expect_err("too much").contains("the anisotropy is 16, and 8 is allowed (maxSamplerAnisotropy)"));
    let bias = refused(r#"image: "color", lod_bias: -16.5"#, &|_| {});
    assert!(
        bias.expect_err("too far").contains("the mip level's bias is -16.5, and 16 is allowed (maxSamplerLodBias)")
    );
}

#[test]
fn the_checker_finds_samplers_that_nothing_has() {
    let wrong = |change: fn(&mut Sampler)| {
        let mut plan = plan_with(r#"image: "color", filter: Linear, address: Border"#, &[]);
        change(sampler_mut(&mut plan));
        !verify(&plan).is_empty()
    };
    assert!(!wrong(|_| {}));
    assert!(wrong(|sampler| sampler.border = None));
    assert!(wrong(|sampler| sampler.border = Some(BorderColor::IntOpaqueBlack)));
    assert!(wrong(|sampler| sampler.address = AddressMode::Repeat));
}
