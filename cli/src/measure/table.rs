//! Results as a table for people, a line for each row.

use crate::system::text::cell;
use framewright_lab::metric::Errors;
use framewright_lab::results::{Cost, Outcome, Results};

/// The table.
#[must_use]
pub(super) fn table(results: &Results) -> String {
    let mut table = comfy_table::Table::new();
    table.load_preset(comfy_table::presets::ASCII_MARKDOWN);
    table.set_header(["choice", "GPU ms", "of the baseline", "MiB", "moved MiB", "FLIP", "RMSE"]);
    let mebibytes = |bytes: u64| format!("{:.1}", bytes as f64 / f64::from(1 << 20));
    for row in &results.rows {
        let values = row.choice.iter().map(|(name, value)| format!("{name}={value}")).collect::<Vec<_>>().join(" ");
        let choice = if values.is_empty() { "(as it is)".to_owned() } else { cell(&values) };
        match &row.outcome {
            Outcome::Measured(measured) => {
                let Cost { gpu_milliseconds: time, gpu_ratio: ratio, transient_bytes, moved_bytes, .. } = measured.cost;
                let figure = |figure: fn(&Errors) -> f64| {
                    measured.errors.as_ref().map_or_else(|| "-".to_owned(), |errors| format!("{:.5}", figure(errors)))
                };
                table.add_row([
                    choice,
                    time.map_or_else(|| "-".to_owned(), |time| format!("{:.2}", time.median)),
                    ratio.map_or_else(
                        || "-".to_owned(),
                        |it| format!("{:.2} ({:.2}–{:.2})", it.median, it.low, it.high),
                    ),
                    mebibytes(transient_bytes),
                    mebibytes(moved_bytes),
                    figure(|errors| errors.flip.mean),
                    figure(|errors| errors.rmse),
                ]);
            }
            Outcome::Failed(why) => {
                let first = why.lines().next().unwrap_or_default();
                table.add_row([choice, format!("failed: {}", cell(first))]);
            }
        }
    }
    format!("{table}\n")
}
