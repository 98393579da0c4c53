//! `framewright compare`: the errors of a picture beside a reference.

use crate::command_line::comparing::CompareArguments;
use crate::command_line::values::AnswerFormat;
use crate::error::Error;
use crate::files::{inputs, outputs};
use crate::system::{Exit, progress, text};
use framewright_graph::base::ReadFiles;
use framewright_lab::Error as LabError;
use framewright_lab::metric::{self, Errors, Metric};
use framewright_lab::picture::Light;
use serde::Serialize;

#[derive(Debug, Serialize)]
struct Answer<'a> {
    format_version: u32,
    reference: String,
    picture: String,
    size: [usize; 2],
    errors: &'a Errors,
    limits: Vec<Limit>,
    held: bool,
}

/// A limit that the command line states.
#[derive(Debug, Serialize)]
struct Limit {
    metric: &'static str,
    limit: f64,
    held: bool,
}

/// Prints a picture's errors, and holds them against the limits.
///
/// # Errors
/// If a file is no picture, their sizes differ, or the heat map can't be written.
pub(crate) fn compare(arguments: &CompareArguments) -> Result<Exit, Error> {
    let read = ReadFiles::default();
    let heat_map = arguments.heatmap.as_deref();
    outputs::prepare(heat_map.into_iter(), &read)?;
    let reference = inputs::picture(&arguments.reference, &read)?;
    let test = inputs::picture(&arguments.picture, &read)?;
    let differ = |reference: [usize; 2], picture: [usize; 2]| LabError::Sizes {
        reference: (arguments.reference.clone(), reference),
        picture: (arguments.picture.clone(), picture),
    };
    // Before anything is decoded: a few bytes may stand for any size.
    if reference.extent != test.extent {
        return Err(differ(reference.extent, test.extent).into());
    }
    let (reference, test) = (reference.decoded()?, test.decoded()?);
    for (path, picture) in [(&arguments.reference, &reference), (&arguments.picture, &test)] {
        if !picture.left_out.is_empty() {
            let what = text::escape(&picture.left_out.join(", "));
            text::say(&format!("note: not compared of `{}`: {what}", text::path(path)));
        }
    }
    let busy = progress::busy("comparing");
    let errors = Errors::between(&reference, &test, arguments.pixels_per_degree);
    drop(busy);
    let errors = errors.ok_or_else(|| differ(reference.extent, test.extent))?;
    if errors.of_nothing {
        let (reference, picture) = (arguments.reference.clone(), arguments.picture.clone());
        return Err(LabError::NothingFinite { reference, picture }.into());
    }
    if let Some(file) = heat_map {
        let size = reference.extent.map(|size| u32::try_from(size).unwrap_or(u32::MAX));
        let picture = metric::heat_map(errors.flip_map(), size);
        let picture = picture.map_err(|problem| LabError::Picture { image: "flip".to_owned(), problem })?;
        outputs::write(&[(file, &picture)], &read)?;
    }
    let limits: Vec<Limit> = Metric::ALL.iter().filter_map(|metric| limit(arguments, &errors, *metric)).collect();
    let held = limits.iter().all(|limit| limit.held);
    let shown = match arguments.format {
        AnswerFormat::Human => table(arguments, &reference, &errors),
        AnswerFormat::Json => text::json(&Answer {
            format_version: 1,
            reference: arguments.reference.to_string_lossy().into_owned(),
            picture: arguments.picture.to_string_lossy().into_owned(),
            size: reference.extent,
            errors: &errors,
            limits,
            held,
        })?,
    };
    text::print(&shown).map_err(Error::Print)?;
    Ok(if held { Exit::Fine } else { Exit::Found })
}

/// The limit that is stated for a metric, and whether it is held. Beside pixels that aren't finite none is.
fn limit(arguments: &CompareArguments, errors: &Errors, metric: Metric) -> Option<Limit> {
    let limit = arguments.limits.of(metric)?;
    let figure = errors.of(metric);
    let is_within = if metric.is_likeness() { figure >= limit } else { figure <= limit };
    let held = is_within && errors.non_finite == [0, 0];
    Some(Limit { metric: metric.name(), limit, held })
}

/// A line for each metric, and one if pixels aren't finite.
fn table(arguments: &CompareArguments, reference: &Light, errors: &Errors) -> String {
    let wanted = |metric: &&Metric| {
        let is_limited = arguments.limits.of(**metric).is_some();
        arguments.metric.is_empty() || is_limited || arguments.metric.contains(metric)
    };
    let [before, after] = errors.non_finite;
    let is_finite = [before, after] == [0, 0];
    let line = |metric: &Metric| {
        let limit = limit(arguments, errors, *metric).map_or_else(String::new, |limit| {
            let (kind, beyond) = if metric.is_likeness() { ("least", "missed") } else { ("most", "exceeded") };
            let verdict = match limit.held {
                true => "held",
                false if is_finite => beyond,
                false => "not held",
            };
            format!("  ({kind} {}: {verdict})", limit.limit)
        });
        format!("{:<14}{}{limit}\n", metric.name(), figure(*metric, errors))
    };
    let mut lines: String = Metric::ALL.iter().filter(wanted).map(line).collect();
    if !is_finite {
        let pixels = reference.texels.len();
        lines += &format!(
            "not finite    {before} of {pixels} pixels in the reference, {after} in the picture; they are no part of the figures, and no limit is held\n"
        );
    }
    lines
}

/// A metric's figure in words.
fn figure(metric: Metric, errors: &Errors) -> String {
    match metric {
        Metric::Flip => {
            let flip = &errors.flip;
            let exposures = flip.exposures.map_or_else(String::new, |exposures| {
                let count = text::count(exposures.count as usize, "exposure", "exposures");
                format!("; HDR, {count} from {:.2} to {:.2} stops", exposures.first, exposures.last)
            });
            format!(
                "{:.6}, at most {:.6} at 95 of 100 pixels, {:.6} at the worst{exposures}",
                flip.mean, flip.percentile_95, flip.worst
            )
        }
        Metric::Psnr => errors.psnr.map_or_else(|| "no difference".to_owned(), |ratio| format!("{ratio:.4} dB")),
        Metric::Ssim => format!("{:.6}", errors.ssim),
        // Light has no upper end.
        Metric::Rmse | Metric::MaxError | Metric::RelativeMse => {
            let figure = errors.of(metric);
            if figure == 0.0 || (1e-4..1e6).contains(&figure) {
                format!("{figure:.6}")
            } else {
                format!("{figure:.4e}")
            }
        }
    }
}
