//! SPIR-V of other compilers in a pipeline: what is wrong with it is said where the pipeline names it (DO-1, DO-3).

use crate::testing::{Outcome, Place};

const HLSL: &[u8] = include_bytes!("../../../tests/shaders/spirv/post_hlsl.spv");
const WGSL: &[u8] = include_bytes!("../../../tests/shaders/spirv/post_wgsl.spv");
const STRIPPED: &[u8] = include_bytes!("../../../tests/shaders/spirv/post_stripped.spv");
const TWICE: &[u8] = include_bytes!("../../../tests/shaders/spirv/sampled_twice.spv");

/// A pass with this shader, which samples so and has such parameters.
fn pipeline(shader: &str, sample: &str, params: &str) -> String {
    format!(
        "Pipeline(version: 1, images: [
    (name: \"light\", format: R16G16B16A16_SFLOAT, size: Output), (name: \"depth\", format: Depth, size: Output),
    (name: \"screen\", format: Output, size: Output)], passes: [
    (name: \"sky\", draw: Sky, color: [(image: \"light\", clear: (0, 0, 0, 1))], depth: (image: \"depth\", clear: 0)),
    (name: \"post\", draw: FullScreen({shader}), sample: {{{sample}}}, params: {{{params}}}, color: [\"screen\"]),
], outputs: [\"screen\"])"
    )
}

const NAMED: &str = "\"factor\": 1, \"tint\": (1, 1, 1)";

fn checked(shader: &str, bytes: &[u8], sample: &str, params: &str) -> Outcome {
    let place = Place::new();
    place.file("p.ron", pipeline(shader, sample, params));
    place.file("post.spv", bytes);
    place.run(&["check", "p.ron"])
}

#[test]
fn a_file_of_another_compiler_is_a_shader_by_its_name_and_entry_point() {
    let source = "\"source\": \"light\"";
    for shader in ["\"post.spv\"", "\"post.spv:PSMain\"", "fragment: \"post.spv\""] {
        checked(shader, HLSL, source, NAMED).exits(0);
    }
    let by_place = "\"offset 0\": 1, \"offset 4\": (1, 1, 1)";
    checked("\"post.spv\"", STRIPPED, "\"binding 0\": \"light\"", by_place).exits(0);
    checked("\"post.spv\"", HLSL, "\"binding 0\": \"light\"", by_place).exits(0);
}

#[test]
fn a_file_that_is_cut_off_is_said_where_it_is_named() {
    checked("\"post.spv\"", &HLSL[..HLSL.len() - 12], "", "")
        .exits(1)
        .mentions("error: shader `post.spv` is no SPIR-V that can be read: ./post.spv: it is cut off: instruction ")
        .mentions("[E0826]\n --> p.ron:5:");
    checked(
        "\"post.spv\"",
        b"\x03\x02\x23\x07\x00\x07\x01\x00\x00\x00\x00\x00\x08\x00\x00\x00\x00\x00\x00\x00",
        "",
        "",
    )
    .exits(1)
    .mentions("it is SPIR-V 1.7: versions 1.0 to 1.6 are taken, those of Vulkan 1.3 [E0826]");
}

#[test]
fn an_entry_point_that_is_not_there_or_not_the_only_one_is_said_with_those_that_are() {
    checked("\"post.spv:PSMainn\"", HLSL, "", "")
        .exits(1)
        .mentions("error: `post.spv` has no entry point `PSMainn` of a fragment stage [E0827]\n --> p.ron:5:")
        .mentions("help: did you mean `post.spv:PSMain`?");
    checked("\"post.spv\"", WGSL, "", "")
        .exits(1)
        .mentions("error: `post.spv` has 2 entry points of a fragment stage [E0827]")
        .mentions("help: say which: `post.spv:tinted`, `post.spv:first_texel`");
    checked("vertex: \"post.spv\", fragment: \"copy\"", WGSL, "\"source\": \"light\"", "")
        .exits(1)
        .mentions("error: `post.spv` has no entry point of a vertex stage [E0827]")
        .mentions("`count` of a compute stage");
}

#[test]
fn what_has_no_name_is_asked_for_by_its_place() {
    let outcome = checked("\"post.spv\"", STRIPPED, "\"source\": \"light\"", "\"factor\": 1").exits(1);
    outcome
        .mentions("error: shader `post.spv` samples no image named `source` [E0804]")
        .mentions("`binding 0`")
        .mentions("add `params: {\"offset 4\": (…, …, …)}`; its type is `vec3`");
}

#[test]
fn a_sampler_is_given_nothing_and_samples_its_images_alike() {
    checked("\"post.spv\"", HLSL, "\"source\": \"light\", \"linear_clamp\": \"light\"", NAMED)
        .exits(1)
        .mentions("help: `linear_clamp` is a sampler in the shader: leave it out; what is said of `source` counts");
    let compared = "\"shadow\": (image: \"depth\", compare: Less)";
    let sample = format!("\"light\": \"light\", \"noise\": (image: \"light\", address: Repeat), {compared}");
    checked("\"post.spv\"", TWICE, &sample, "")
        .exits(1)
        .mentions(
            "samples `light` and `noise` by one sampler, `same`, and pass `post` gives them in different ways [E0828]",
        )
        .mentions("filter: Linear, mip_filter: Nearest, address: Repeat");
    let alike = format!("\"light\": \"light\", \"noise\": \"light\", {compared}");
    checked("\"post.spv\"", TWICE, &alike, "").exits(0);
}

#[test]
fn names_that_are_none_of_a_file_are_refused() {
    checked("\"post.metal\"", HLSL, "", "").exits(1).mentions("`post.metal` can't be the name of a shader");
    checked("\"post.spv:\"", HLSL, "", "").exits(1).mentions("`` can't be the name of an entry point");
    checked("\"past.spv\"", HLSL, "", "")
        .exits(1)
        .mentions("error: there is no shader named `past.spv` [E0801]")
        .mentions("did you mean `post.spv`?");
    checked("\"../post.spv\"", HLSL, "", "").exits(1).mentions("leads out of");
}

#[test]
fn a_plan_names_the_module_and_a_folder_of_compiled_shaders_needs_none_of_it() {
    let place = Place::new();
    place.file("p.ron", pipeline("\"post.spv:PSMain\"", "\"source\": \"light\"", NAMED));
    place.file("post.spv", HLSL);
    let told = place.run(&["inspect", "p.ron"]).exits(0).out;
    assert!(told.contains("with shader `post.spv:PSMain`"), "{told}");
    place.run(&["check", "p.ron", "--precompiled", "ahead"]).exits(0);
    let entries = std::fs::read_dir(place.path("ahead")).expect("a folder");
    let names: Vec<_> =
        entries.map(|entry| entry.expect("listed").file_name().into_string().expect("a name")).collect();
    assert!(!names.iter().any(|name| name.starts_with("post")), "{names:?}");
}
