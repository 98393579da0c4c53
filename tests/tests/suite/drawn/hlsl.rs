//! HLSL and Slang, compiled as they are drawn, draw what the same effect in GLSL draws (DO-2, DO-3).

use framewright_graph::base::Root;
use framewright_graph::compile::Options;
use framewright_graph::shader::FileLanguage;
use framewright_passes::draw::{SceneDrawSource, interfaces};
use framewright_passes::shipped::SHADERS;
use framewright_tests::render::{Setup, Ways, device, draw, in_repository, plan_for, silent};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::{Device, Executor, ExecutorOptions, ShaderCompilers, ShaderLibrary};
use std::error::Error;

/// The pipeline's pictures, and its numbers, with shaders that these compilers compile.
fn drawn(device: &Device, compilers: ShaderCompilers) -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    let scene = empty_scene();
    let setup = Setup { pipeline: "tests/pipelines/hlsl.ron", set: &[], scene: &scene, extent: [8, 8] };
    // The effect is the example's.
    let folders = ["tests/shaders", "examples"].map(|folder| Root::new(in_repository(folder)));
    let mut shaders = ShaderLibrary::new(folders.into(), SHADERS, interfaces()).with_compilers(compilers);
    let plan = plan_for(device, &setup, Ways::default(), &mut shaders, &Options::default())?;
    let mut draws = SceneDrawSource::for_plan(device, &scene, setup.extent, &plan)?;
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    executor.frame(&mut draws)?;
    let mut all = (0..4).map(|output| Ok(executor.read(output)?.bytes)).collect::<Result<Vec<_>, Box<dyn Error>>>()?;
    all.push(executor.read_buffer("counts")?);
    silent(device)?;
    Ok(all)
}

/// Whether pictures are alike: compilers may contract and reorder sums, so the last bits of numbers may differ.
fn alike(one: &[u8], other: &[u8]) -> bool {
    let numbers = |bytes: &[u8]| bytes.as_chunks().0.iter().map(|word| f32::from_ne_bytes(*word)).collect::<Vec<_>>();
    numbers(one).iter().zip(&numbers(other)).all(|(one, other)| (one - other).abs() <= 1e-6)
}

fn is_right(pictures: &[Vec<u8>], how: &str) {
    let [glsl, others @ .., counts] = pictures else { panic!("{how}: {} pictures", pictures.len()) };
    assert!(glsl.iter().any(|byte| *byte != 0));
    for (at, other) in others.iter().enumerate() {
        assert!(glsl.len() == other.len() && alike(glsl, other), "{how}: picture {at}");
    }
    let counts: Vec<u32> = counts.as_chunks().0.iter().map(|word| u32::from_ne_bytes(*word)).collect();
    assert_eq!(counts, (0..64).map(|at| 3 * at).collect::<Vec<_>>(), "{how}");
}

#[test]
fn hlsl_draws_what_the_glsl_draws() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    is_right(&drawn(device, ShaderCompilers::default())?, "shaderc");
    Ok(())
}

#[test]
fn other_compilers_of_hlsl_draw_the_same() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    for command in ["glslangValidator", "dxc", "slangc -O0"] {
        let program = command.split(' ').next().unwrap_or(command);
        if std::process::Command::new(program).arg("--version").output().is_err() {
            println!("skipped: `{program}` isn't there; tests/compilers/fetch.sh fetches compilers");
            continue;
        }
        let mut compilers = ShaderCompilers::default();
        compilers.set(FileLanguage::Hlsl, command)?;
        match drawn(device, compilers) {
            // DXC and slangc count vertices from the first of a draw.
            Err(error) if error.to_string().contains("the vertex stage needs the feature shaderDrawParameters") => {
                println!("skipped: {command}, whose vertex stage this device can't draw");
            }
            drawn => is_right(&drawn?, command),
        }
    }
    Ok(())
}

#[test]
fn constants_have_the_values_that_the_file_gives() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    for (factor, number) in [("3", 3), ("4", 4)] {
        let set = [("factor", factor)];
        let setup = Setup { pipeline: "tests/pipelines/constants.ron", set: &set, scene: &scene, extent: [8, 8] };
        let (_, mut executor) = draw(device, &setup, &Options::default(), 1)?;
        for buffer in ["glsl", "hlsl"] {
            let bytes = executor.read_buffer(buffer)?;
            let numbers: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_ne_bytes(*word)).collect();
            assert_eq!(numbers, [16 * number * 2 + 4 + 1; 64], "{buffer}");
        }
        // The size of workgroups is the constants': one workgroup fills all.
        let bytes = executor.read_buffer("sizes")?;
        let sizes: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_ne_bytes(*word)).collect();
        assert_eq!(sizes, [64 * 100 + 1; 64]);
    }
    silent(device)?;
    Ok(())
}
