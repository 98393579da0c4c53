//! Shaders in HLSL, compiled by each compiler that is there, draw for both eyes what the same passes in GLSL draw (DO-2).

use super::{Case, EVEN, EXTENT, at_once, floats, read, upright};
use framewright_graph::compile::Options;
use framewright_graph::frame::Stereo;
use framewright_graph::shader::FileLanguage;
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw::{Eyes, SceneDrawSource};
use framewright_passes::scene::load;
use framewright_tests::render::{Setup, Ways, device, in_repository, library, plan_for, silent};
use framewright_tests::shapes::empty_scene;
use framewright_vulkan::{Device, Executor, ExecutorOptions, ShaderCompilers};
use std::collections::HashSet;
use std::error::Error;

/// By output, both eyes' pictures.
type Pictures = Vec<[Vec<[f32; 4]>; 2]>;

fn drawn(device: &Device, case: &Case<'_>, ways: Ways, command: &str) -> Result<Pictures, Box<dyn Error>> {
    let mut compilers = ShaderCompilers::default();
    if !command.is_empty() {
        compilers.set(FileLanguage::Hlsl, command)?;
    }
    let mut shaders = library().with_compilers(compilers);
    let Case { pipeline, set, scene, extent, .. } = *case;
    let plan = plan_for(device, &Setup { pipeline, set, scene, extent }, ways, &mut shaders, &Options::default())?;
    let mut draws = SceneDrawSource::for_eyes(device, scene, extent, &plan, &Eyes::default())?;
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    executor.frame(&mut draws)?;
    let pictures = read(&plan, &mut executor)?;
    silent(device)?;
    Ok(pictures.iter().map(|pair| [0, 1].map(|eye| floats(&pair[eye]))).collect())
}

/// How many pixels differ by more than the last bits of their numbers.
fn differing(one: &[[f32; 4]], other: &[[f32; 4]]) -> usize {
    let differ = |(one, other): (&f32, &f32)| (one - other).abs() > 1e-5 * one.abs().max(1.0);
    one.iter().zip(other).filter(|(one, other)| one.iter().zip(*other).any(differ)).count()
}

/// Compares the pictures of HLSL with those of GLSL, and both with what is known of them.
fn are_right(pictures: &Pictures, [width, height]: [u32; 2], sees: bool, how: &str) {
    let [told, places, undivided, told_too, places_too, undivided_too, viewed, sampled, sampled_too, seen, seen_too] =
        &pictures[..]
    else {
        panic!("{how}: {} pictures", pictures.len());
    };
    for eye in [0, 1] {
        let same = |one: &[Vec<[f32; 4]>; 2], other: &[Vec<[f32; 4]>; 2], what: &str| {
            assert_eq!(one[eye].len(), (width * height) as usize);
            assert_eq!(differing(&one[eye], &other[eye]), 0, "{how}: {what}, eye {eye}");
        };
        for (at, found) in told_too[eye].iter().enumerate() {
            let [column, row] = [at as u32 % width, at as u32 / width];
            let instance = u32::from(2 * column >= width) + 2 * u32::from(2 * row >= height);
            // Of an odd side the middle lies in two instances.
            let tied = 2 * column + 1 == width || 2 * row + 1 == height;
            assert!(tied || *found == [eye as f32, instance as f32, eye as f32, 0.25], "{how}, {at}: {found:?}");
        }
        same(told, told_too, "what stages are told");
        same(places, places_too, "places");
        same(undivided, undivided_too, "places before a division");
        same(sampled, sampled_too, "what is sampled");
        same(seen, seen_too, "objects");
        same(told, viewed, "the index of a view");
    }
    assert!(differing(&sampled_too[0], &sampled_too[1]) > 100, "{how}: both eyes see the same of what is sampled");
    if !sees {
        return;
    }
    assert!(differing(&seen_too[0], &seen_too[1]) > 100, "{how}: both eyes see the same objects");
    let objects: HashSet<u32> = seen_too[0].iter().map(|pixel| pixel[3] as u32).collect();
    assert!(objects.len() > 3, "{how}: {objects:?}");
}

