//! An upscaler that the embedding program brings finds what `library/upscaler.ron` promises it, and what it writes goes on.

mod program;

use crate::testing::{device, findings};
use framewright_graph::compile::Options;
use framewright_graph::frame::Jitter;
use framewright_graph::plan::Plan;
use framewright_passes::draw::{SceneDrawSource, interfaces};
use framewright_passes::scene::{Scene, load};
use framewright_passes::shipped::SHADERS;
use framewright_tests::render::{Setup, floats, in_repository, plan};
use framewright_vulkan::{Device, Executor, ExecutorOptions, ShaderLibrary};
use program::Upscaler;
use std::collections::HashMap;

const EXTENT: [u32; 2] = [96, 54];

/// A frame's `color`, `depth`, `motion` and `light`, in bits.
struct Frame {
    color: Vec<[u16; 4]>,
    depth: Vec<f64>,
    motion: Vec<[u16; 2]>,
    light: Vec<[u16; 4]>,
}

fn halves<const N: usize>(bytes: &[u8]) -> Vec<[u16; N]> {
    let words: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|word| u16::from_ne_bytes(*word)).collect();
    words.as_chunks::<N>().0.to_vec()
}

/// A half float as a number.
fn number(bits: u16) -> f64 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    let size = if exponent == 0 { fraction * 2_f64.powi(-24) } else { (1024.0 + fraction) * 2_f64.powi(exponent - 25) };
    if bits & 0x8000 == 0 { size } else { -size }
}

/// An executor and an upscaler, which draw frames of a Plan together.
struct Program {
    executor: Executor,
    upscaler: Upscaler,
}

impl Program {
    fn new(device: &Device, scene: &Scene, plan: &Plan, shaders: &mut ShaderLibrary) -> Program {
        let objects = SceneDrawSource::for_plan(device, scene, EXTENT, plan).expect("the scene fits");
        let executor = Executor::new(device, plan, shaders, &ExecutorOptions::default()).expect("an executor");
        Program { executor, upscaler: Upscaler::new(device, objects) }
    }
}

/// The first `count` frames, drawn with the program's upscaler, and by how much it was told that each is shifted.
fn frames(device: &Device, scene: &Scene, external: &str, count: u32) -> (Vec<Frame>, Vec<[f64; 2]>) {
    let set = [("external", external)];
    let setup = Setup { pipeline: "tests/pipelines/upscaler.ron", set: &set, scene, extent: EXTENT };
    let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
    let plan = plan(device, &setup, &mut shaders, &Options::default()).expect("a Plan");
    let Program { mut executor, mut upscaler } = Program::new(device, scene, &plan, &mut shaders);
    let mut frames = Vec::new();
    for _ in 0..count {
        executor.frame(&mut upscaler).expect("a frame");
        let [color, depth, motion, light] = [0, 1, 2, 3].map(|output| executor.read(output).expect("its texels"));
        frames.push(Frame {
            color: halves(&color.bytes),
            depth: floats(&depth),
            motion: halves(&motion.bytes),
            light: halves(&light.bytes),
        });
    }
    (frames, upscaler.told.clone())
}

fn scene() -> Scene {
    load(&in_repository("examples/scenes/passing.ron")).expect("it is shipped")
}

/// The texel of the half-size picture that lies under a pixel.
fn texel_under(pixel: usize) -> usize {
    let (width, x, y) = (EXTENT[0] as usize, pixel % EXTENT[0] as usize, pixel / EXTENT[0] as usize);
    y / 2 * (width / 2) + x / 2
}

#[test]
fn the_program_s_upscaler_is_given_colour_depth_motion_and_shift() {
    let Some(device) = device() else { return };
    let (frames, told) = frames(device, &scene(), "true", 6);
    let jitter = Jitter::halton(4, EXTENT.map(|side| side / 2));
    let expected: Vec<[f64; 2]> = (0..6).map(|frame| jitter.offset(frame)).collect();
    assert_eq!(told, expected, "in texels of what is rendered");
    for (number_of_frame, Frame { color, depth, motion, light }) in frames.iter().enumerate() {
        let mut moved = 0;
        for (pixel, [red, green, blue, alpha]) in light.iter().enumerate() {
            let under = texel_under(pixel);
            assert_eq!([*red, *green], color[under][..2], "frame {number_of_frame}, pixel {pixel}");
            let close = |found: f64, expected: f64| (found - expected).abs() <= 1e-3 * expected.abs().max(1e-3);
            assert!(close(number(*blue), depth[under]), "{} instead of {}", number(*blue), depth[under]);
            let shifted = number(motion[under][0]) + told[number_of_frame][0];
            assert!(close(number(*alpha), shifted), "{} instead of {shifted}", number(*alpha));
            moved += u32::from(motion[under] != [0, 0]);
        }
        assert_eq!(moved == 0, number_of_frame == 0, "{moved} pixels of frame {number_of_frame} moved");
    }
    assert_eq!(findings(&device.messages()), []);
}

#[test]
fn without_a_program_the_built_in_filter_takes_its_place() {
    let Some(device) = device() else { return };
    let (frames, told) = frames(device, &scene(), "false", 2);
    assert!(told.is_empty(), "nobody asks the program");
    let Frame { color, light, .. } = &frames[1];
    assert!((0..light.len()).all(|pixel| light[pixel] == color[texel_under(pixel)]), "each texel becomes four pixels");
    assert_eq!(findings(&device.messages()), []);
}

#[test]
fn the_program_s_upscaler_is_told_what_is_rendered_where_that_changes_from_frame_to_frame() {
    const SCALES: [&str; 6] = ["0.5", "1", "0.3", "0.3", "0.71", "0.5"];
    let Some(device) = device() else { return };
    let scene = scene();
    for external in ["true", "false"] {
        let mut shaders = ShaderLibrary::new(Vec::new(), SHADERS, interfaces());
        let mut planned = |pipeline, scale| {
            let set = [("external", external), ("scale", scale)];
            let setup = Setup { pipeline, set: &set, scene: &scene, extent: EXTENT };
            plan(device, &setup, &mut shaders, &Options::default()).expect("a Plan")
        };
        let dynamic: HashMap<&str, Plan> =
            SCALES.iter().map(|scale| (*scale, planned("tests/pipelines/dynamic_upscaler.ron", *scale))).collect();
        let fixed: HashMap<&str, Plan> =
            SCALES.iter().map(|scale| (*scale, planned("tests/pipelines/upscaler.ron", *scale))).collect();
        let mut one = Program::new(device, &scene, &dynamic["0.71"], &mut shaders);
        let (mut shown, mut told) = (Vec::new(), Vec::new());
        for scale in SCALES {
            one.executor.change(&dynamic[scale]).expect("other values");
            one.upscaler.objects.change(&dynamic[scale]).expect("the same views");
            one.executor.frame(&mut one.upscaler).expect("a frame");
            shown.push(one.executor.read(0).expect("its texels").bytes);
            told.push(one.upscaler.told.last().copied());
        }
        for (number, scale) in SCALES.into_iter().enumerate() {
            let mut alone = Program::new(device, &scene, &fixed[scale], &mut shaders);
            for _ in 0..=number {
                alone.executor.frame(&mut alone.upscaler).expect("a frame");
            }
            assert!(shown[number] == alone.executor.read(3).expect("its texels").bytes, "frame {number}, {scale}");
            assert_eq!(told[number], alone.upscaler.told.last().copied());
        }
    }
    assert_eq!(findings(&device.messages()), []);
}
