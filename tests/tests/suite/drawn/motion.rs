//! Motion is held against projections of the same points by the cameras and transforms of both frames, in 64 bits (NU-5).

use framewright_graph::compile::Options;
use framewright_graph::frame::Jitter;
use framewright_passes::scene::{AlphaMode, FRAME_SECONDS, Movement, Object, Scene, Texture};
use framewright_passes::twin::motion::{NOWHERE, direction_in_picture, motion, place_before, place_in_picture};
use framewright_tests::render::{Setup, device, draw, floats, ready, silent};
use framewright_tests::shapes::{material, scene, sphere, square};
use framewright_vulkan::{Device, ExecutorOptions};
use glam::{DMat4, DVec2, DVec3, DVec4, Mat4, Vec3};
use std::error::Error;

const EXTENT: [u32; 2] = [96, 56];

/// A pixel: its object, its depth, and by how much it moved.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pixel {
    object: Option<usize>,
    depth: f64,
    moved: DVec2,
}

/// The pixels of frame `number`.
fn frame(device: &Device, scene: &Scene, set: &[(&str, &str)], number: u32) -> Result<Vec<Pixel>, Box<dyn Error>> {
    let setup = Setup { pipeline: "tests/pipelines/motion.ron", set, scene, extent: EXTENT };
    let (_, mut executor) = draw(device, &setup, &Options::default(), number + 1)?;
    let objects = executor.read(0)?.bytes;
    let (depth, moved) = (floats(&executor.read(1)?), floats(&executor.read(2)?));
    silent(device)?;
    let pixel = |at: usize| Pixel {
        object: usize::from(objects[4 * at]).checked_sub(1),
        depth: depth[at],
        moved: DVec2::new(moved[2 * at], moved[2 * at + 1]),
    };
    Ok((0..depth.len()).map(pixel).collect())
}

/// A floor, a ball that flies, a square with a hole that turns before it, and a camera that does both. All of them are seen.
fn yard() -> Scene {
    let mut holed = material([0.2, 0.9, 0.3, 1.0]);
    holed.base_color_texture = Some(0);
    holed.alpha = AlphaMode::Mask { cutoff: 0.5 };
    let materials = vec![material([0.8, 0.8, 0.8, 1.0]), material([0.9, 0.2, 0.1, 1.0]), holed];
    let floor = Mat4::from_translation(Vec3::new(0.0, -1.0, 0.0))
        * Mat4::from_rotation_x(-std::f32::consts::FRAC_PI_2)
        * Mat4::from_scale(Vec3::splat(6.0));
    let ball = Mat4::from_translation(Vec3::new(-1.0, 0.3, 0.0)) * Mat4::from_scale(Vec3::splat(0.9));
    let before = Mat4::from_translation(Vec3::new(0.8, 0.2, 1.0));
    let mut scene = scene(vec![square(), sphere(24)], materials, vec![(0, 0, floor), (1, 1, ball), (0, 2, before)]);
    let hole = [[255, 255, 255, 255], [255, 255, 255, 0], [255, 255, 255, 255], [255, 255, 255, 255]];
    let (width, height, rgba8) = (2, 2, hole.concat().into());
    scene.textures.push(Texture { name: String::new(), width, height, rgba8, sampler: Default::default() });
    scene.objects[1].movement = Movement { velocity: DVec3::new(2.0, 1.0, -3.0), spin: DVec3::new(0.0, 3.0, 1.0) };
    scene.objects[2].movement = Movement { velocity: DVec3::ZERO, spin: DVec3::new(0.5, 0.0, 4.0) };
    scene.camera.movement = Movement { velocity: DVec3::new(1.0, 0.5, -2.0), spin: DVec3::new(0.1, 0.5, -0.3) };
    scene
}

/// Where in the picture a pixel's middle would be without shift, and the direction that is seen there.
fn seen(scene: &Scene, pixel: usize, shift: [f64; 2]) -> (DVec2, DVec3) {
    let [width, height] = EXTENT.map(f64::from);
    let middle = DVec2::new(pixel as f64 % width, (pixel as f64 / width).floor()) + 0.5;
    let place = middle / DVec2::new(width, height) - DVec2::from(shift);
    let up = (f64::from(scene.camera.vertical_fov) * 0.5).tan();
    let along = DVec3::new((2.0 * place.x - 1.0) * up * width / height, (1.0 - 2.0 * place.y) * up, -1.0);
    (place, scene.camera.transform.transform_vector3(along))
}

fn aspect() -> f64 {
    f64::from(EXTENT[0]) / f64::from(EXTENT[1])
}

#[test]
fn motion_leads_to_where_each_point_was_seen_in_the_frame_before() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let yard = yard();
    for (jitter, number) in [(1_u16, 1), (1, 7), (8, 1), (8, 12)] {
        let (now, before) = (yard.at(number.into()), yard.at(u64::from(number) - 1));
        let shift = if jitter > 1 { Jitter::halton(jitter, EXTENT).shift(number.into()) } else { [0.0; 2] };
        let found = frame(device, &yard, &[("jitter", &jitter.to_string())], number)?;
        let mut shown = [0; 4];
        for (at, pixel) in found.into_iter().enumerate() {
            let (place, along) = seen(&now, at, shift);
            let was = match pixel.object {
                Some(object) => {
                    let point = now.camera.position() + along * (f64::from(now.camera.near) / pixel.depth);
                    let [is, was] = [&now, &before].map(|scene| scene.objects[object].transform);
                    place_in_picture(&before.camera, aspect(), place_before(point, is, was))
                }
                None => direction_in_picture(&before.camera, aspect(), along),
            };
            let expected = motion(place, was);
            // A hundredth of a pixel: drivers move corners to the nearest 16th or 256th of one.
            let close = (pixel.moved - expected).abs().max_element() < 1e-4;
            assert!(close, "pixel {at} of frame {number}, jitter {jitter}: {pixel:?}, expected {expected}");
            shown[pixel.object.map_or(0, |object| object + 1)] += 1;
        }
        assert!(shown.iter().all(|count| *count > 100), "sky, floor, ball and square are seen: {shown:?}");
    }
    Ok(())
}

