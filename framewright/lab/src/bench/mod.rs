//! A pipeline on a device, whose choices are measured.
//!
//! ```text
//! choices ─► batch: drawn in turns with the baseline ─► choice_figures: cost, reference, errors
//! ```

mod batch;
mod checks;
mod choice;
mod choice_figures;
mod converging_frame;
mod cost;
mod error_baseline;
mod pipeline_digest;
mod program;
mod reference;
mod references;

use crate::error::Error;
use crate::results::{FLICKER_FRAMES, FRAMES, Subject};
use crate::sweep::{SCENE, SIZE, STEREO, size_name};
use framewright::{Choices, Device, Pipeline, PlannedFrame, Scene};
use framewright_graph::compile;
use framewright_graph::plan::Plan;
use references::{GIVEN, Reference, References};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

pub use batch::{AT_ONCE, BatchProgress, WARM_UP};
pub use checks::{check_sizes, check_values};
pub use choice::{Choice, MeasuredScene, REFERENCE, of_reference, reference_settings};
pub use error_baseline::ErrorBaseline;
pub use program::Program;

/// How choices are measured. Begin with the default, and set fields.
#[derive(Debug)]
#[non_exhaustive]
pub struct BenchOptions {
    /// Frames of each choice whose times are taken, of [`FRAMES`]; by default 9.
    pub frames: u32,
    /// Frames of the moving scene over which flicker is measured, of [`FLICKER_FRAMES`]; `None`: it isn't.
    pub flicker: Option<u32>,
    /// The pictures that errors are measured against; by default those of the preset [`REFERENCE`].
    pub held_against: ErrorBaseline,
}

impl Default for BenchOptions {
    fn default() -> Self {
        BenchOptions { frames: 9, flicker: None, held_against: ErrorBaseline::References }
    }
}

/// A pipeline on a device, and what its choices are held against.
pub struct Bench<'p> {
    pipeline: Pipeline,
    /// What is chosen for all choices.
    of_all: Choices,
    device: Device,
    options: BenchOptions,
    program: &'p dyn Program,
    pipeline_digest: String,
    references: References,
}

impl<'p> Bench<'p> {
    /// One that has measured nothing. `of_all` is chosen for all choices.
    ///
    /// # Errors
    /// [`Error::Sweep`] if a number of frames is out of its range.
    pub fn new(
        device: &Device,
        pipeline: Pipeline,
        of_all: Choices,
        options: BenchOptions,
        program: &'p dyn Program,
    ) -> Result<Bench<'p>, Error> {
        let in_range = |what: &str, frames: u32, range: RangeInclusive<u32>| match range.contains(&frames) {
            true => Ok(()),
            false => Err(Error::Sweep {
                what: format!("{what} over {} to {} frames, and not {frames}", range.start(), range.end()),
            }),
        };
        in_range("times are taken", options.frames, FRAMES)?;
        options.flicker.map_or(Ok(()), |frames| in_range("flicker is measured", frames, FLICKER_FRAMES))?;
        let mut references = References::default();
        if let ErrorBaseline::Picture { picture, .. } = &options.held_against {
            references.remember(GIVEN, Reference { picture: picture.clone(), errors: None });
        }
        Ok(Bench {
            pipeline_digest: pipeline_digest::of(&pipeline),
            references,
            pipeline,
            of_all,
            device: device.clone(),
            options,
            program,
        })
    }

    /// What all rows have in common that are measured beside `baseline`. `name` is the pipeline's, for people.
    ///
    /// # Errors
    /// Those of planning the baseline.
    pub fn subject(&mut self, name: String, baseline: &Choice) -> Result<Subject, Error> {
        let plan = self.planned(baseline, &baseline.scene.still, &[])?.plan;
        let mut of_baseline = settings(&plan);
        of_baseline.extend([
            (SCENE.to_owned(), baseline.scene.digest.clone()),
            (SIZE.to_owned(), size_name(baseline.size)),
            (STEREO.to_owned(), plan.stereo.name().to_owned()),
        ]);
        Ok(Subject {
            framewright: env!("CARGO_PKG_VERSION").to_owned(),
            shipped_shaders: pipeline_digest::of_shipped_shaders(),
            pipeline: name,
            pipeline_digest: self.pipeline_digest.clone(),
            device: self.device.summary().name.clone(),
            driver: self.device.summary().driver.clone(),
            frames: self.options.frames,
            flicker_frames: self.options.flicker,
            reference: self.options.held_against.name(),
            baseline: of_baseline,
        })
    }

    /// The Plan of a choice for a scene, under more settings.
    fn planned(&mut self, choice: &Choice, scene: &Scene, more: &[(String, String)]) -> Result<PlannedFrame, Error> {
        let mut choices = choice.of(&self.of_all, scene);
        choices.set.extend(more.iter().cloned());
        let (profile, mut memory) = (self.device.profile(), self.device.memory());
        let planned = self.pipeline.planned(&choices, &profile, &mut memory, &compile::Options::default())?;
        framewright::check_cameras(&planned.plan, Some(&planned.frame), scene)?;
        Ok(planned)
    }

    /// A choice's own problem stays with it, in words; one of the whole sweep ends it.
    fn own<T>(&self, result: Result<T, Error>) -> Result<Result<T, String>, Error> {
        match result {
            Ok(value) => Ok(Ok(value)),
            Err(error) if self.program.stops() || error.ends_a_sweep() => Err(error),
            Err(error) => Ok(Err(self.program.words(error).trim_end().to_owned())),
        }
    }

    /// Keeps a file, and answers with its name.
    fn written(&self, name: String, contents: &[u8]) -> Result<String, Error> {
        self.program.keep(&name, contents).map_err(Error::Program)?;
        Ok(name)
    }

    /// Fails if the program asks to stop. The error tells how many frames are `drawn` and how many were `wanted`.
    fn goes_on(&self, drawn: u32, wanted: u32) -> Result<(), Error> {
        if self.program.stops() { Err(Error::Stopped { drawn, wanted }) } else { Ok(()) }
    }
}

/// All settings of a Plan.
fn settings(plan: &Plan) -> BTreeMap<String, String> {
    plan.settings.iter().map(|used| (used.name.to_string(), used.value.clone())).collect()
}
