//! Batches of choices: they are drawn in turns, so that a machine that becomes slower does so for all alike.

use super::held_against::Given;
use super::references::References;
use super::results::{Outcome, Row};
use super::subjects::Choice;
use crate::command_line::measuring::MeasureArguments;
use crate::error::Error;
use crate::system::counted::Progress;
use crate::system::{Exit, interrupt};
use framewright::{Choices, Pipeline, Planned, SceneRenderer};
use framewright_graph::base::ReadFiles;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Draw, Pass, Stereo};
use framewright_graph::plan::{Note, Plan, Stage};
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
    pub(super) pipeline: Pipeline,
    /// What the command line chooses for all choices.
    pub(super) of_all: Choices,
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
        let mut choices = choice.of(&self.of_all, scene);
        choices.set.extend(more.iter().cloned());
        let (profile, mut memory) = (self.device.profile(), self.device.memory());
        let planned = self.pipeline.planned(&choices, &profile, &mut memory, &Options::default())?;
        framewright::check_cameras(&planned.plan, Some(&planned.frame), scene)?;
        Ok(planned)
    }

    /// Measures a few choices, in turns with the baseline. Rows are added as soon as they are finished.
    pub(super) fn batch(
        &mut self,
        (baseline, all_settings): (&Choice, &BTreeMap<String, String>),
        batch: &[Choice],
        progress: &Progress,
        rows: &mut Vec<Row>,
    ) -> Result<(), Error> {
        let options = ExecutorOptions { timestamps: true, fragment_counts: true, ..ExecutorOptions::default() };
        let all: Vec<&Choice> = [baseline].into_iter().chain(batch).collect();
        let mut plans = Vec::with_capacity(all.len());
        for (at, choice) in all.iter().enumerate() {
            let planned = kept(self.planned(choice, &choice.scene.scene, &[]))?;
            plans.push(planned.and_then(|planned| match fewer_samples(&planned) {
                Some(why) if at > 0 => Err(why),
                _ => Ok(planned),
            }));
        }
        let mut prepared = Vec::with_capacity(all.len());
        for (choice, planned) in all.iter().zip(&plans) {
            let ready = planned.as_ref().map_err(Clone::clone).map(|planned| {
                let assets = &mut self.pipeline.assets;
                SceneRenderer::new(&self.device, planned.parts(), assets, &choice.scene.scene, &options)
            });
            prepared.push(match ready {
                Ok(ready) => kept(ready.map_err(Error::from))?,
                Err(why) => Err(why),
            });
        }
        let mut frames: Vec<Vec<FrameReport>> = vec![Vec::new(); all.len()];
        for round in 0..WARM_UP + self.arguments.frames {
            for (at, (ready, frames)) in prepared.iter_mut().zip(&mut frames).enumerate() {
                if interrupt::asked() {
                    return Err(Error::Interrupted { frames: round, wanted: WARM_UP + self.arguments.frames });
                }
                // The baseline isn't counted: it belongs to all.
                if at > 0 {
                    progress.step();
                }
                let Ok(drawn) = ready else { continue };
                match kept(drawn.draw().map_err(Error::from))? {
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
        for ((choice, ready), frames) in batch.iter().zip(prepared.into_iter().skip(1)).zip(frames) {
            let (settings, stereo, outcome) = match ready {
                Ok(mut drawn) => {
                    let measured = kept(self.measured(choice, &mut drawn, frames, of_baseline))?;
                    let outcome = measured.map_or_else(Outcome::Failed, |it| Outcome::Measured(Box::new(it)));
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
                size: choice.size,
                stereo: stereo.name().to_owned(),
                outcome,
            });
            progress.done_one();
        }
        Ok(())
    }

    /// The way in which a choice would be drawn for two eyes.
    fn stereo(&self, choice: &Choice) -> Stereo {
        Stereo::first_fit(&choice.stereo, &self.device.profile()).unwrap_or(choice.stereo[0])
    }
}

/// Why an image that objects are drawn into has fewer samples than were chosen: the device lacks them. What would be drawn is another
/// choice, so this one isn't measured.
fn fewer_samples(planned: &Planned) -> Option<String> {
    let Planned { frame, plan, .. } = planned;
    let draws = |pass: &&Pass| pass.work.draws(Draw::shows_objects);
    let mut targets = frame.passes.iter().filter(draws).flat_map(|pass| &pass.color);
    targets.find_map(|target| {
        let wanted = frame.images.get(target.image.0 as usize)?;
        let has = plan.images.iter().find(|image| image.name == wanted.name)?.samples;
        let noted = |note: &&Note| note.stage == Stage::Fit && note.subject == wanted.name;
        let why = plan.notes.iter().find(noted).map_or("the device has no more samples", |note| &*note.text);
        (has < wanted.samples).then(|| format!("`{}`: {why}", wanted.name))
    })
}

/// A choice's own problem stays with it; one of the whole command ends it.
pub(super) fn kept<T>(result: Result<T, Error>) -> Result<Result<T, String>, Error> {
    match result {
        Ok(value) => Ok(Ok(value)),
        Err(error) if interrupt::asked() || is_of_all(&error) => Err(error),
        Err(error) => Ok(Err(error.to_string().trim_end().to_owned())),
    }
}

/// Whether every further choice would meet the same problem: a device that is lost, a full disk, a wrong command line.
fn is_of_all(error: &Error) -> bool {
    !error.can_be_mended_in_files()
        || matches!(error.exit(), Exit::Usage | Exit::Interrupted)
        || matches!(error, Error::Write { .. } | Error::NoFolder { .. } | Error::Sizes { .. })
}

/// All settings of a Plan.
pub(super) fn settings(plan: &Plan) -> BTreeMap<String, String> {
    plan.settings.iter().map(|used| (used.name.to_string(), used.value.clone())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_vulkan::Error as Problem;

    #[test]
    fn a_lost_device_ends_a_sweep_and_a_choice_that_can_not_be_drawn_does_not() {
        let ended = kept::<()>(Err(Error::Vulkan(Problem::DeviceLost { doing: "drawing" })));
        assert_eq!(ended.expect_err("it ends").exit(), Exit::Environment);
        let full = Error::Write { path: "pictures/a.png".into(), source: std::io::ErrorKind::StorageFull.into() };
        assert_eq!(kept::<()>(Err(full)).expect_err("it ends").exit(), Exit::Environment);
        let own = kept::<()>(Err(Error::NoPicture { output: "list".to_owned() }));
        assert!(own.expect("a row").expect_err("its error").contains("`list` is a buffer"));
    }
}
