//! A sweep goes on where it stopped: what is measured already stays, and each batch is written as soon as it is done.

use super::program::Folder;
use super::table::table;
use super::{store, subjects};
use crate::command_line::measuring::MeasureArguments;
use crate::error::Error;
use crate::files::{inputs, outputs};
use crate::planning::{self, device, helper};
use crate::system::counted_work::{Progress, Words};
use crate::system::{Exit, interrupt, text};
use framewright_graph::base::ReadFiles;
use framewright_graph::vulkan::Rotation;
use framewright_lab::Error as LabError;
use framewright_lab::bench::{
    AT_ONCE, BatchProgress, Bench, BenchOptions, Choice, ErrorBaseline, REFERENCE, WARM_UP, check_sizes, check_values,
    reference_settings,
};
use framewright_lab::results::{FORMAT_VERSION, Outcome, Results, Row, Subject, difference};
use framewright_lab::sweep;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;
use std::time::{Duration, Instant};

/// How often files for people are made anew while a sweep goes on. With many rows they take longer than a batch.
const VIEWS_EVERY: Duration = Duration::from_secs(60);
/// How often a line says how far the work is, where there is no terminal.
const LINES_EVERY: Duration = Duration::from_secs(60);

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
    if arguments.reference == Path::new(ErrorBaseline::AUTO) && reference_settings(&pipeline).is_none() {
        let what = format!(
            "the pipeline has no preset `{REFERENCE}` to make the reference by: name a picture by --reference, or `none`"
        );
        return Err(LabError::Sweep { what }.into());
    }
    check_values(&pipeline, &of_all, &choices)?;
    let held_against = match arguments.reference.to_str() {
        Some(ErrorBaseline::AUTO) => ErrorBaseline::References,
        Some(ErrorBaseline::NONE) => ErrorBaseline::Nothing,
        _ => {
            let file = &arguments.reference;
            let picture = inputs::picture(file, &read)?;
            // Before it is decoded: a few bytes may stand for any size.
            check_sizes((file, picture.extent), (&mut pipeline, &of_all), &baseline, &choices)?;
            ErrorBaseline::Picture { file: file.clone(), picture: picture.decoded()? }
        }
    };
    if arguments.flicker.is_some() && !matches!(held_against, ErrorBaseline::References) {
        let what =
            "flicker is measured against references of each frame: leave out --reference or --flicker".to_owned();
        return Err(LabError::Sweep { what }.into());
    }
    outputs::make_folder(&arguments.output)?;
    let _held = store::hold(&arguments.output)?;
    interrupt::watch();
    let device = device::open(chosen, false, &helper)?;
    let folder = Folder { path: &arguments.output, read: &read };
    let mut options = BenchOptions::default();
    (options.frames, options.flicker, options.held_against) = (arguments.frames, arguments.flicker, held_against);
    let mut bench = Bench::new(&device, pipeline, of_all, options, &folder)?;
    let subject = bench.subject(arguments.pipeline.file.to_string_lossy().into_owned(), &baseline)?;
    let results = begun(&arguments.output, subject, &read)?;
    let choices = sweep::shard(choices, arguments.shard.number, arguments.shard.of);
    let mut sweep = Sweep { arguments, bench, baseline, choices, results };
    let ended = sweep.measure_missing();
    // What was measured before an error is shown too.
    let results = sweep.results;
    store::write(&arguments.output, &results)?;
    store::write_views(&arguments.output, &results)?;
    ended?;
    text::print(&table(&results)).map_err(Error::Print)?;
    let any = results.rows.is_empty() || results.rows.iter().any(|row| matches!(row.outcome, Outcome::Measured(_)));
    Ok(if any { Exit::Fine } else { Exit::Found })
}

/// The results that a folder holds already, or none yet.
fn begun(folder: &Path, subject: Subject, read: &ReadFiles) -> Result<Results, Error> {
    for within in ["pictures", "heat_maps"] {
        outputs::make_folder(&folder.join(within))?;
    }
    if !folder.join(store::FILE).exists() {
        return Ok(Results { format_version: FORMAT_VERSION, subject, rows: Vec::new() });
    }
    let results = store::read(folder, read)?;
    match difference(&results.subject, &subject) {
        None => Ok(results),
        Some((field, values)) => Err(Error::OtherSweep { folder: folder.to_owned(), field, values: Box::new(values) }),
    }
}

/// What a choice and its row are found by.
type Key<'k> = (&'k BTreeMap<String, String>, &'k str, [u32; 2]);

