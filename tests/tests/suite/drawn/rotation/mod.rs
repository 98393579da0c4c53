//! Frames that are drawn rotated, read back upright: they show what the upright ones show. Each row of the requirements with the
//! tests that show it, and a change of one line that was seen to turn the first of them red.
//!
//! | row | tests | what turns it red |
//! |---|---|---|
//! | PR-1 | `graph/tests/suite/rotation.rs`, `pictures::every_shipped_pipeline_shows_the_same_rotated` | `compile/rotate/mod.rs`: extents not turned |
//! | PR-2 | `graph/tests/suite/random_frames.rs`, `pictures::what_is_resolved_into_the_screen_is_rotated_with_it` | `compile/rotate/turn_search.rs`: no depth in `beside` |
//! | PR-2 | `graph/tests/suite/rotation.rs` | `compile/rotate/turn_search.rs`: what is sampled is no hindrance |
//! | PR-3 | `recorded::viewports_and_scissors_are_those_of_the_upright_picture`, `pictures` | `objects.vert`: `rotate_clip` left out |
//! | PR-3 | `shaders::texels_are_fetched_exactly_where_they_are`, `pictures` | `full_screen.vert`: `rotate_clip` left out |
//! | PR-4 | `shaders::images_that_do_not_leave_the_frame_are_drawn_upright` | `prepare/pass.rs`: the rotation of any image |
//! | PR-5 | `recorded::viewports_and_scissors_are_those_of_the_upright_picture`, `cli/tests/suite/rotation.rs` | `recorder.rs`: `set_scissor` with x and y exchanged |
//! | PR-6 | `shaders::derivatives_and_places_of_the_helpers_are_upright` | `rotation.glsl`: another sign in `ddx` |
//! | PR-6 | `shaders::a_shader_that_breaks_is_reported_at_its_pass` | `shaders/rotation.rs`: no derivative is sideways |
//! | PR-6 | `shaders::no_shipped_shader_breaks` | `objects.vert`: `rotate_clip` left out |
//! | PR-7 | `graph/tests/suite/rotation.rs`, `shaders::the_screen_beside_another_target_is_refused_at_its_place` | `compile/rotate/turn_search.rs`: several targets only keep upright |
//! | PR-8 | `recorded::custom_passes_and_draws_are_told_rotation_and_size` | `recorder.rs`: `rotation` gives none |

mod pictures;
mod recorded;
mod shaders;

use framewright_graph::base::{self, Diagnostic, Sources};
use framewright_graph::compile::{Options, compile};
use framewright_graph::expand::{Inputs, expand};
use framewright_graph::frame::{Frame, Stereo};
use framewright_graph::language::{self, Facts};
use framewright_graph::plan::Plan;
use framewright_graph::verify::verify;
use framewright_graph::vulkan::Rotation;
use framewright_tests::render::{library, silent};
use framewright_vulkan::{Device, DrawSource, Executor, ExecutorOptions, Texels};
use std::error::Error;
use std::sync::Arc;

/// Wider than high, and odd.
const EXTENT: [u32; 2] = [97, 61];

/// The Plan of a pipeline whose outputs all leave the frame rotated.
///
/// # Errors
/// Its mistakes, as people read them.
fn planned(device: &Device, text: &str, rotation: Rotation) -> Result<Plan, String> {
    let mut sources = Sources::default();
    let read = language::read(&mut sources, "test.ron", "test.ron", text.to_owned());
    let sources = Arc::new(sources);
    let shown = |mistakes: Vec<Diagnostic>| base::render(&sources, &mistakes);
    let (set, facts) = (&[], Facts::UNKNOWN);
    let inputs = Inputs {
        set,
        facts,
        facts_known: false,
        output_extent: EXTENT,
        dump: &[],
        device: None,
        rotation: Rotation::Identity,
        stereo: Stereo::Off,
        window: None,
    };
    let mut frame: Frame = expand(&read.map_err(shown)?, sources.clone(), &inputs, &mut library()).map_err(shown)?;
    frame.outputs.iter_mut().for_each(|output| output.rotation = rotation);
    let plan = compile(&frame, &device.profile(), &mut device.memory(), &Options::default()).map_err(shown)?;
    let violations: Vec<String> = verify(&plan).iter().map(ToString::to_string).collect();
    if violations.is_empty() { Ok(plan) } else { Err(violations.join("\n")) }
}

/// The contents of its outputs, read back, and whether the layer was silent.
fn drawn(device: &Device, plan: &Plan, source: &mut dyn DrawSource) -> Result<Vec<Texels>, Box<dyn Error>> {
    let mut executor = Executor::new(device, plan, &mut library(), &ExecutorOptions::default())?;
    executor.frame(source)?;
    let outputs = (0..plan.outputs.len()).map(|output| executor.read(output)).collect::<Result<_, _>>()?;
    silent(device)?;
    Ok(outputs)
}

/// Texels of four floats.
fn floats(texels: &Texels) -> Vec<[f32; 4]> {
    let (words, _) = texels.bytes.as_chunks::<4>();
    let (texels, _) = words.as_chunks::<4>();
    texels.iter().map(|texel| texel.map(f32::from_ne_bytes)).collect()
}
