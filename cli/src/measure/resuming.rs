//! A sweep goes on where it stopped: what is measured already stays, and each batch is written as soon as it is done.

use super::held_against::{AUTO, GIVEN, Given, LINES_EVERY};
use super::references::{Reference, References};
use super::results::{FORMAT_VERSION, Outcome, Results, Row, Subject};
use super::run::{AT_ONCE, Bench, WARM_UP, settings};
use super::subjects::{self, Choice};
use super::table::table;
use super::{checks, joining, pipeline_digest, store, sweep};
use crate::command_line::measuring::MeasureArguments;
use crate::error::Error;
use crate::files::{inputs, outputs};
use crate::planning::{self, device, helper};
use crate::system::counted::{Progress, Words};
use crate::system::{Exit, interrupt, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::vulkan::Rotation;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;
use std::time::{Duration, Instant};

/// How often files for people are made anew while a sweep goes on. Of many rows they take longer than a batch.
const VIEWS_EVERY: Duration = Duration::from_secs(60);

/// Measures a sweep.
///
/// # Errors
/// If a file or the sweep is wrong, the device is missing, or something can't be written. A choice that can't be drawn is a row.
pub(crate) fn measure(arguments: &MeasureArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    inputs::expect(&arguments.pipeline, &read);
    let chosen = device::to_draw_on(arguments.device.name.as_deref())?;
    let helper = helper::of(&arguments.pipeline)?;
    let mut pipeline = planning::load_with(&arguments.pipeline, &read, helper.clone())?;
    let of_all = planning::choices(&arguments.pipeline, arguments.size, Rotation::Identity);
    let (baseline, choices) = subjects::choices(arguments, &pipeline, &read)?;
    if arguments.reference == Path::new(AUTO) && subjects::reference_settings(&pipeline).is_none() {
        let what = format!(
            "the pipeline has no preset `{}` to make the reference by: name a picture by --reference, or `none`",
            subjects::REFERENCE
        );
        return Err(Error::Sweep { what });
    }
    checks::values(&pipeline, &of_all, &choices)?;
    let given = Given::of(arguments, &read, |extent| {
        checks::sizes((&arguments.reference, extent), (&mut pipeline, &of_all), &baseline, &choices)
    })?;
    if arguments.flicker.is_some() && !matches!(given, Given::Auto) {
        let what =
            "flicker is measured against references of each frame: leave out --reference or --flicker".to_owned();
        return Err(Error::Sweep { what });
    }
    outputs::make_folder(&arguments.output)?;
    let _held = store::hold(&arguments.output)?;
    interrupt::watch();
    let device = device::open(chosen, false, &helper)?;
    let mut references = References::of(arguments.output.clone());
    if let Given::Picture(picture) = &given {
        references.remember(GIVEN, Reference { picture: picture.clone(), errors: None });
    }
    let pipeline_digest = pipeline_digest::of(&pipeline);
    let mut bench =
        Bench { arguments, pipeline, of_all, device, read, pipeline_digest, given, references, told_of_light: false };
    let mut results = bench.begun(&baseline)?;
    let choices = sweep::shard(choices, arguments.shard.number, arguments.shard.of);
    let ended = bench.missing(&baseline, &choices, &mut results);
    // What was measured before an error is shown too.
    store::write(&arguments.output, &results)?;
    store::write_views(&arguments.output, &results)?;
    ended?;
    text::print(&table(&results)).map_err(Error::Print)?;
    let any = results.rows.is_empty() || results.rows.iter().any(|row| matches!(row.outcome, Outcome::Measured(_)));
    Ok(if any { Exit::Fine } else { Exit::Found })
}

/// What a choice and its row are found by.
type Key<'k> = (&'k BTreeMap<String, String>, &'k str, [u32; 2]);

fn of_row(row: &Row) -> Key<'_> {
    (&row.choice, &row.scene_digest, row.size)
}

fn of_choice(choice: &Choice) -> Key<'_> {
    (&choice.values, &choice.scene.digest, choice.size)
}

impl Bench<'_> {
    /// Measures the choices that have no figures yet.
    fn missing(&mut self, baseline: &Choice, choices: &[Choice], results: &mut Results) -> Result<(), Error> {
        let places: HashMap<Key<'_>, usize> = choices.iter().map(of_choice).zip(0..).collect();
        // One that failed is tried again: the reason may have been the machine's.
        let measured = results.rows.iter().filter(|row| matches!(row.outcome, Outcome::Measured(_)));
        let there: HashSet<Key<'_>> = measured.map(of_row).collect();
        let missing: Vec<Choice> =
            choices.iter().filter(|choice| !there.contains(&of_choice(choice))).cloned().collect();
        drop(there);
        if missing.len() < choices.len() {
            let there = text::count(choices.len() - missing.len(), "choice is", "choices are");
            text::say(&format!("note: {there} measured already"));
        }
        self.draw_references(&missing).map_err(|error| match interrupt::asked() {
            true => Error::InterruptedMeasuring { measured: results.rows.len(), wanted: choices.len() },
            false => error,
        })?;
        let words = Words { doing: "measuring", done: "measured", things: "choices" };
        let steps = (WARM_UP + self.arguments.frames) as usize;
        let progress = Progress::new(missing.len(), steps, words, LINES_EVERY);
        let folder = &self.arguments.output;
        let mut shown = Instant::now();
        for batch in missing.chunks(AT_ONCE) {
            let mut rows = Vec::with_capacity(batch.len());
            let ended = self.batch((baseline, &results.subject.baseline), batch, &progress, &mut rows);
            // Rows that were finished before an error stay.
            let anew: HashSet<Key<'_>> = rows.iter().map(of_row).collect();
            results.rows.retain(|row| !anew.contains(&of_row(row)));
            results.rows.extend(rows.iter().cloned());
            results.rows.sort_by_cached_key(|row| places.get(&of_row(row)).copied());
            ended.map_err(|error| match interrupt::asked() {
                true => Error::InterruptedMeasuring { measured: results.rows.len(), wanted: choices.len() },
                false => error,
            })?;
            store::write(folder, results)?;
            if shown.elapsed() >= VIEWS_EVERY {
                store::write_views(folder, results)?;
                shown = Instant::now();
            }
        }
        progress.finish();
        Ok(())
    }

    /// The results that the folder holds already, or none yet.
    fn begun(&mut self, baseline: &Choice) -> Result<Results, Error> {
        let planned = self.planned(baseline, &baseline.scene.scene, &[])?;
        let mut of_baseline = settings(&planned.plan);
        of_baseline.extend([
            (subjects::SCENE.to_owned(), baseline.scene.digest.clone()),
            (subjects::SIZE.to_owned(), subjects::size_name(baseline.size)),
            (subjects::STEREO.to_owned(), planned.plan.stereo.name().to_owned()),
        ]);
        let subject = Subject {
            framewright: env!("CARGO_PKG_VERSION").to_owned(),
            shipped_shaders: pipeline_digest::of_shipped_shaders(),
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
        match joining::difference(&results.subject, &subject) {
            None => Ok(results),
            Some((field, values)) => Err(Error::OtherSweep { folder: folder.clone(), field, values: Box::new(values) }),
        }
    }
}
