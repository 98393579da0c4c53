//! Pictures of two eyes, drawn one after the other and at once. Each row of the requirements with the tests that show it, and a
//! change of one line that was seen to turn the first of them red.
//!
//! | row | tests | what turns it red |
//! |---|---|---|
//! | ST-1 | `cameras::each_eye_sees_what_a_camera_in_its_place_sees` | `draw/eyes.rs`: the other eye's place |
//! | ST-1 | `graph/tests/suite/language/eyes.rs` | `expand/eyes/split.rs`: `of` gives the left eye's image |
//! | ST-1 | `cameras::point_lights_reach_what_an_eye_sees_behind_the_camera_between_both` | `point_lights.glsl`: tiles as ahead |
//! | ST-2 | `packed::one_image_for_both_is_twice_as_wide_or_has_two_layers` | `plan/part.rs`: `made` a texel wider |
//! | ST-2 | `packed::a_pass_draws_for_both_eyes_what_two_draw_for_each` | `eyes/at_once.rs`: `at_once` is false |
//! | ST-2 | `packed::what_is_handed_in_for_both_eyes_is_just_as_large_as_both` | `execute/exchange.rs`: any number of bytes |
//! | ST-3 | `packed::shared_culling_shows_the_same` | `draw/view_draws.rs`: both see what the left eye sees |
//! | ST-3 | `packed::shared_culling_shows_the_same` | `draw/source.rs`: `culls_once` is ignored |
//! | ST-3 | `passes/tests/suite/eyes.rs`, rays at random | `draw/eyes.rs`: no step back |
//! | ST-3 | `cameras::what_both_eyes_share_is_drawn_once` | `expand/eyes/split.rs`: `PassEyes::Both` runs for each |
//! | ST-3 | `cameras::shadow_maps_of_each_eyes_own_give_what_shared_ones_give` | `draw/cascades.rs`: no maps of eyes' views |
//! | ST-4 | `eyes::each_stage_is_told_the_eye_and_a_quad_shows_what_a_triangle_shows` | `shaders/eyes.rs`: `gl_Layer = 0` |
//! | ST-4 | `agreement::texels_are_fetched_exactly` | `shaders/layers.rs`: the left eye's layer |
//! | ST-4 | `eyes::what_is_done_for_one_eye_after_the_other_shows_the_same_in_each_mode` | `eyes/at_once.rs`: mips are no hindrance |
//! | ST-5 | `eyes::each_stage_is_told_the_eye_and_a_quad_shows_what_a_triangle_shows` | `shaders/eyes.rs`: fragments' eyes exchanged |
//! | ST-5 | `eyes::helpers_place_an_eyes_picture_in_what_is_drawn_into` | `stereo.glsl`: `scale_offset` without offset |
//! | ST-6 | `eyes::helpers_place_an_eyes_picture_in_what_is_drawn_into` | `part.glsl`: `uv_adjust` of a vec4 without offset |
//! | ST-7 | `agreement::nothing_bleeds_from_one_eye_into_the_other` | `part.glsl`: `uv_clamp` to the seam; no `min` |
//! | ST-7 | `agreement::places_are_clamped_within_the_half_of_each_mip_level` | `part.glsl`: 1/64 of a texel less |
//! | ST-8 | `eyes::grain_and_overlays_are_the_same_in_both_eyes` | `film_grain.frag`: the texel of both eyes' image |
//! | ST-9 | `agreement::nothing_bleeds_from_one_eye_into_the_other` | `blur.frag`: without `uv_clamp` |
//! | ST-9 | `agreement::texels_are_fetched_exactly` | `shaders/macros.rs`: `half` doesn't know the eye that is named |
//! | ST-9 | `eyes::what_is_done_for_one_eye_after_the_other_shows_the_same_in_each_mode` | `eyes/at_once.rs`: one eye's target in both |
//! | ST-9 | `eyes::a_shader_that_does_not_ask_for_its_half_is_reported_at_its_pass` | `expand/shader/stereo.rs`: `check_halves` returns |
//! | ST-10 | `agreement::texels_are_fetched_exactly` | `shaders/macros.rs`: `half` is the left one |
//! | ST-11 | `eyes::each_stage_is_told_the_eye_and_a_quad_shows_what_a_triangle_shows` | `shaders/eyes.rs`: 0.49 of the width |
//! | ST-12 | `eyes::what_is_done_for_one_eye_after_the_other_shows_the_same_in_each_mode` | `prepare/variant.rs`: no `eyes` in a variant |
//! | ST-13 | `eyes::grain_and_overlays_are_the_same_in_both_eyes` | `stereo.glsl`: `non_stereo_screen_pos` of half the width |
//! | ST-14 | `agreement` | `shaders/eyes.rs`: nothing cut at the seam |
//! | ST-14 | `depth` | `adapt/resolve.rs`: layers are resolved as one layer is, on SwiftShader |
//! | ST-14 | `rotated::derivatives_and_places_are_those_of_the_upright_picture_of_each_eye` | `rotation.glsl`: `towards` not rotated |
//! | ST-14 | `rotated::at_every_scale_and_number_of_samples_each_eye_sees_the_same_turned` | `plan/part.rs`: twice the width when turned |
//! | ST-15 | `packed::recording_both_eyes_at_once_takes_a_share_of_the_draw_calls_and_allocations`; times: `passes/benches/eyes.rs` | `eyes/at_once.rs`: `at_once` is false |
//! | ST-16 | `eyes::grain_and_overlays_are_the_same_in_both_eyes`, `agreement` | `scene.glsl`: `view` is the left eye's |
//! | DO-2 | `languages::shaders_in_hlsl_draw_for_both_eyes_what_glsl_draws` | `shaders/eyes_of_modules.rs`: layers by a capability of 1.0 |
//! | NU-4 | `cameras::eyes_far_from_the_origin_see_what_they_see_near_it` | `draw/eyes.rs`: an eye's place in 32 bits |
//! | NU-4 | `cameras::a_far_plane_changes_nothing_of_what_each_eye_sees_before_it` | `sky.vert`: the eye's place left out |
//! | NU-4 | `cameras::eyes_at_one_place_and_a_kilometre_apart_see_what_a_camera_there_sees` | `draw/eyes.rs`: `offset` times 0.999 |

