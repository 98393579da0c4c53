//! Modules of other compilers draw what the same effect in GLSL draws (DO-1, DO-3).

use framewright_graph::compile::Options;
use framewright_tests::render::{Setup, device, draw, silent};
use framewright_tests::shapes::empty_scene;
use std::error::Error;

#[test]
fn modules_of_other_compilers_draw_what_the_glsl_draws() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/spirv.ron", set: &[], scene: &scene, extent: [8, 8] };
    let (_, mut executor) = draw(device, &setup, &Options::default(), 1)?;
    let glsl = executor.read(0)?.bytes;
    assert!(glsl.iter().any(|byte| *byte != 0));
    let others = ["hlsl", "own_vertices", "nameless", "wgsl", "by_place", "lines", "dxc", "slang"];
    for (output, how) in others.iter().enumerate() {
        assert!(executor.read(output + 1)?.bytes == glsl, "{how}");
    }
    let numbers =
        |bytes: Vec<u8>| bytes.as_chunks().0.iter().map(|word| u32::from_ne_bytes(*word)).collect::<Vec<u32>>();
    // One entry point doubles the number of the invocation, another module adds one: a block of before SPIR-V 1.3.
    assert_eq!(numbers(executor.read_buffer("more")?), (0..64).map(|at| 2 * at + 1).collect::<Vec<_>>());
    // The size of its workgroups is by constants: one workgroup fills all.
    assert_eq!(numbers(executor.read_buffer("sizes")?), [16 * 100 + 4; 64]);
    silent(device)?;
    Ok(())
}
