//! The picture that choices are held against: the same pipeline under its preset `reference`, drawn many times, each time shifted by
//! another part of a texel, and averaged: before tone mapping what is tone-mapped, all else as it is shown.

use super::converging_frame::ConvergingFrame;
use super::program::Program;
use crate::error::Error;
use crate::outputs;
use crate::picture::Light;
use framewright::{Pipeline, PlannedFrame, SceneRenderer};
use framewright_graph::frame::{Draw, Jitter, LONGEST_JITTER};
use framewright_graph::plan::Plan;
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, ExecutorOptions};

/// A reference has at least this many samples for each pixel of the output.
const LEAST_SAMPLES: u32 = 64;
/// A reference is drawn at least this often, so that half of it is one too.
const LEAST_FRAMES: u16 = 16;

/// A reference, and one of half as many frames.
#[derive(Debug)]
pub(super) struct ReferencePair {
    pub(super) picture: Light,
    /// One of half as many samples: its distance from the whole is an estimate of the error that the whole has itself.
    pub(super) of_half: Light,
    /// Steps from black to white in the tested output's picture; `None`: it holds light without an upper end.
    pub(super) steps: Option<u16>,
}

/// Draws a reference, and tells `progress` how many frames are drawn, and of how many.
///
/// # Errors
/// Those of drawing; [`Error::Stopped`].
pub(super) fn draw(
    (device, program): (&Device, &dyn Program),
    converging: &ConvergingFrame,
    pipeline: &mut Pipeline,
    (scene, size): (&Scene, [u32; 2]),
    progress: &dyn Fn(usize, usize),
) -> Result<Option<ReferencePair>, Error> {
    let planned = |pipeline: &mut Pipeline, frames| {
        let mut memory = device.memory();
        converging.planned(pipeline, &device.profile(), &mut memory, frames)
    };
    let (extent, samples) = drawn(&planned(pipeline, 1)?.plan, size);
    let all = frames(extent, samples, size);
    let with_those_before = |frames: u16| usize::from(converging.before(frames)) + usize::from(frames);
    let in_all = with_those_before(all) + with_those_before(all / 2);
    let mut mean = |frames, done_before: usize| {
        let planned = planned(pipeline, frames)?;
        // Shifts are those of the texels that are drawn: together they sample each pixel of the output evenly.
        let shifts = Jitter::halton(frames, extent);
        let number = (converging.before(frames), frames);
        let progress = |done: u16| progress(done_before + usize::from(done), in_all);
        mean((device, program), &planned, pipeline, scene, (&shifts, number), (converging.steps.is_none(), &progress))
    };
    let Some(picture) = mean(all, 0)? else { return Ok(None) };
    Ok(mean(all / 2, with_those_before(all))?.map(|of_half| ReferencePair {
        picture,
        of_half,
        steps: converging.steps,
    }))
}

/// The mean of what a display shows of some frames, after others that aren't looked at: each is cut to what the tested output can
/// hold. `None` if there is no picture.
fn mean(
    (device, program): (&Device, &dyn Program),
    planned: &PlannedFrame,
    pipeline: &mut Pipeline,
    scene: &Scene,
    (shifts, (before, frames)): (&Jitter, (u16, u16)),
    (is_light, progress): (bool, &dyn Fn(u16)),
) -> Result<Option<Light>, Error> {
    let Some(request) = outputs::of_first_output(&planned.plan) else { return Ok(None) };
    let mut prepared =
        SceneRenderer::new(device, planned.parts(), &mut pipeline.assets, scene, &ExecutorOptions::default())?;
    prepared.source.set_jitter(shifts)?;
    let mut sum: Option<Sum> = None;
    for frame in 0..before + frames {
        if program.stops() {
            return Err(Error::Stopped { drawn: frame.into(), wanted: (before + frames).into() });
        }
        prepared.executor.frame(&mut prepared.source)?;
        progress(frame + 1);
        if frame < before {
            continue;
        }
        let file = request.encode(&mut prepared.executor, &planned.plan, &|note| program.note(note))?;
        let light = Light::decode(&file.contents).map_err(|problem| Error::NoLight { path: file.path, problem })?;
        let light = Light { is_light, ..light };
        sum.get_or_insert_with(|| Sum::of_nothing(&light)).add(&light);
    }
    Ok(sum.map(|sum| sum.mean()))
}

/// Size and samples of the largest target that objects are drawn into.
fn drawn(plan: &Plan, size: [u32; 2]) -> ([u32; 2], u32) {
    let scopes = plan.steps.iter().filter_map(|step| step.work.scope());
    let of_objects = scopes.filter(|scope| {
        !scope.color().is_empty() && scope.passes.iter().any(|pass| pass.draw.is_some_and(Draw::shows_objects))
    });
    let largest = of_objects.max_by_key(|scope| u64::from(scope.extent[0]) * u64::from(scope.extent[1]));
    largest.map_or((size, 1), |scope| (scope.extent, scope.samples))
}

/// How often the reference is drawn.
fn frames([width, height]: [u32; 2], samples: u32, size: [u32; 2]) -> u16 {
    let texels = f64::from(width) * f64::from(height) / (f64::from(size[0]) * f64::from(size[1]));
    let frames = f64::from(LEAST_SAMPLES) / (texels * f64::from(samples)).max(f64::MIN_POSITIVE);
    // An even number: half of it is compared with all.
    (frames.ceil().min(LONGEST_JITTER.into()) as u16).max(LEAST_FRAMES).next_multiple_of(2)
}

/// Light that is added up.
struct Sum {
    extent: [usize; 2],
    is_light: bool,
    light: Vec<[f64; 3]>,
    frames: f64,
}

impl Sum {
    fn of_nothing(like: &Light) -> Sum {
        Sum { extent: like.extent, is_light: like.is_light, light: vec![[0.0; 3]; like.texels.len()], frames: 0.0 }
    }

    fn add(&mut self, light: &Light) {
        for (sum, texel) in self.light.iter_mut().zip(&light.texels) {
            let shown = |light: f32| if self.is_light { light } else { light.clamp(0.0, 1.0) };
            sum.iter_mut().zip(texel).for_each(|(sum, light)| *sum += f64::from(shown(*light)));
        }
        self.frames += 1.0;
    }

    fn mean(&self) -> Light {
        #[allow(clippy::cast_possible_truncation, reason = "light is kept with as many bits as shaders have")]
        let texels = self.light.iter().map(|sum| sum.map(|sum| (sum / self.frames) as f32)).collect();
        Light { extent: self.extent, texels, is_light: self.is_light, left_out: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reference_has_enough_samples_and_an_even_number_of_frames() {
        let size = [100, 50];
        assert_eq!(frames([100, 50], 1, size), 64);
        assert_eq!(frames([100, 50], 4, size), 16);
        assert_eq!(frames([400, 200], 1, size), 16);
        assert_eq!(frames([50, 25], 1, size), 256);
        assert_eq!(frames([130, 50], 1, size), 50);
    }
}