mod agreement;
mod cameras;
mod depth;
mod eyes;
mod languages;
mod packed;
mod rotated;

use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Eye, EyeForm, Stereo};
use framewright_graph::plan::{Pass, Plan, Resource, Work};
use framewright_graph::vulkan::Rotation;
use framewright_passes::draw::{Eyes, SceneDrawSource};
use framewright_passes::scene::Scene;
use framewright_tests::render::{Setup, Ways, library, plan_for, silent};
use framewright_vulkan::{Device, Executor, ExecutorOptions, FrameReport, Texels};
use std::error::Error;

/// Odd, so that a half of it would be no whole number.
const EXTENT: [u32; 2] = [97, 61];
const EVEN: [u32; 2] = [96, 60];

/// A pipeline with its settings, scene and size, and how many frames are drawn.
#[derive(Clone, Copy)]
struct Case<'a> {
    pipeline: &'a str,
    set: &'a [(&'a str, &'a str)],
    scene: &'a Scene,
    extent: [u32; 2],
    frames: u32,
}

/// The picture of the left eye, and of the right one.
type Pair = [Vec<u8>; 2];

/// The Plan, report and pictures of a case that was drawn.
struct Drawn {
    plan: Plan,
    /// The report of the last frame.
    report: FrameReport,
    /// By frame and output; twice the same where both eyes share it.
    frames: Vec<Vec<Pair>>,
}

/// A pipeline file that is shipped.
fn shipped(name: &str) -> String {
    format!("examples/pipelines/{name}.ron")
}

/// Those ways to draw for both eyes at once that the device knows.
fn at_once(device: &Device) -> Vec<Stereo> {
    let all = [Stereo::DoubleWide, Stereo::Instanced, Stereo::Multiview];
    all.into_iter().filter(|stereo| stereo.lacks(&device.profile()).is_none()).collect()
}

/// One eye after the other, or both at once, upright.
fn upright(stereo: Stereo) -> Ways {
    Ways { stereo, rotation: Rotation::Identity }
}

