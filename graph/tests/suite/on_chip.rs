//! What stays on the chip of a device that draws in tiles, beside a sum over the JSON form of the same Plan.

use crate::golden_plans::expanded;
use crate::testing::pipelines::INPUTS;
use crate::testing::plans::{on, shipped as shipped_device};
use framewright_graph::expand::Inputs;
use framewright_graph::frame::Stereo;
use framewright_graph::plan::{Detail, Plan};
use serde_json::Value;

const PIPELINES: [&str; 4] = ["forward.ron", "forward_overlay.ron", "shadows.ron", "image_quality.ron"];

fn plan(pipeline: &str, device: &str, stereo: Stereo) -> Plan {
    let profile = shipped_device(device);
    let frame = expanded(pipeline, &Inputs { stereo, device: Some(&profile), ..INPUTS });
    on(&frame, &profile).expect("a Plan")
}

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is a number"))
}

/// Bits of a texel of one plane, from the digits of the format's name: `R16G16B16A16_SFLOAT`, `D24_UNORM_S8_UINT`.
fn texel_bits(format: &str, plane: &str) -> u64 {
    let part = match plane {
        "STENCIL" => "8",
        "DEPTH" if format.starts_with("X8_D24") || format.starts_with("D24") => "32",
        _ => format.split('_').next().expect("a part"),
    };
    part.split(|letter: char| !letter.is_ascii_digit()).filter_map(|digits| digits.parse::<u64>().ok()).sum()
}

/// Bytes of a Plan's attachments in lazily allocated memory that are neither loaded nor stored.
fn counted(plan: &Value) -> u64 {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let attachments = |step: &Value| list(&step["work"]["render"]["attachments"]);
    let bytes = |attachment: &Value| {
        let image = &plan["images"][number(&attachment["image"]) as usize];
        let lazily = image["role"]["transient"]["heap"].as_u64();
        let lazily = lazily.is_some_and(|heap| plan["heaps"][heap as usize]["lazily_allocated"] == true);
        if !lazily || attachment["load"] == "LOAD" || attachment["store"] == "STORE" {
            return 0;
        }
        let range = &attachment["range"];
        let [width, height] = [0, 1].map(|side| number(&image["extent"][side]));
        let eyes = if image["eyes"].is_null() { 1 } else { 2 };
        let bits = texel_bits(image["format"].as_str().expect("a name"), range["aspects"].as_str().expect("a name"));
        assert_eq!((number(&range["base_mip"]), number(&range["mips"])), (0, 1));
        width * height * number(&range["layers"]) * number(&image["samples"]) * eyes * bits / 8
    };
    list(&plan["steps"]).iter().flat_map(attachments).map(|attachment| bytes(&attachment)).sum()
}

#[test]
fn what_stays_on_the_chip_is_what_a_sum_over_the_plans_json_says() {
    let mut tiled = 0;
    for pipeline in PIPELINES {
        for device in ["mali-g78", "meta-quest-3", "amd-rx-7800-xt"] {
            for stereo in [Stereo::Off, Stereo::DoubleWide, Stereo::Multiview] {
                let plan = plan(pipeline, device, stereo);
                let json = serde_json::from_str(&plan.to_json().expect("a JSON form")).expect("JSON");
                assert_eq!(plan.on_chip(), counted(&json), "{pipeline} on {device}, {stereo:?}");
                assert!(device != "amd-rx-7800-xt" || plan.on_chip() == 0, "{pipeline}: it doesn't draw in tiles");
                tiled += usize::from(plan.on_chip() > 0);
            }
        }
    }
    assert!(tiled > 12, "hardly anything stays on the chip: {tiled}");
}

/// Plans may come from files: one that stores or loads what lies in lazily allocated memory moves it.
#[test]
fn what_is_loaded_or_stored_does_not_stay() {
    let plan = plan("forward.ron", "mali-g78", Stereo::Off);
    let json: Value = serde_json::from_str(&plan.to_json().expect("a JSON form")).expect("JSON");
    for (field, operation) in [("load", "LOAD"), ("store", "STORE")] {
        let mut changed = json.clone();
        for step in changed["steps"].as_array_mut().expect("steps") {
            let attachments = step["work"]["render"]["attachments"].as_array_mut().into_iter().flatten();
            for depth in attachments.filter(|it| it["kind"] == "depth") {
                depth[field] = operation.into();
            }
        }
        let changed_plan = Plan::from_json(&changed.to_string()).expect("a Plan");
        assert_eq!(changed_plan.on_chip(), counted(&changed), "{field}");
        assert!(0 < changed_plan.on_chip() && changed_plan.on_chip() < plan.on_chip(), "{field}");
    }
}

#[test]
fn the_outline_says_it_for_each_step_and_for_the_frame() {
    let plan = plan("forward.ron", "mali-g78", Stereo::Off);
    let verbose = plan.outline(Detail { verbose: true, ..Detail::default() }).draw();
    // 640 × 360 texels of 4 samples: 8 bytes of colour, 4 of depth.
    let line = "keeps 10.5 MiB on the chip, neither loaded nor stored: `color` (7.0 MiB), `depth` (3.5 MiB)";
    assert_eq!(verbose.matches(line).count(), 2, "{verbose}");
    assert!(!plan.tree().contains("on the chip"), "{}", plan.tree());
}

/// Halves of one image and layers of one image are as many texels.
#[test]
fn both_eyes_count_in_halves_as_in_layers() {
    let of = |stereo| plan("forward.ron", "mali-g78", stereo);
    let [one, halves, layers] = [Stereo::Off, Stereo::DoubleWide, Stereo::Multiview].map(of);
    assert_eq!(halves.on_chip(), layers.on_chip());
    assert_eq!(halves.moved(), layers.moved());
    assert!(one.on_chip() > 0 && one.moved().sum() > 0);
}
