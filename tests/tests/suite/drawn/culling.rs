//! Objects that no pass shows are left out: the pictures stay as they are, bit by bit.

use framewright_graph::compile::Options;
use framewright_passes::draw::SceneDrawSource;
use framewright_passes::scene::{Camera, Scene, load};
use framewright_tests::render::{Setup, device, in_repository, library, plan, silent};
use framewright_tests::shapes::{material, scene, square};
use framewright_vulkan::{Executor, ExecutorOptions, FrameReport};
use glam::{DVec3, Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [96, 64];

/// The outputs, and how many objects were drawn and left out.
struct Drawn {
    outputs: Vec<Vec<u8>>,
    draws: u32,
    culled: u32,
}

fn drawn(pipeline: &str, scene: &Scene, culling: bool) -> Result<Option<Drawn>, Box<dyn Error>> {
    let Some(device) = device() else { return Ok(None) };
    let mut shaders = library();
    let setup = Setup { pipeline, set: &[], scene, extent: EXTENT };
    let plan = plan(device, &setup, &mut shaders, &Options::default())?;
    let mut source = SceneDrawSource::for_plan(device, scene, EXTENT, &plan)?;
    source.set_culling(culling);
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    let frame = executor.frame(&mut source)?;
    let report = executor.report(frame)?;
    let outputs =
        (0..plan.outputs.len()).map(|at| Ok(executor.read(at)?.bytes)).collect::<Result<_, Box<dyn Error>>>()?;
    silent(device)?;
    let sum = |of: fn(&framewright_vulkan::PassReport) -> u32| {
        let FrameReport { steps, .. } = &report;
        steps.iter().flat_map(|step| &step.passes).map(of).sum()
    };
    Ok(Some(Drawn { outputs, draws: sum(|pass| pass.draws), culled: sum(|pass| pass.culled) }))
}

#[test]
fn pictures_are_the_same_bit_by_bit_with_fewer_objects() -> Result<(), Box<dyn Error>> {
    for (file, pipeline) in
        [("spheres_and_cubes", "forward"), ("courtyard", "shadows"), ("spheres_and_cubes", "deferred")]
    {
        let mut scene = load(&in_repository(&format!("examples/scenes/{file}.ron")))?;
        let pipeline = format!("examples/pipelines/{pipeline}.ron");
        let from = |at: [f64; 3], to: [f64; 3], fov| Camera::look_at(at.into(), to.into(), DVec3::Y, fov, 0.05);
        let cameras = [
            from([0.5, 1.0, 0.4], [3.0, 0.8, 0.0], 1.0),
            from([0.5, 1.0, 0.4], [-3.0, 0.2, 1.0], 2.2),
            from([2.0, 6.0, 0.0], [0.0, 0.0, 0.1], 0.3),
        ];
        for camera in cameras {
            scene.camera = camera.ok_or("a direction")?;
            let (Some(culled), Some(all)) = (drawn(&pipeline, &scene, true)?, drawn(&pipeline, &scene, false)?) else {
                return Ok(());
            };
            assert!(culled.outputs == all.outputs, "{pipeline} shows another picture from {:?}", scene.camera);
            assert!(culled.culled > 0, "{pipeline}: nothing is left out from {:?}", scene.camera);
            assert_eq!((culled.draws + culled.culled, all.culled), (all.draws, 0));
        }
    }
    Ok(())
}

#[test]
fn nothing_is_left_out_where_the_pass_has_a_vertex_shader_of_its_own() -> Result<(), Box<dyn Error>> {
    let behind = Mat4::from_translation(Vec3::Z * 50.0);
    let scene = scene(vec![square()], vec![material([1.0; 4])], vec![(0, 0, behind)]);
    let Some(own) = drawn("tests/pipelines/brought_here.ron", &scene, true)? else { return Ok(()) };
    assert_eq!((own.draws, own.culled), (1, 0));
    assert!(own.outputs[0].contains(&255), "the object doesn't show");
    let Some(usual) = drawn("tests/pipelines/lit.ron", &scene, true)? else { return Ok(()) };
    assert_eq!((usual.draws, usual.culled), (0, 1));
    Ok(())
}
