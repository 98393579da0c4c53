//! Results as one HTML page, which needs nothing but the pictures beside it.

use framewright_lab::results::{Outcome, Results, Row};
use framewright_viewer::html::{self, Template};
use serde::Serialize;

const TEMPLATE: Template<'_> = Template {
    page: include_str!("page/page.html"),
    style: include_str!("page/page.css"),
    script: include_str!("page/page.js"),
    // The pictures lie beside the page, wherever that is.
    images: "'self' file:",
    asked: "'none'",
};

/// The data that the script reads.
#[derive(Serialize)]
struct Data<'r> {
    results: &'r Results,
    /// The numbers of rows with pixels that aren't finite.
    not_finite: Vec<usize>,
}

/// The page.
///
/// # Errors
/// If results have no JSON form.
pub(super) fn page(results: &Results) -> serde_json::Result<String> {
    let lacks = |row: &Row| matches!(&row.outcome, Outcome::Measured(measured) if !measured.is_finite());
    let not_finite = results.rows.iter().zip(0..).filter(|(row, _)| lacks(row)).map(|(_, at)| at).collect();
    html::page(&TEMPLATE, &Data { results, not_finite })
}
