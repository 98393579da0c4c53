//! Measuring: choices are drawn in turns, a few at a time, and each batch is written as soon as it is done.

use super::held_against::{AUTO, GIVEN, Given, light};
use super::references::{Reference, References};
use super::results::{Cost, FORMAT_VERSION, Measured, Outcome, PassCost, Results, Row, Subject};
use super::spread::spread;
use super::subjects::{self, Choice};
use super::table::table;
use super::{checks, pipeline_digest, store, sweep};
use crate::command_line::measuring::MeasureArguments;
use crate::drawing::{Prepared, diagnostics, pictures, timings};
use crate::error::Error;
use crate::files::{inputs, outputs};
use crate::metric::{self, Errors, PIXELS_PER_DEGREE};
use crate::planning::{self, Loaded, Planned, View, device};
use crate::system::counted::{Progress, Words};
use crate::system::{Exit, interrupt, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::compile::Options;
use framewright_graph::plan::Plan;
use framewright_graph::vulkan::Rotation;
use framewright_passes::scene::Scene;
use framewright_vulkan::{Device, DeviceOptions, ExecutorOptions, FrameReport};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Choices that are drawn in turns, so that a machine that becomes slower does so for all alike.
const AT_ONCE: usize = 8;
/// Frames of each choice before times are taken.
const WARM_UP: u32 = 2;
/// Flicker that its picture shows as the brightest.
const BRIGHTEST_FLICKER: f64 = 0.25;
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

/// Measures a sweep.
///
/// # Errors
/// If a file or the sweep is wrong, the device is missing, or something can't be written. A choice that can't be drawn is a row.
pub(crate) fn measure(arguments: &MeasureArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    inputs::expect(&arguments.pipeline, &read);
    let chosen = device::to_draw_on(arguments.device.as_deref())?;
    let mut pipeline = planning::load(&arguments.pipeline, &read)?;
    let (baseline, choices) = subjects::choices(arguments, &pipeline, &read)?;
    if arguments.reference == Path::new(AUTO) && subjects::reference_settings(&pipeline).is_none() {
        let what = format!(
            "the pipeline has no preset `{}` to make the reference by: name a picture by --reference, or `none`",
            subjects::REFERENCE
        );
        return Err(Error::Sweep { what });
    }
    checks::values(&pipeline, &choices)?;
    let given = Given::of(arguments, &read)?;
    if let Given::Picture(picture) = &given {
        checks::sizes((&arguments.reference, picture), &mut pipeline, &baseline, &choices)?;
    }
    if arguments.flicker.is_some() && !matches!(given, Given::Auto) {
        let what =
            "flicker is measured against references of each frame: leave out --reference or --flicker".to_owned();
        return Err(Error::Sweep { what });
    }
    outputs::make_folder(&arguments.output)?;
    interrupt::watch();
    let helper = Some(pipeline.assets.helper.clone());
    let device = Device::open(&DeviceOptions { choice: chosen, validation: false, helper })?;
    device.cancel_when(interrupt::asked);
    let set = pipeline.set.clone();
    let mut references = References::of(arguments.output.clone());
    if let Given::Picture(picture) = &given {
        references.remember(GIVEN, Reference { picture: picture.clone(), errors: None });
    }
    let pipeline_digest = pipeline_digest::of(&pipeline);
    let mut bench =
        Bench { arguments, pipeline, set, device, read, pipeline_digest, given, references, told_of_light: false };
    let mut results = bench.begun(&baseline)?;
    let choices = sweep::shard(choices, arguments.shard.number, arguments.shard.of);
    // One that failed is tried again: the reason may have been the machine's.
    let is_there = |row: &Row, choice: &Choice| is_of(row, choice) && matches!(row.outcome, Outcome::Measured(_));
    let is_missing = |choice: &&Choice| !results.rows.iter().any(|row| is_there(row, choice));
    let missing: Vec<Choice> = choices.iter().filter(is_missing).cloned().collect();
    if missing.len() < choices.len() {
        let there = text::count(choices.len() - missing.len(), "choice is", "choices are");
        text::say(&format!("note: {there} measured already"));
    }
    let words = Words { doing: "measuring", done: "measured", things: "choices" };
    let progress = Progress::new(missing.len(), words, Duration::from_secs(60));
    for batch in missing.chunks(AT_ONCE) {
        let rows = bench.batch((&baseline, &results.subject.baseline), batch, &progress).map_err(|error| {
            match interrupt::asked() {
                true => Error::InterruptedMeasuring { measured: results.rows.len(), wanted: choices.len() },
                false => error,
            }
        })?;
        results.rows.retain(|row| !batch.iter().any(|choice| is_of(row, choice)));
        results.rows.extend(rows);
        results.rows.sort_by_key(|row| choices.iter().position(|choice| is_of(row, choice)));
        store::write(&arguments.output, &results)?;
        store::write_views(&arguments.output, &results)?;
    }
    progress.finish();
    if missing.is_empty() {
        // A part of a sweep may be empty.
        store::write(&arguments.output, &results)?;
        store::write_views(&arguments.output, &results)?;
    }
    text::print(&table(&results)).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

/// Whether a row is about a choice.
fn is_of(row: &Row, choice: &Choice) -> bool {
    row.choice == choice.values
        && row.scene_digest == choice.scene.digest
        && row.size == [choice.size.width, choice.size.height]
}

impl Bench<'_> {
    /// The results that the folder holds already, or none yet.
    fn begun(&mut self, baseline: &Choice) -> Result<Results, Error> {
        let planned = self.planned(baseline, &baseline.scene.scene, &[])?;
        let mut of_baseline = settings(&planned.plan);
        of_baseline.extend([
            (subjects::SCENE.to_owned(), baseline.scene.digest.clone()),
            (subjects::SIZE.to_owned(), baseline.size.to_string()),
            (subjects::STEREO.to_owned(), planned.plan.stereo.name().to_owned()),
        ]);
        let subject = Subject {
            pipeline: self.arguments.pipeline.file.to_string_lossy().into_owned(),
            pipeline_digest: self.pipeline_digest.clone(),
            device: self.device.summary().name.clone(),
            driver: self.device.summary().driver.clone(),
            frames: self.arguments.frames,
            flicker_frames: self.arguments.flicker,
            reference: self.given.name(),
            baseline: of_baseline,
        };
        let folder = &self.arguments.output;
        for within in ["pictures", "heat_maps"] {
            outputs::make_folder(&folder.join(within))?;
        }
        if !folder.join(store::FILE).exists() {
            return Ok(Results { format_version: FORMAT_VERSION, subject, rows: Vec::new() });
        }
        let results = store::read(folder, &self.read)?;
        match results.subject == subject {
            true => Ok(results),
            false => Err(Error::OtherSweep { folder: folder.clone() }),
        }
    }

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
    fn batch(
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
                    (settings.chain(choice.settings()).collect(), choice.stereo.0[0], Outcome::Failed(why))
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

    /// The figures of a choice that was drawn.
    fn measured(
        &mut self,
        choice: &Choice,
        drawn: &mut Prepared<'_>,
        frames: &[FrameReport],
        of_baseline: &[FrameReport],
    ) -> Result<Measured, Error> {
        let over = |time: &dyn Fn(&FrameReport) -> f64| spread(frames.iter().map(time).collect());
        let ratios = frames.iter().zip(of_baseline).filter(|(_, baseline)| baseline.milliseconds > 0.0);
        let plan = drawn.plan;
        let by_frame: Vec<Vec<timings::Row>> =
            frames.iter().map(|frame| timings::rows(plan, std::slice::from_ref(frame))).collect();
        let pass = |(at, row): (usize, &timings::Row)| PassCost {
            name: row.name.clone(),
            gpu_milliseconds: spread(by_frame.iter().map(|rows| rows[at].gpu_milliseconds).collect()),
        };
        let cost = Cost {
            gpu_milliseconds: over(&|frame| frame.milliseconds),
            gpu_ratio: spread(ratios.map(|(frame, baseline)| frame.milliseconds / baseline.milliseconds).collect()),
            recording_milliseconds: over(&|frame| frame.recording_milliseconds),
            transient_bytes: plan.totals.placed_bytes,
            moved_bytes: plan.moved().sum(),
            fragment_invocations: middle(frames.iter().filter_map(|frame| frame.fragment_invocations).collect()),
        };
        let passes = by_frame.first().map_or_else(Vec::new, |rows| rows.iter().enumerate().map(pass).collect());
        let mut measured = Measured {
            cost,
            errors: None,
            reference_errors: None,
            passes,
            picture: None,
            reference: None,
            heat_map: None,
            flicker: None,
            flicker_map: None,
        };
        let Some(request) = pictures::of_first_output(plan) else { return Ok(measured) };
        let picture = request.encode(&mut drawn.executor, plan)?;
        let name = |folder: &str, ending: &str| format!("{folder}/{}.{ending}", choice.key());
        let ending = picture.path.extension().map_or("png", |ending| if ending == "exr" { "exr" } else { "png" });
        measured.picture = Some(self.written(name("pictures", ending), &picture.contents)?);
        let shown = light(&picture.contents, &picture.path)?;
        let Some((reference, key)) = self.reference(choice, 0)? else { return Ok(measured) };
        measured.reference = Some(self.shown(&key, &reference.picture)?);
        if reference.picture.extent != shown.extent {
            let reference = (self.arguments.reference.clone(), reference.picture.extent);
            return Err(Error::Sizes { reference, picture: (PathBuf::from(name("pictures", ending)), shown.extent) });
        }
        self.tell_of_light(&reference.picture, &shown);
        let errors = Errors::between(&reference.picture, &shown, PIXELS_PER_DEGREE);
        let size = shown.extent.map(|size| u32::try_from(size).unwrap_or(u32::MAX));
        let heat_map = |image: &str, values: &[f64]| {
            let map = metric::heat_map(values, size);
            map.map_err(|problem| Error::Picture { image: image.to_owned(), problem })
        };
        measured.heat_map = Some(self.written(name("heat_maps", "png"), &heat_map("flip", errors.flip_map())?)?);
        measured.errors = Some(errors);
        measured.reference_errors.clone_from(&reference.errors);
        if let Some(frames) = self.arguments.flicker
            && let Some(flicker) = self.flicker(choice, frames)?
        {
            let seen: Vec<f64> = flicker.map().iter().map(|it| it / BRIGHTEST_FLICKER).collect();
            let file = format!("heat_maps/{}_flicker.png", choice.key());
            measured.flicker_map = Some(self.written(file, &heat_map("flicker", &seen)?)?);
            measured.flicker = Some(flicker);
        }
        Ok(measured)
    }

    /// Writes a file into the folder, and answers with its path there.
    pub(super) fn written(&self, name: String, contents: &[u8]) -> Result<String, Error> {
        outputs::write(&[(&self.arguments.output.join(&name), contents)], &self.read)?;
        Ok(name)
    }
}

/// The middle of some counts, of two in the middle the greater; `None` of none.
fn middle(mut counts: Vec<u64>) -> Option<u64> {
    counts.sort_unstable();
    counts.get(counts.len() / 2).copied()
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