/// Commands that compile HLSL, and shaderc.
const COMMANDS: [&str; 4] = ["", "glslangValidator", "dxc", "slangc -O0"];

/// slangc counts vertices and instances from the first of a draw.
const UNCOUNTED: &str = "the vertex stage needs the feature shaderDrawParameters";

fn is_there(command: &str) -> bool {
    let program = command.split(' ').next().unwrap_or(command);
    let there = command.is_empty() || std::process::Command::new(program).arg("--version").output().is_ok();
    if !there {
        println!("skipped: `{program}` isn't there; tests/compilers/fetch.sh fetches compilers");
    }
    there
}

/// DO-2, ST-14: stripes that reach beyond each eye's picture are cut at its edge, and lie where those of GLSL lie, however it is turned.
#[test]
fn shaders_in_hlsl_draw_turned_pictures_of_both_eyes() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = empty_scene();
    let shown = |pipeline, ways, command: &str| -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
        let mut compilers = ShaderCompilers::default();
        if !command.is_empty() {
            compilers.set(FileLanguage::Hlsl, command)?;
        }
        let mut shaders = library().with_compilers(compilers);
        let setup = Setup { pipeline, set: &[], scene: &scene, extent: EVEN };
        let plan = plan_for(device, &setup, ways, &mut shaders, &Options::default())?;
        let mut draws = SceneDrawSource::for_eyes(device, &scene, EVEN, &plan, &Eyes::default())?;
        let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
        executor.frame(&mut draws)?;
        let pictures = (0..plan.outputs.len()).map(|output| Ok(executor.read(output)?.bytes));
        let pictures = pictures.collect::<Result<Vec<_>, Box<dyn Error>>>()?;
        silent(device)?;
        Ok(pictures)
    };
    for stereo in [vec![Stereo::MultiPass], at_once(device)].concat() {
        for rotation in [Rotation::Identity, Rotation::Rotate90, Rotation::Rotate180, Rotation::Rotate270] {
            let ways = Ways { stereo, rotation };
            let expected = shown("tests/pipelines/eyes_turned_glsl.ron", ways, "")?;
            assert!(expected.iter().flatten().any(|byte| *byte != 0));
            for command in COMMANDS.into_iter().filter(|command| is_there(command)) {
                let how = format!("{command} {} {rotation:?}", stereo.name());
                match shown("tests/pipelines/eyes_turned.ron", ways, command) {
                    Err(error) if error.to_string().contains(UNCOUNTED) => println!("skipped: {how}"),
                    Err(error) => return Err(format!("{how}: {error}").into()),
                    Ok(found) => assert!(found == expected, "{how}"),
                }
            }
        }
    }
    Ok(())
}

/// DO-2, ST-5: what is drawn for each eye by itself, and for both at once in each way, by each compiler.
#[test]
fn shaders_in_hlsl_draw_for_both_eyes_what_glsl_draws() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    let pipeline = "tests/pipelines/eyes_in_languages.ron";
    for command in COMMANDS.into_iter().filter(|command| is_there(command)) {
        // slangc gives an array in a block another form than the draw source's block has.
        let sees = !command.starts_with("slangc");
        let set: &[(&str, &str)] = if sees { &[] } else { &[("objects", "false")] };
        // Commands take long.
        let extents: &[[u32; 2]] = if command.is_empty() { &[EVEN, EXTENT] } else { &[EVEN] };
        for extent in extents.iter().copied() {
            let case = Case { pipeline, set, scene: &scene, extent, frames: 1 };
            for stereo in [vec![Stereo::MultiPass], at_once(device)].concat() {
                let how = format!("{command} {} {extent:?}", stereo.name());
                match drawn(device, &case, upright(stereo), command) {
                    Err(error) if error.to_string().contains(UNCOUNTED) => {
                        println!("skipped: {command}, whose vertex stage this device can't draw");
                    }
                    Err(error) => return Err(format!("{how}: {error}").into()),
                    Ok(pictures) => are_right(&pictures, extent, sees, &how),
                }
            }
        }
    }
    Ok(())
}