#[test]
fn a_shifted_picture_shows_the_same_surfaces_beside_where_they_were() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut still = yard();
    still.camera.movement = Movement::default();
    let camera = still.camera;
    for number in [0, 3, 9] {
        let shift = Jitter::halton(8, EXTENT).shift(number.into());
        let found = frame(device, &still, &[("jitter", "8")], number)?;
        let floor = found.iter().enumerate().filter(|(_, pixel)| pixel.object == Some(0));
        for (at, pixel) in floor {
            let (_, along) = seen(&still, at, shift);
            let height = camera.position().y + along.y * f64::from(camera.near) / pixel.depth;
            // Drivers move corners to the nearest 16th of a texel; a shift to the wrong side shows five times as much.
            assert!((height + 1.0).abs() < 5e-3, "pixel {at} of frame {number} shows the floor at {height} m");
        }
    }
    Ok(())
}

#[test]
fn nothing_moves_in_a_still_scene_nor_in_the_first_frame() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut still = yard();
    still.camera.movement = Movement::default();
    let at_rest = |object: Object| Object { movement: Movement::default(), ..object };
    still.objects = still.objects.into_iter().map(at_rest).collect();
    for (scene, number) in [(&still, 5), (&yard(), 0)] {
        for jitter in ["1", "8"] {
            let found = frame(device, scene, &[("jitter", jitter)], number)?;
            assert!(found.iter().all(|pixel| pixel.moved == DVec2::ZERO), "frame {number}, jitter {jitter}");
        }
    }
    Ok(())
}

#[test]
fn what_was_behind_the_camera_was_nowhere_in_the_picture() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let mut ahead = scene(vec![square()], vec![material([1.0; 4])], vec![(0, 0, Mat4::from_scale(Vec3::splat(50.0)))]);
    // It went back by 10 m, through the wall.
    ahead.camera.movement.velocity = DVec3::new(0.0, 0.0, 10.0 / FRAME_SECONDS);
    ahead.camera.transform = DMat4::from_translation(DVec3::new(0.0, 0.0, -5.0));
    let found = frame(device, &ahead, &[], 1)?;
    assert!(
        found.iter().all(|pixel| pixel.object == Some(0) && pixel.moved == DVec2::splat(NOWHERE)),
        "{:?}",
        found[0]
    );
    Ok(())
}

#[test]
fn depth_that_is_drawn_again_is_shifted_like_the_first() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let yard = yard();
    for number in [2, 5] {
        let depths = |msaa: &str| -> Result<Vec<f64>, Box<dyn Error>> {
            let found = frame(device, &yard, &[("jitter", "8"), ("msaa", msaa)], number)?;
            Ok(found.into_iter().map(|pixel| pixel.depth).collect())
        };
        assert!(depths("1")? == depths("4")?, "frame {number}");
    }
    Ok(())
}

#[test]
fn frames_on_their_way_are_drawn_from_what_was_then() -> Result<(), Box<dyn Error>> {
    let Some(device) = device() else { return Ok(()) };
    let yard = yard();
    let set = [("jitter", "5")];
    let setup = Setup { pipeline: "tests/pipelines/motion.ron", set: &set, scene: &yard, extent: EXTENT };
    let how = |frames_in_flight| ExecutorOptions { frames_in_flight, readback: true, ..ExecutorOptions::default() };
    let all = |in_flight: u32| -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
        let (_, mut executor, mut source) = ready(device, &setup, &Options::default(), &how(in_flight))?;
        let mut kept = Vec::new();
        // As many are submitted as may be before the first is waited for.
        for _ in 0..2 {
            let frames: Vec<u64> = (0..in_flight).map(|_| executor.submit(&mut source)).collect::<Result<_, _>>()?;
            for frame in frames {
                executor.wait(frame)?;
                kept.push(executor.read_back_image(frame, 2)?.bytes);
            }
        }
        Ok(kept)
    };
    let (together, alone) = (all(3)?, all(1)?);
    assert_eq!(together.len(), 6);
    assert!(together[..2] == alone[..2], "the first two frames are the same");
    assert!(together[0] != together[1] && together[1] != together[2], "and no two alike");
    silent(device)?;
    Ok(())
}

#[test]
fn transforms_of_the_twin_are_those_of_projection() {
    let camera = yard().at(3).camera;
    let world_to_clip = camera.projection(aspect()).as_dmat4() * camera.transform.inverse();
    for place in [DVec3::ZERO, DVec3::new(1.0, -0.5, 0.3), DVec3::new(-2.0, 1.0, -40.0)] {
        let clip = world_to_clip * place.extend(1.0);
        let expected = 0.5 * clip.truncate().truncate() / clip.w + 0.5;
        let found = place_in_picture(&camera, aspect(), place).expect("it is before the camera");
        assert!((found - expected).abs().max_element() < 1e-6, "{found} instead of {expected}");
    }
    let behind = camera.transform * DVec4::new(0.0, 0.0, 1.0, 1.0);
    assert_eq!(place_in_picture(&camera, aspect(), behind.truncate()), None);
    let turn = DMat4::from_rotation_y(0.3);
    let there = place_before(DVec3::X, DMat4::IDENTITY, turn);
    assert!((there - turn.transform_point3(DVec3::X)).length() < 1e-15);
}