fn of_row(row: &Row) -> Key<'_> {
    (&row.choice, &row.scene_digest, row.size)
}

fn of_choice(choice: &Choice) -> Key<'_> {
    (&choice.values, &choice.scene.digest, choice.size)
}

/// A sweep that goes on.
struct Sweep<'a> {
    arguments: &'a MeasureArguments,
    bench: Bench<'a>,
    baseline: Choice,
    choices: Vec<Choice>,
    results: Results,
}

impl Sweep<'_> {
    /// Measures the choices that have no figures yet.
    fn measure_missing(&mut self) -> Result<(), Error> {
        // One that failed is tried again: the reason may have been the machine's.
        let measured = self.results.rows.iter().filter(|row| matches!(row.outcome, Outcome::Measured(_)));
        let there: HashSet<Key<'_>> = measured.map(of_row).collect();
        let missing = self.choices.iter().filter(|choice| !there.contains(&of_choice(choice)));
        let missing: Vec<Choice> = missing.cloned().collect();
        drop(there);
        if missing.len() < self.choices.len() {
            let there = text::count(self.choices.len() - missing.len(), "choice is", "choices are");
            text::say(&format!("note: {there} measured already"));
        }
        let ended = self.draw_references(&missing);
        self.stopped(ended)?;
        let words = Words { doing: "measuring", done: "measured", things: "choices" };
        let steps = (WARM_UP + self.arguments.frames) as usize;
        let progress = Progress::new(missing.len(), steps, words, LINES_EVERY);
        let folder = &self.arguments.output;
        let mut shown = Instant::now();
        for batch in missing.chunks(AT_ONCE) {
            let mut rows = Vec::with_capacity(batch.len());
            let of_subject = (&self.baseline, &self.results.subject);
            let told = |drawn| match drawn {
                BatchProgress::Frame => progress.step(),
                BatchProgress::Choice => progress.done_one(),
            };
            let ended = self.bench.batch(of_subject, batch, &told, &mut rows).map_err(Error::from);
            // Rows that were finished before an error stay.
            self.add(rows);
            self.stopped(ended)?;
            store::write(folder, &self.results)?;
            if shown.elapsed() >= VIEWS_EVERY {
                store::write_views(folder, &self.results)?;
                shown = Instant::now();
            }
        }
        progress.finish();
        Ok(())
    }

    /// Adds rows, each in the place of an earlier one of its choice, and keeps the order of the choices.
    fn add(&mut self, rows: Vec<Row>) {
        let places: HashMap<Key<'_>, usize> = self.choices.iter().map(of_choice).zip(0..).collect();
        let anew: HashSet<Key<'_>> = rows.iter().map(of_row).collect();
        self.results.rows.retain(|row| !anew.contains(&of_row(row)));
        drop(anew);
        self.results.rows.extend(rows);
        self.results.rows.sort_by_cached_key(|row| places.get(&of_row(row)).copied());
    }

    /// An error after Ctrl-C says how much is measured.
    fn stopped(&self, result: Result<(), Error>) -> Result<(), Error> {
        let (measured, wanted) = (self.results.rows.len(), self.choices.len());
        result.map_err(|error| match interrupt::asked() {
            true => Error::InterruptedMeasuring { measured, wanted },
            false => error,
        })
    }

    /// Draws the references that choices need and that the folder doesn't hold: then it is known how far the work is.
    fn draw_references(&mut self, choices: &[Choice]) -> Result<(), Error> {
        if self.arguments.reference != Path::new(ErrorBaseline::AUTO) {
            return Ok(());
        }
        let mut known = HashSet::new();
        let mut wanted = Vec::new();
        let words = Words { doing: "planning", done: "planned", things: "choices" };
        let progress = Progress::new(choices.len(), 0, words, LINES_EVERY);
        for choice in choices {
            for frame in 0..self.arguments.flicker.unwrap_or(1) {
                if self.bench.missing_reference(choice, frame)?.is_some_and(|key| known.insert(key)) {
                    wanted.push((choice, frame));
                }
            }
            progress.done_one();
        }
        progress.finish();
        let words = Words { doing: "drawing", done: "drew", things: "references" };
        let progress = Progress::new(wanted.len(), 0, words, LINES_EVERY);
        for (choice, frame) in wanted {
            self.bench.draw_reference(choice, frame, &|done, of| progress.within(done, of))?;
            progress.done_one();
        }
        progress.finish();
        Ok(())
    }
}
