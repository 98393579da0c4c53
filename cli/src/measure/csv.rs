//! Results as a table of comma-separated values (RFC 4180): a row a line.

use crate::error::Error;
use framewright_lab::metric::{Errors, Flicker};
use framewright_lab::results::{Cost, Outcome, Results, Row, RowFigures, Spread};

/// The columns after the swept settings.
const FIGURES: [&str; 33] = [
    "gpu_ms",
    "gpu_ms_low",
    "gpu_ms_high",
    "gpu_ratio",
    "gpu_ratio_low",
    "gpu_ratio_high",
    "recording_ms",
    "recording_ms_low",
    "recording_ms_high",
    "transient_bytes",
    "moved_bytes",
    "fragment_invocations",
    "flip",
    "flip_95",
    "flip_worst",
    "rmse",
    "max_error",
    "relative_mse",
    "psnr",
    "ssim",
    "non_finite_reference",
    "non_finite_picture",
    "reference_flip",
    "reference_rmse",
    "flicker",
    "flicker_95",
    "flicker_worst",
    "flicker_non_finite",
    "picture",
    "reference",
    "heat_map",
    "flicker_map",
    "error",
];

/// The table. Figures that a row lacks are empty; so is the `psnr` of a picture without a difference.
///
/// # Errors
/// If the table can't be encoded.
pub(super) fn table(results: &Results) -> Result<String, Error> {
    let mut writer = csv::WriterBuilder::new().terminator(csv::Terminator::CRLF).from_writer(Vec::new());
    let swept = results.swept();
    // The dot is no part of a setting's name: no column is there twice.
    let settings = swept.iter().map(|name| format!("set.{name}"));
    let columns = ["scene", "width", "height", "stereo"].map(str::to_owned).into_iter().chain(settings);
    writer.write_record(columns.chain(FIGURES.map(str::to_owned)))?;
    for row in &results.rows {
        let settings = swept.iter().map(|name| row.settings.get(*name).or(row.choice.get(*name)).cloned());
        let [width, height] = row.size.map(|side| side.to_string());
        let surroundings = [row.scene.clone(), width, height, row.stereo.clone()].map(Some);
        let all = surroundings.into_iter().chain(settings).chain(figures(row));
        writer.write_record(all.map(|cell| inert(cell.unwrap_or_default())))?;
    }
    let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A cell that no spreadsheet takes for a formula: a `'` stands before what would begin one. Numbers stay as they are.
fn inert(cell: String) -> String {
    let begins_formula = cell.starts_with(['=', '+', '-', '@', '\t', '\r']) && cell.parse::<f64>().is_err();
    if begins_formula { format!("'{cell}") } else { cell }
}

/// In the order of [`FIGURES`].
fn figures(row: &Row) -> [Option<String>; FIGURES.len()] {
    let (measured, failure) = match &row.outcome {
        Outcome::Measured(measured) => (Some(&**measured), None),
        Outcome::Failed(failure) => (None, Some(failure.clone())),
    };
    let errors = |number: fn(&Errors) -> Option<f64>| {
        measured.and_then(|it| it.errors.as_ref()).and_then(number).map(|number| number.to_string())
    };
    let count = |at: usize| measured.and_then(|it| it.errors.as_ref()).map(|errors| errors.non_finite[at].to_string());
    let reference = |number: fn(&Errors) -> f64| {
        measured.and_then(|it| it.reference_errors.as_ref()).map(|errors| number(errors).to_string())
    };
    let flicker = |figure: fn(&Flicker) -> String| measured.and_then(|it| it.flicker.as_ref()).map(figure);
    let cost = |number: fn(&Cost) -> Option<u64>| measured.and_then(|it| number(&it.cost)).map(|it| it.to_string());
    let path = |path: fn(&RowFigures) -> &Option<String>| measured.and_then(|it| path(it).clone());
    let spread = |spread: fn(&Cost) -> Option<Spread>| {
        let figures = |Spread { median, low, high }: Spread| [median, low, high].map(|number| Some(number.to_string()));
        measured.and_then(|it| spread(&it.cost)).map_or([None, None, None], figures)
    };
    let [gpu, gpu_low, gpu_high] = spread(|cost| cost.gpu_milliseconds);
    let [ratio, ratio_low, ratio_high] = spread(|cost| cost.gpu_ratio);
    let [recording, recording_low, recording_high] = spread(|cost| Some(cost.recording_milliseconds));
    [
        gpu,
        gpu_low,
        gpu_high,
        ratio,
        ratio_low,
        ratio_high,
        recording,
        recording_low,
        recording_high,
        cost(|cost| Some(cost.transient_bytes)),
        cost(|cost| Some(cost.moved_bytes)),
        cost(|cost| cost.fragment_invocations),
        errors(|errors| Some(errors.flip.mean)),
        errors(|errors| Some(errors.flip.percentile_95)),
        errors(|errors| Some(errors.flip.worst)),
        errors(|errors| Some(errors.rmse)),
        errors(|errors| Some(errors.max_error)),
        errors(|errors| Some(errors.relative_mse)),
        errors(|errors| errors.psnr),
        errors(|errors| Some(errors.ssim)),
        count(0),
        count(1),
        reference(|errors| errors.flip.mean),
        reference(|errors| errors.rmse),
        flicker(|flicker| flicker.mean.to_string()),
        flicker(|flicker| flicker.percentile_95.to_string()),
        flicker(|flicker| flicker.worst.to_string()),
        flicker(|flicker| flicker.non_finite.to_string()),
        path(|measured| &measured.picture),
        path(|measured| &measured.reference),
        path(|measured| &measured.heat_map),
        path(|measured| &measured.flicker_map),
        failure,
    ]
}
