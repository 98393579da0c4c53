//! Full-screen passes, compute passes and draws of a file's own vertices see camera, lights and objects (EM-5, DO-12): each eye its own, in every way to draw for two
//! eyes, and on a rotated screen.

use framewright_graph::compile::Options;
use framewright_graph::frame::{Eye, EyeForm, Stereo};
use framewright_graph::plan::{Plan, Resource, Work};
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw::{Eyes, SceneDrawSource};
use framewright_passes::scene::{Camera, Scene, load};
use framewright_tests::render::{Setup, Ways, device, floats, in_repository, library, plan_for, silent};
use framewright_vulkan::{Device, Executor, ExecutorOptions, Texels};
use glam::{DMat3, DVec2, DVec3, DVec4};
use std::error::Error;

/// Odd, so that no middle of a pixel lies on an axis.
const EXTENT: [u32; 2] = [97, 61];
const EYES_APART: f64 = 0.25;

/// What the outputs of `tests/pipelines/camera_everywhere.ron` hold.
struct Seen {
    plan: Plan,
    /// For each eye what the compute pass wrote, and what the full-screen pass, the vertices and the counted vertices drew.
    towards: [[Vec<[f64; 4]>; 4]; 2],
    /// For each eye.
    screen: [Vec<u8>; 2],
    /// Of each object.
    places: Vec<DVec4>,
}

fn scene() -> Result<Scene, Box<dyn Error>> {
    let mut scene = load(&in_repository("examples/scenes/spheres_and_cubes.ron"))?;
    scene.camera = Camera::look_at(DVec3::new(3.0, 2.0, 5.0), DVec3::new(-1.0, 0.5, 0.0), DVec3::Y, 0.9, 0.1)
        .ok_or("no direction")?;
    Ok(scene)
}

fn seen(device: &Device, scene: &Scene, ways: Ways) -> Result<Seen, Box<dyn Error>> {
    let objects = scene.objects.len().to_string();
    let set = [("objects", &*objects)];
    let setup = Setup { pipeline: "tests/pipelines/camera_everywhere.ron", set: &set, scene, extent: EXTENT };
    let mut shaders = library();
    let plan = plan_for(device, &setup, ways, &mut shaders, &Options::default())?;
    let mut draws = SceneDrawSource::for_eyes(device, scene, EXTENT, &plan, &Eyes::apart(EYES_APART))?;
    let mut executor = Executor::new(device, &plan, &mut shaders, &ExecutorOptions::default())?;
    // Camera and objects stand still: the second frame finds all as the first one.
    executor.frame(&mut draws)?;
    executor.frame(&mut draws)?;
    let mut pictures = Vec::new();
    for (at, output) in plan.outputs.iter().enumerate().filter(|(_, output)| output.eye != Some(Eye::Right)) {
        let Resource::Image(image) = output.resource else { continue };
        let left = executor.read(at)?;
        pictures.push(match (output.eye, plan.image(image).eyes) {
            (Some(_), _) => [left, executor.read(at + 1)?],
            (None, Some(form)) => parted(&left, form),
            (None, None) => [left.clone(), left],
        });
    }
    let [computed, drawn, own, counted, screen] = &pictures[..] else { return Err("no five pictures".into()) };
    let numbers = |texels: &Texels| floats(texels).as_chunks::<4>().0.to_vec();
    let towards = [0, 1].map(|eye| [computed, drawn, own, counted].map(|of| numbers(&of[eye])));
    let screen = [0, 1].map(|eye| screen[eye].bytes.clone());
    let words = executor.read_buffer("places")?;
    let words: Vec<f64> = words.as_chunks().0.iter().map(|word| f64::from(f32::from_ne_bytes(*word))).collect();
    let places = words.as_chunks::<4>().0.iter().map(|place| DVec4::from_array(*place)).collect();
    silent(device)?;
    Ok(Seen { plan, towards, screen, places })
}

/// Both eyes' parts of what holds them.
fn parted(texels: &Texels, form: EyeForm) -> [Texels; 2] {
    let run = match form {
        EyeForm::Layers => texels.bytes.len() / 2,
        EyeForm::Halves => texels.bytes.len() / (2 * texels.extent[1] as usize),
    };
    [0, 1].map(|eye| Texels {
        bytes: texels.bytes.chunks(run).skip(eye).step_by(2).flatten().copied().collect(),
        ..texels.clone()
    })
}

