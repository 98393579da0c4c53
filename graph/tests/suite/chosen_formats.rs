//! Formats that a pipeline chose: what they come to in bytes, and what is taken where the device can't use them so.

use crate::testing::pipelines::{INPUTS, right};
use crate::testing::plans::{image, on, shipped};
use framewright_graph::compile::{Compiler, Options};
use framewright_graph::device::{FormatSupport, MemoryEstimate, Profile};
use framewright_graph::expand::Inputs;
use framewright_graph::plan::{ChosenFormat, Plan, Stage};
use framewright_graph::vulkan::Format::{self, *};
use std::sync::Arc;

/// Objects in light, blurred, glass before them blended, and shown. Light stays from frame to frame.
fn text(policies: &str) -> String {
    format!(
        r#"Pipeline(
            version: 1,
            {policies}
            images: [
                (name: "light", format: Color(hdr: true, alpha: false), size: Output, samples: 4),
                (name: "kept", format: Color(hdr: true, alpha: false), size: Output, lifetime: Persistent()),
                (name: "depth", format: Depth, size: Output, samples: 4),
                (name: "screen", format: Output, size: Output),
            ],
            passes: [
                (name: "draw", draw: Objects(Opaque), shader: "lit",
                    color: [(image: "light", clear: (0.0, 0.0, 0.0, 1.0))], depth: (image: "depth", clear: 0.0)),
                (name: "glass", draw: Objects(Transparent), shader: "lit",
                    color: [(image: "light", blend: Premultiplied)], depth: (image: "depth", write: false)),
                (name: "blur", draw: FullScreen("blur_tent"), sample: {{"source": "light"}}, color: ["kept"]),
                (name: "show", draw: FullScreen("blur_tent"), sample: {{"source": "kept"}}, color: ["screen"]),
            ],
            outputs: ["screen"],
        )"#
    )
}

fn plan_at(policies: &str, device: &Profile, output_extent: [u32; 2]) -> Plan {
    let frame = right(&text(policies), &Inputs { output_extent, ..INPUTS });
    on(&frame, device).expect("it compiles")
}

fn plan(policies: &str, device: &Profile) -> Plan {
    plan_at(policies, device, INPUTS.output_extent)
}

fn formats(plan: &Plan) -> [Format; 3] {
    ["light", "kept", "depth"].map(|name| image(plan, name).format)
}

/// Bytes of the choices of all images.
fn chosen_bytes(plan: &Plan) -> i64 {
    plan.images.iter().filter_map(|image| image.chosen.as_ref()).map(|chosen| chosen.more_bytes).sum()
}

#[test]
fn what_a_choice_comes_to_is_the_difference_of_what_the_images_take() {
    for name in ["lavapipe", "swiftshader", "nvidia-rtx-2080", "mali-g78"] {
        let device = shipped(name);
        let all = |plan: &Plan| (plan.totals.transient_bytes + plan.totals.kept_bytes).cast_signed();
        let usual = plan("", &device);
        assert!(usual.images.iter().all(|image| image.chosen.is_none()));
        for policies in
            ["color: Smallest,", "color: Exact,", "depth_format: Smallest,", "color: Smallest, depth_format: Smallest,"]
        {
            let plan = plan(policies, &device);
            let more = chosen_bytes(&plan);
            assert_eq!(more, all(&plan) - all(&usual), "{policies} on {name}");
            assert_ne!(more, 0, "{policies} on {name}");
            assert_eq!(more > 0, policies == "color: Exact,", "{policies} on {name}");
        }
    }
}

#[test]
fn each_image_says_who_chose_its_format_and_what_that_comes_to() {
    let device = shipped("lavapipe");
    let plan = plan("color: Smallest, depth_format: Balanced,", &device);
    assert_eq!(formats(&plan), [B10G11R11_UFLOAT_PACK32, B10G11R11_UFLOAT_PACK32, X8_D24_UNORM_PACK32]);
    let of = |name: &str| image(&plan, name).chosen.clone().expect("it is chosen");
    let texels = 640 * 360;
    let light =
        ChosenFormat { because: "`color: Smallest`".into(), usual: R16G16B16A16_SFLOAT, more_bytes: -16 * texels };
    assert_eq!(of("light"), light);
    assert_eq!(of("light (resolved)"), ChosenFormat { more_bytes: -4 * texels, ..light });
    let depth = ChosenFormat { because: "`depth_format: Balanced`".into(), usual: D32_SFLOAT, more_bytes: 0 };
    assert_eq!(of("depth"), depth);
    let tree = plan.tree();
    assert!(tree.contains("`color: Smallest`: 3.5 MiB fewer than in R16G16B16A16_SFLOAT"), "{tree}");
    assert!(tree.contains("`depth_format: Balanced`: as many bytes as in D32_SFLOAT"), "{tree}");
}

#[test]
fn what_the_device_can_not_do_with_a_chosen_format_gives_it_up_and_is_said() {
    let without = |format: Format, change: fn(&mut FormatSupport)| {
        let mut device = shipped("lavapipe");
        device.formats.iter_mut().filter(|support| support.format == format).for_each(change);
        device
    };
    let light = [R16G16B16A16_SFLOAT, B10G11R11_UFLOAT_PACK32, D32_SFLOAT];
    for (policies, device, expected, lacks) in [
        ("color: Smallest,", without(B10G11R11_UFLOAT_PACK32, |it| it.blend = false), light, "blending"),
        (
            "color: Exact,",
            without(R32G32B32A32_SFLOAT, |it| it.blend = false),
            [R16G16B16A16_SFLOAT, R32G32B32A32_SFLOAT, D32_SFLOAT],
            "blending",
        ),
        (
            "color: Exact,",
            without(R32G32B32A32_SFLOAT, |it| it.linear_filter = false),
            [R16G16B16A16_SFLOAT, R16G16B16A16_SFLOAT, D32_SFLOAT],
            "linear filtering",
        ),
        (
            "depth_format: Balanced,",
            shipped("swiftshader"),
            [R16G16B16A16_SFLOAT, R16G16B16A16_SFLOAT, D32_SFLOAT],
            "DEPTH_STENCIL_ATTACHMENT",
        ),
    ] {
        let plan = plan(policies, &device);
        assert_eq!(formats(&plan), expected, "{policies}");
        let notes = plan.notes.iter().filter(|note| note.stage() == Stage::Fit);
        let said: Vec<&str> = notes.map(|note| &*note.text).collect();
        assert!(!said.is_empty() && said.iter().all(|said| said.contains(lacks)), "{policies}: {said:?}");
        let given_up =
            ["light", "kept", "depth"].map(|name| image(&plan, name)).into_iter().filter(|it| it.chosen.is_none());
        assert!(given_up.count() > 0, "{policies}");
    }
}

#[test]
fn another_size_brings_the_bytes_of_choices_up_to_date() {
    let device = Arc::new(shipped("lavapipe"));
    let [small, large] = [[640, 360], [1280, 720]]
        .map(|output_extent| Arc::new(right(&text("color: Exact,"), &Inputs { output_extent, ..INPUTS })));
    let mut compiler = Compiler::new();
    let options = Options::default();
    let first = compiler.compile(&small, &device, &mut MemoryEstimate(&device), &options).expect("it compiles").clone();
    let second = compiler.compile(&large, &device, &mut MemoryEstimate(&device), &options).expect("it compiles");
    assert_eq!(*second, plan_at("color: Exact,", &device, [1280, 720]));
    assert_eq!(chosen_bytes(second), 4 * chosen_bytes(&first));
}
