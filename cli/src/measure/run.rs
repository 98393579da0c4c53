//! Batches of choices: they are drawn in turns, so that a machine that becomes slower does so for all alike.

use super::held_against::Given;
use super::references::References;
use super::results::{Outcome, Row};
use super::subjects::Choice;
use crate::command_line::measuring::MeasureArguments;
use crate::drawing::{Prepared, diagnostics};
use crate::error::Error;
use crate::planning::{Loaded, Planned, View};
use crate::system::counted::Progress;
use crate::system::{Exit, interrupt};
use framewright_graph::base::ReadFiles;
use framewright_graph::compile::Options;
use framewright_graph::frame::Stereo;
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::Rotation;
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, ExecutorOptions, FrameReport};
use std::collections::BTreeMap;

/// Choices of a batch.
pub(super) const AT_ONCE: usize = 8;
/// Frames of each choice before times are taken.
pub(super) const WARM_UP: u32 = 2;

/// A pipeline on a device, and what its choices are held against.
pub(super) struct Bench<'a> {
    pub(super) arguments: &'a MeasureArguments,
    pub(super) pipeline: Loaded,
    /// The settings of the command line.
    pub(super) set: Vec<(String, String)>,
    pub(super) device: Device,
    pub(super) read: ReadFiles,
    pub(super) pipeline_digest: String,
    pub(super) given: Given,
    pub(super) references: References,
    pub(super) told_of_light: bool,
}

impl Bench<'_> {
    /// The Plan of a choice for a scene, under more settings.
    pub(super) fn planned(
        &mut self,
        choice: &Choice,
        scene: &Scene,
        more: &[(String, String)],
    ) -> Result<Planned, Error> {
        self.pipeline.set = self.set.iter().cloned().chain(choice.settings()).chain(more.iter().cloned()).collect();
        self.pipeline.stereo = choice.stereo.clone();
        let facts = Some(scene.facts());
        let view = View { facts, size: choice.size, rotation: Rotation::Identity, dump: &[] };
        let (profile, mut memory) = (self.device.profile(), self.device.memory());
        let planned = self.pipeline.plan(view, &profile, &mut memory, &Options::default())?;
        diagnostics::cameras(&planned.plan, Some(&planned.frame), scene)?;
        Ok(planned)
    }

    /// Measures a few choices, in turns with the baseline.
    pub(super) fn batch(
        &mut self,
        (baseline, all_settings): (&Choice, &BTreeMap<String, String>),
        batch: &[Choice],
        progress: &Progress,
    ) -> Result<Vec<Row>, Error> {
        let options = ExecutorOptions { timestamps: true, fragment_counts: true, ..ExecutorOptions::default() };
        let all: Vec<&Choice> = [baseline].into_iter().chain(batch).collect();
        let mut plans = Vec::with_capacity(all.len());
        for choice in &all {
            plans.push(kept(self.planned(choice, &choice.scene.scene, &[]))?);
        }
        let mut prepared = Vec::with_capacity(all.len());
        for (choice, planned) in all.iter().zip(&plans) {
            let ready = planned.as_ref().map_err(Clone::clone).map(|planned| {
                let assets = &mut self.pipeline.assets;
                Prepared::new(&self.device, planned.parts(), assets, &choice.scene.scene, &options)
            });
            prepared.push(match ready {
                Ok(ready) => kept(ready)?,
                Err(why) => Err(why),
            });
        }
        let mut frames: Vec<Vec<FrameReport>> = vec![Vec::new(); all.len()];
        for round in 0..WARM_UP + self.arguments.frames {
            for (ready, frames) in prepared.iter_mut().zip(&mut frames) {
                if interrupt::asked() {
                    return Err(Error::Interrupted { frames: round, wanted: WARM_UP + self.arguments.frames });
                }
                progress.step();
                let Ok(drawn) = ready else { continue };
                match kept(drawn.draw())? {
                    Ok(report) if round >= WARM_UP => frames.push(report),
                    Ok(_) => {}
                    Err(why) => *ready = Err(why),
                }
            }
        }
        if let Some(Err(why)) = prepared.first() {
            return Err(Error::Sweep {
                what: format!("the choice that all others are relative to can't be drawn: {why}"),
            });
        }
        let (of_baseline, frames) = frames.split_first().map_or((&[][..], &[][..]), |(first, rest)| (first, rest));
        let mut rows = Vec::with_capacity(batch.len());
        for ((choice, ready), frames) in batch.iter().zip(prepared.into_iter().skip(1)).zip(frames) {
            let (settings, stereo, outcome) = match ready {
                Ok(mut drawn) => {
                    let measured = self.measured(choice, &mut drawn, frames, of_baseline)?;
                    let outcome = Outcome::Measured(Box::new(measured));
                    (settings(drawn.plan), drawn.plan.stereo, outcome)
                }
                Err(why) => {
                    let settings = all_settings.iter().filter(|(name, _)| !name.starts_with('@'));
                    let settings = settings.map(|(name, value)| (name.clone(), value.clone()));
                    (settings.chain(choice.settings()).collect(), self.stereo(choice), Outcome::Failed(why))
                }
            };
            rows.push(Row {
                choice: choice.values.clone(),
                settings,
                scene: choice.scene.file.clone(),
                scene_digest: choice.scene.digest.clone(),
                size: [choice.size.width, choice.size.height],
                stereo: stereo.name().to_owned(),
                outcome,
            });
            progress.done_one();
        }
        Ok(rows)
    }

    /// The way in which a choice would be drawn for two eyes.
    fn stereo(&self, choice: &Choice) -> Stereo {
        Stereo::first_fit(&choice.stereo.0, &self.device.profile()).unwrap_or(choice.stereo.0[0])
    }
}

/// A choice's own problem stays with it; one of the whole command ends it.
fn kept<T>(result: Result<T, Error>) -> Result<Result<T, String>, Error> {
    match result {
        Ok(value) => Ok(Ok(value)),
        Err(error) if interrupt::asked() || matches!(error.exit(), Exit::Usage | Exit::Interrupted) => Err(error),
        Err(error) => Ok(Err(error.to_string().trim_end().to_owned())),
    }
}

/// All settings of a Plan.
pub(super) fn settings(plan: &Plan) -> BTreeMap<String, String> {
    plan.settings.iter().map(|used| (used.name.to_string(), used.value.clone())).collect()
}