fn drawn(device: &Device, case: &Case<'_>, ways: Ways, eyes: &Eyes) -> Result<Drawn, Box<dyn Error>> {
    let mut shaders = library();
    let Case { pipeline, set, scene, extent, frames } = *case;
    let plan = plan_for(device, &Setup { pipeline, set, scene, extent }, ways, &mut shaders, &Options::default())?;
    let mut draws = SceneDrawSource::for_eyes(device, scene, extent, &plan, eyes)?;
    let options = ExecutorOptions { timestamps: true, ..ExecutorOptions::default() };
    let mut executor = Executor::new(device, &plan, &mut shaders, &options)?;
    let mut shown = Vec::new();
    let mut report = None;
    for _ in 0..frames {
        let frame = executor.frame(&mut draws)?;
        report = Some(executor.report(frame)?);
        shown.push(read(&plan, &mut executor)?);
    }
    silent(device)?;
    Ok(Drawn { plan, report: report.ok_or("no frame")?, frames: shown })
}

/// All outputs, each as both eyes see it.
fn read(plan: &Plan, executor: &mut Executor) -> Result<Vec<Pair>, Box<dyn Error>> {
    let mut pictures = Vec::new();
    for (at, output) in plan.outputs.iter().enumerate().filter(|(_, output)| output.eye != Some(Eye::Right)) {
        let texels = executor.read(at)?;
        let Resource::Image(image) = output.resource else { return Err("an output that is no image".into()) };
        pictures.push(match (output.eye, plan.image(image).eyes) {
            (Some(_), _) => [texels.bytes, executor.read(at + 1)?.bytes],
            (None, None) => [texels.bytes.clone(), texels.bytes],
            (None, Some(form)) => parted(&texels, form),
        });
    }
    Ok(pictures)
}

/// Both eyes' parts of what holds them.
fn parted(texels: &Texels, form: EyeForm) -> Pair {
    let run = match form {
        EyeForm::Layers => texels.bytes.len() / 2,
        EyeForm::Halves => texels.bytes.len() / (2 * texels.extent[1] as usize),
    };
    [0, 1].map(|eye| texels.bytes.chunks(run).skip(eye).step_by(2).flatten().copied().collect())
}

/// How many pixels of four bytes differ by more than one step in any channel.
fn apart(one: &[u8], other: &[u8]) -> usize {
    assert_eq!(one.len(), other.len());
    let pixels = one.as_chunks::<4>().0.iter().zip(other.as_chunks::<4>().0);
    pixels.filter(|(one, other)| one.iter().zip(*other).any(|(one, other)| one.abs_diff(*other) > 1)).count()
}

/// How many pixels differ so; and how many by more than three steps where the second picture has no edge.
fn apart_within(found: &[u8], expected: &[u8], [width, height]: [u32; 2]) -> [usize; 2] {
    let [width, height] = [width, height].map(|side| side as usize);
    assert_eq!([found.len(), expected.len()], [4 * width * height; 2]);
    let step = |one: usize, of: &[u8]| {
        let pixels = expected[4 * one..4 * one + 4].iter().zip(of);
        pixels.map(|(one, other)| one.abs_diff(*other)).max().unwrap_or(0)
    };
    let is_edge = |at: usize| {
        let around = |at: usize, of: usize| at.saturating_sub(2)..(at + 3).min(of);
        let mut near = around(at / width, height).flat_map(|y| around(at % width, width).map(move |x| y * width + x));
        near.any(|near| step(at, &expected[4 * near..4 * near + 4]) > 8)
    };
    let steps: Vec<u8> = found.chunks(4).enumerate().map(|(at, pixel)| step(at, pixel)).collect();
    let within = steps.iter().enumerate().filter(|(at, step)| **step > 3 && !is_edge(*at)).count();
    [steps.iter().filter(|step| **step > 1).count(), within]
}

/// Texels of four floats.
fn floats(picture: &[u8]) -> Vec<[f32; 4]> {
    picture.as_chunks::<4>().0.as_chunks::<4>().0.iter().map(|texel| texel.map(f32::from_ne_bytes)).collect()
}

/// How images hold both eyes' parts, if any do.
fn form(plan: &Plan) -> Option<EyeForm> {
    plan.images.iter().find_map(|image| image.eyes)
}

/// All that is drawn within rendering scopes.
fn rendered(plan: &Plan) -> impl Iterator<Item = &Pass> {
    let scopes = plan.steps.iter().filter_map(|step| match &step.work {
        Work::Render(scope) => Some(&scope.passes),
        _ => None,
    });
    scopes.flatten()
}

/// How many passes draw what casts shadows.
fn casters(plan: &Plan) -> usize {
    rendered(plan).filter(|pass| matches!(pass.draw, Some(Draw::Casters(_)))).count()
}
