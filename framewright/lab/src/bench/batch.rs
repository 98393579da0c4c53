//! Batches of choices: they are drawn in turns, so that a machine that becomes slower does so for all alike.

use super::choice::Choice;
use super::{Bench, settings};
use crate::error::Error;
use crate::results::{Outcome, Row, Subject};
use framewright::{PlannedFrame, SceneRenderer};
use framewright_graph::frame::{Draw, Pass, Stereo};
use framewright_graph::plan::{Note, Stage};
use framewright_vulkan::{ExecutorOptions, FrameReport};

/// The most choices in a batch. All of them are in memory at once.
pub const AT_ONCE: usize = 8;
/// Frames of each choice before times are taken.
pub const WARM_UP: u32 = 2;

/// What was just done, of the work of a batch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BatchProgress {
    /// A frame of a choice: each has [`WARM_UP`] and those whose times are taken.
    Frame,
    /// A choice: it has its row.
    Choice,
}

impl Bench<'_> {
    /// Measures a few choices, at most [`AT_ONCE`], in turns with the baseline of a subject. Rows are added as soon as they are finished:
    /// a choice that can't be drawn has one too. `progress` is told of each frame and choice.
    ///
    /// # Errors
    /// Those that all choices would meet: see [`Error::ends_a_sweep`].
    pub fn batch(
        &mut self,
        (baseline, subject): (&Choice, &Subject),
        batch: &[Choice],
        progress: &dyn Fn(BatchProgress),
        rows: &mut Vec<Row>,
    ) -> Result<(), Error> {
        let options = ExecutorOptions { timestamps: true, fragment_counts: true, ..ExecutorOptions::default() };
        let all: Vec<&Choice> = [baseline].into_iter().chain(batch).collect();
        let mut plans = Vec::with_capacity(all.len());
        for (at, choice) in all.iter().enumerate() {
            let planned = self.planned(choice, &choice.scene.still, &[]);
            let planned = self.own(planned)?;
            plans.push(planned.and_then(|planned| match fewer_samples(&planned) {
                Some(why) if at > 0 => Err(why),
                _ => Ok(planned),
            }));
        }
        let mut prepared = Vec::with_capacity(all.len());
        for (choice, planned) in all.iter().zip(&plans) {
            let ready = planned.as_ref().map_err(Clone::clone).map(|planned| {
                let assets = &mut self.pipeline.assets;
                SceneRenderer::new(&self.device, planned.parts(), assets, &choice.scene.still, &options)
            });
            prepared.push(match ready {
                Ok(ready) => self.own(ready.map_err(Error::from))?,
                Err(why) => Err(why),
            });
        }
        let mut frames: Vec<Vec<FrameReport>> = vec![Vec::new(); all.len()];
        for round in 0..WARM_UP + self.options.frames {
            for (at, (ready, frames)) in prepared.iter_mut().zip(&mut frames).enumerate() {
                self.goes_on(round, WARM_UP + self.options.frames)?;
                // The baseline isn't counted: it belongs to all.
                if at > 0 {
                    progress(BatchProgress::Frame);
                }
                let Ok(drawn) = ready else { continue };
                match self.own(drawn.draw().map_err(Error::from))? {
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
                    let measured = self.measured(choice, &mut drawn, frames, of_baseline);
                    let measured = self.own(measured)?;
                    let outcome = measured.map_or_else(Outcome::Failed, |it| Outcome::Measured(Box::new(it)));
                    (settings(drawn.plan), drawn.plan.stereo, outcome)
                }
                Err(why) => {
                    let settings = subject.baseline.iter().filter(|(name, _)| !name.starts_with('@'));
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
            progress(BatchProgress::Choice);
        }
        Ok(())
    }

    /// The way in which a choice would be drawn for two eyes.
    fn stereo(&self, choice: &Choice) -> Stereo {
        let choices = choice.of(&self.of_all, &choice.scene.still);
        choices.stereo_on(&self.device.profile()).unwrap_or(choice.stereo.first().copied().unwrap_or_default())
    }
}

/// Why an image that objects are drawn into has fewer samples than were chosen: the device lacks them. What would be drawn is another
/// choice, so this one isn't measured.
fn fewer_samples(planned: &PlannedFrame) -> Option<String> {
    let PlannedFrame { frame, plan, .. } = planned;
    let draws = |pass: &&Pass| pass.work.draws(Draw::shows_objects);
    let mut targets = frame.passes.iter().filter(draws).flat_map(|pass| &pass.color);
    targets.find_map(|target| {
        let wanted = frame.images.get(target.image.0 as usize)?;
        let has = plan.images.iter().find(|image| image.name == wanted.name)?.samples;
        let noted = |note: &&Note| note.stage() == Stage::Fit && note.subject == wanted.name;
        let why = plan.notes.iter().find(noted).map_or("the device has no more samples", |note| &*note.text);
        (has < wanted.samples).then(|| format!("`{}`: {why}", wanted.name))
    })
}
