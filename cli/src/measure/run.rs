//! Measuring: choices are drawn in turns, a few at a time, and each batch is written as soon as it is done.

use super::digest::Digest;
use super::moved_bytes::moved_bytes;
use super::reference::{self, Reference};
use super::results::{Cost, FORMAT_VERSION, Measured, Outcome, PassCost, Results, Row, Subject};
use super::spread::spread;
use super::subjects::{self, Choice};
use super::{store, sweep};
use crate::command_line::measuring::MeasureArguments;
use crate::drawing::{Prepared, diagnostics, pictures, timings};
use crate::error::Error;
use crate::files::{inputs, outputs};
use crate::metric::{self, Errors, PIXELS_PER_DEGREE};
use crate::picture::{FileFormat, Light, Picture};
use crate::planning::{self, Loaded, Planned, View, device};
use crate::system::counted::{Progress, Words};
use crate::system::{Exit, interrupt, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::compile::Options;
use framewright_graph::vulkan::{Format, Rotation};
use framewright_vulkan::{Device, DeviceOptions, ExecutorOptions, FrameReport};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Duration;

/// Choices that are drawn in turns, so that a machine that becomes slower does so for all alike.
const AT_ONCE: usize = 8;
/// Frames of each choice before times are taken.
const WARM_UP: u32 = 2;
/// The values of `--reference` that are no files.
const AUTO: &str = "auto";
const NONE: &str = "none";

/// A pipeline on a device, and what its choices are held against.
struct Bench<'a> {
    arguments: &'a MeasureArguments,
    pipeline: Loaded,
    /// The settings of the command line.
    set: Vec<(String, String)>,
    device: Device,
    read: ReadFiles,
    /// By the settings, scene, size and stereo that they are of.
    references: HashMap<String, Option<Kept>>,
}

/// A reference, and its picture within the folder.
type Kept = (Rc<Reference>, Option<String>);