/// Where the middle of a pixel is seen by an eye that stands so far to the right of the camera.
fn expected(camera: &Camera, pixel: usize, right: f64) -> [f64; 4] {
    let [width, height] = EXTENT.map(f64::from);
    let uv = DVec2::new(
        (f64::from(pixel as u32 % EXTENT[0]) + 0.5) / width,
        (f64::from(pixel as u32 / EXTENT[0]) + 0.5) / height,
    );
    let half = (f64::from(camera.vertical_fov) * 0.5).tan();
    let turn = DMat3::from_mat4(camera.transform);
    let straight = DVec3::new((uv.x * 2.0 - 1.0) * half * width / height, (1.0 - uv.y * 2.0) * half, -1.0);
    let eye = turn * DVec3::new(right, 0.0, 0.0);
    let towards = (turn * straight).normalize();
    [towards.x, towards.y, towards.z, eye.dot(DVec3::new(1.0, 10.0, 100.0))]
}

fn all_ways(device: &Device) -> Vec<Ways> {
    let known = [Stereo::MultiPass, Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];
    let known = known.into_iter().filter(|stereo| stereo.lacks(&device.profile()).is_none());
    let modes = [Stereo::Off].into_iter().chain(known);
    modes.flat_map(|stereo| Rotation::ALL.map(|rotation| Ways { stereo, rotation })).collect()
}

#[test]
fn passes_of_all_kinds_see_the_camera_of_their_eye_in_every_way() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = scene()?;
    for ways in all_ways(device) {
        let seen = seen(device, &scene, ways)?;
        for (eye, side) in [-0.5, 0.5].into_iter().enumerate() {
            let right = if ways.stereo == Stereo::Off { 0.0 } else { side * EYES_APART };
            for (what, texels) in ["computed", "drawn", "by vertices", "by counts"].into_iter().zip(&seen.towards[eye])
            {
                assert_eq!(texels.len(), (EXTENT[0] * EXTENT[1]) as usize);
                for (pixel, found) in texels.iter().enumerate() {
                    let wanted = expected(&scene.camera, pixel, right);
                    let off =
                        found.iter().zip(wanted).map(|(found, wanted)| (found - wanted).abs()).fold(0.0, f64::max);
                    // Products of matrices in 32 bits, and for the eye numbers up to 14.
                    assert!(off < 1e-4, "{what}, eye {eye}, {ways:?}, pixel {pixel}: {found:?} instead of {wanted:?}");
                }
            }
        }
    }
    Ok(())
}

#[test]
fn a_fog_by_the_camera_is_the_same_on_a_rotated_screen_and_in_every_mode() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = scene()?;
    let alone = seen(device, &scene, Ways::default())?.screen;
    assert!(alone[0].iter().collect::<std::collections::HashSet<_>>().len() > 20, "no fog");
    for ways in all_ways(device) {
        let Seen { plan, screen, .. } = seen(device, &scene, ways)?;
        let turned = plan.images.iter().filter(|image| image.rotation == ways.rotation).count();
        assert!(turned > 0, "{ways:?}: nothing is turned");
        for (found, wanted) in screen.iter().zip(&alone) {
            // Both eyes look the same way.
            let most = found.iter().zip(wanted).map(|(found, wanted)| found.abs_diff(*wanted)).max();
            assert!(found.len() == wanted.len() && most <= Some(1), "{ways:?}: {most:?}");
        }
    }
    Ok(())
}

#[test]
fn a_compute_pass_that_runs_once_sees_the_camera_between_the_eyes() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let scene = scene()?;
    let [width, height] = EXTENT.map(f64::from);
    let world_to_clip = scene.camera.projection(width / height).as_dmat4() * scene.camera.transform.inverse();
    for stereo in [Stereo::Off, Stereo::MultiPass, Stereo::DoubleWide] {
        let seen = seen(device, &scene, Ways { stereo, rotation: Rotation::Identity })?;
        let culls =
            |it: &&framewright_graph::plan::Step| matches!(&it.work, Work::Dispatch(pass) if &*pass.name == "cull");
        assert_eq!(seen.plan.steps.iter().filter(culls).count(), 1, "{}", seen.plan.tree());
        assert_eq!(seen.places.len(), scene.objects.len());
        for (place, object) in seen.places.iter().zip(&scene.objects) {
            let wanted = world_to_clip * object.transform.w_axis;
            assert!(place.abs_diff_eq(wanted, 1e-4), "{stereo:?}: {place} instead of {wanted}");
        }
    }
    Ok(())
}