/// Measures a sweep.
///
/// # Errors
/// If a file or the sweep is wrong, the device is missing, or something can't be written. A choice that can't be drawn is a row.
pub(crate) fn measure(arguments: &MeasureArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    inputs::expect(&arguments.pipeline, &read);
    let chosen = device::to_draw_on(arguments.device.as_deref())?;
    let pipeline = planning::load(&arguments.pipeline, &read)?;
    let (baseline, choices) = subjects::choices(arguments, &pipeline, &read)?;
    if arguments.reference == Path::new(AUTO) && subjects::reference_settings(&pipeline).is_none() {
        let what = format!(
            "the pipeline has no preset `{}` to make the reference by: name a picture by --reference, or `none`",
            subjects::REFERENCE
        );
        return Err(Error::Sweep { what });
    }
    interrupt::watch();
    let helper = Some(pipeline.helper.clone());
    let device = Device::open(&DeviceOptions { choice: chosen, validation: false, helper })?;
    device.cancel_when(interrupt::asked);
    let set = pipeline.set.clone();
    let mut bench = Bench { arguments, pipeline, set, device, read, references: HashMap::new() };
    let mut results = bench.begun(&baseline)?;
    let choices = sweep::shard(choices, arguments.shard.number, arguments.shard.of);
    let is_missing = |choice: &&Choice| !results.rows.iter().any(|row| is_of(row, choice));
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
        let planned = self.planned(baseline, &[])?;
        let mut of_baseline = settings(&planned);
        of_baseline.extend([
            (subjects::SCENE.to_owned(), baseline.scene.digest.clone()),
            (subjects::SIZE.to_owned(), baseline.size.to_string()),
            (subjects::STEREO.to_owned(), planned.plan.stereo.name().to_owned()),
        ]);
        let reference = match self.arguments.reference.to_str() {
            Some(word @ (AUTO | NONE)) => word.to_owned(),
            _ => Digest::of_value(&inputs::picture(&self.arguments.reference, &self.read)?),
        };
        let texts = (0..).map_while(|file| self.pipeline.sources.file(file)).map(|file| &*file.text);
        let subject = Subject {
            pipeline: self.arguments.pipeline.file.to_string_lossy().into_owned(),
            pipeline_digest: Digest::of(texts),
            device: self.device.summary().name.clone(),
            driver: self.device.summary().driver.clone(),
            frames: self.arguments.frames,
            reference,
            baseline: of_baseline,
        };
        let folder = &self.arguments.output;
        let made = |folder: &Path| std::fs::create_dir_all(folder);
        made(folder)
            .and_then(|()| made(&folder.join("pictures")))
            .and_then(|()| made(&folder.join("heat_maps")))
            .map_err(|source| Error::Write { path: folder.clone(), source })?;
        if !folder.join(store::FILE).exists() {
            return Ok(Results { format_version: FORMAT_VERSION, subject, rows: Vec::new() });
        }
        let results = store::read(folder, &self.read)?;
        match results.subject == subject {
            true => Ok(results),
            false => Err(Error::OtherSweep { folder: folder.clone() }),
        }
    }

    /// The Plan of a choice under more settings.
    fn planned(&mut self, choice: &Choice, more: &[(String, String)]) -> Result<Planned, Error> {
        self.pipeline.set = self.set.iter().cloned().chain(choice.settings()).chain(more.iter().cloned()).collect();
        self.pipeline.stereo = choice.stereo.clone();
        let facts = Some(choice.scene.scene.facts());
        let view = View { facts, size: choice.size, rotation: Rotation::Identity, dump: &[] };
        let (profile, mut memory) = (self.device.profile(), self.device.memory());
        let planned = self.pipeline.plan(view, &profile, &mut memory, &Options::default())?;
        diagnostics::cameras(&planned.frame, &choice.scene.scene)?;
        Ok(planned)
    }

    /// Measures a few choices, in turns with the baseline.
    fn batch(
        &mut self,
        (baseline, all_settings): (&Choice, &BTreeMap<String, String>),
        batch: &[Choice],
        progress: &Progress,
    ) -> Result<Vec<Row>, Error> {
        let options = ExecutorOptions { timestamps: true, ..ExecutorOptions::default() };
        let all: Vec<&Choice> = [baseline].into_iter().chain(batch).collect();
        let mut plans = Vec::with_capacity(all.len());
        for choice in &all {
            plans.push(kept(self.planned(choice, &[]))?);
        }
        let mut prepared = Vec::with_capacity(all.len());
        for (choice, planned) in all.iter().zip(&plans) {
            let ready = planned.as_ref().map_err(Clone::clone).map(|planned| {
                let (scene, size) = (&choice.scene.scene, choice.size);
                Prepared::new(&self.device, planned, &mut self.pipeline, scene, size, &options)
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
                    (settings(drawn.planned), drawn.planned.plan.stereo, outcome)
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
        let plan = &drawn.planned.plan;
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
            moved_bytes: moved_bytes(plan),
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
        };
        let Some(request) = pictures::of_first_output(drawn.planned) else { return Ok(measured) };
        let picture = request.encode(&mut drawn.executor, plan)?;
        let name = |folder: &str, ending: &str| format!("{folder}/{}.{ending}", choice.key());
        let ending = picture.path.extension().map_or("png", |ending| if ending == "exr" { "exr" } else { "png" });
        measured.picture = Some(self.written(name("pictures", ending), &picture.contents)?);
        let light = |contents: &[u8], path: &Path| {
            Light::decode(contents).map_err(|problem| Error::NoLight { path: path.to_owned(), problem })
        };
        let shown = light(&picture.contents, &picture.path)?;
        let Some((reference, file)) = self.reference(choice)? else { return Ok(measured) };
        measured.reference = file;
        if reference.picture.extent != shown.extent {
            let reference = (self.arguments.reference.clone(), reference.picture.extent);
            return Err(Error::Sizes { reference, picture: (PathBuf::from(name("pictures", ending)), shown.extent) });
        }
        let errors = Errors::between(&reference.picture, &shown, PIXELS_PER_DEGREE);
        let size = shown.extent.map(|size| u32::try_from(size).unwrap_or(u32::MAX));
        let heat_map = metric::heat_map(errors.flip_map(), size);
        let heat_map = heat_map.map_err(|problem| Error::Picture { image: "flip".to_owned(), problem })?;
        measured.heat_map = Some(self.written(name("heat_maps", "png"), &heat_map)?);
        measured.errors = Some(errors);
        measured.reference_errors = match self.arguments.reference == Path::new(AUTO) {
            true => Some(Errors::between(&reference.picture, &reference.of_half, PIXELS_PER_DEGREE)),
            false => None,
        };
        Ok(measured)
    }

    /// The picture that a choice is held against.
    fn reference(&mut self, choice: &Choice) -> Result<Option<Kept>, Error> {
        let file = self.arguments.reference.clone();
        if file == Path::new(NONE) {
            return Ok(None);
        }
        if file != Path::new(AUTO) {
            if let Some(known) = self.references.get("") {
                return Ok(known.clone());
            }
            let picture = inputs::picture(&file, &self.read)?;
            let shown = self.shown("given", &picture)?;
            let made = Some((Rc::new(Reference { of_half: picture.clone(), picture }), Some(shown)));
            self.references.insert(String::new(), made.clone());
            return Ok(made);
        }
        let more = subjects::reference_settings(&self.pipeline).unwrap_or_default();
        let planned = self.planned(choice, &more)?;
        let texts: Vec<String> = settings(&planned).into_iter().flat_map(|(name, value)| [name, value]).collect();
        let rest = [choice.scene.digest.clone(), choice.size.to_string(), format!("{:?}", choice.stereo)];
        let key = Digest::of(texts.iter().chain(&rest).map(|it| &**it));
        if let Some(known) = self.references.get(&key) {
            return Ok(known.clone());
        }
        let made = reference::draw(&self.device, &planned, &mut self.pipeline, &choice.scene.scene, choice.size)?;
        let made = match made {
            Some(reference) => {
                self.keep(&key, &reference.picture)?;
                let shown = self.shown(&key, &reference.picture)?;
                Some((Rc::new(reference), Some(shown)))
            }
            None => None,
        };
        self.references.insert(key, made.clone());
        Ok(made)
    }

    /// Writes a reference as a display shows it, and answers with its path within the folder.
    fn shown(&self, key: &str, picture: &Light) -> Result<String, Error> {
        let file = FileFormat::Png.encode(&floats(picture, &bytes(picture)));
        let file = file.map_err(|problem| Error::Picture { image: "reference".to_owned(), problem })?;
        self.written(format!("pictures/reference_{key}.png"), &file)
    }

    /// Writes a reference as OpenEXR.
    fn keep(&self, key: &str, picture: &Light) -> Result<(), Error> {
        let file = FileFormat::OpenExr.encode(&floats(picture, &bytes(picture)));
        let file = file.map_err(|problem| Error::Picture { image: "reference".to_owned(), problem })?;
        self.written(format!("pictures/reference_{key}.exr"), &file).map(drop)
    }

    /// Writes a file into the folder, and answers with its path there.
    fn written(&self, name: String, contents: &[u8]) -> Result<String, Error> {
        outputs::write(&[(&self.arguments.output.join(&name), contents)], &self.read)?;
        Ok(name)
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

/// Texels of 32-bit floating-point numbers.
fn bytes(picture: &Light) -> Vec<u8> {
    let texels = picture.texels.iter().flat_map(|[red, green, blue]| [*red, *green, *blue, 1.0]);
    texels.flat_map(f32::to_ne_bytes).collect()
}

fn floats<'t>(picture: &Light, bytes: &'t [u8]) -> Picture<'t> {
    let extent = picture.extent.map(|size| u32::try_from(size).unwrap_or(u32::MAX));
    Picture { format: Format::R32G32B32A32_SFLOAT, encoding: None, extent, bytes }
}

/// All settings of a planned frame.
fn settings(planned: &Planned) -> BTreeMap<String, String> {
    planned.plan.settings.iter().map(|used| (used.name.to_string(), used.value.clone())).collect()
}

/// A line for each row.
fn table(results: &Results) -> String {
    let mut table = comfy_table::Table::new();
    table.load_preset(comfy_table::presets::ASCII_MARKDOWN);
    table.set_header(["choice", "GPU ms", "of the baseline", "MiB", "moved MiB", "FLIP", "RMSE"]);
    let mebibytes = |bytes: u64| format!("{:.1}", bytes as f64 / f64::from(1 << 20));
    for row in &results.rows {
        let values = row.choice.iter().map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(" ");
        let choice = if values.is_empty() { "(as it is)".to_owned() } else { text::escape(&values) };
        match &row.outcome {
            Outcome::Measured(measured) => {
                let Cost { gpu_milliseconds: time, gpu_ratio: ratio, transient_bytes, moved_bytes, .. } = measured.cost;
                let figure = |figure: fn(&Errors) -> f64| {
                    measured.errors.as_ref().map_or_else(|| "-".to_owned(), |errors| format!("{:.5}", figure(errors)))
                };
                table.add_row([
                    choice,
                    format!("{:.2}", time.median),
                    format!("{:.2} ({:.2}–{:.2})", ratio.median, ratio.low, ratio.high),
                    mebibytes(transient_bytes),
                    mebibytes(moved_bytes),
                    figure(|errors| errors.flip.mean),
                    figure(|errors| errors.rmse),
                ]);
            }
            Outcome::Failed(why) => {
                let first = why.lines().next().unwrap_or_default();
                table.add_row([choice, format!("failed: {}", text::escape(first))]);
            }
        }
    }
    format!("{table}\n")
}
