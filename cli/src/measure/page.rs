//! Results as one HTML page, which needs nothing but the pictures beside it.

use super::results::Results;
use crate::system::html::{self, Template};

const TEMPLATE: Template<'_> = Template {
    page: include_str!("page/page.html"),
    style: include_str!("page/page.css"),
    script: include_str!("page/page.js"),
    // The pictures lie beside the page, wherever that is.
    images: "'self' file:",
    asked: "'none'",
};

/// The page.
///
/// # Errors
/// If results have no JSON form.
pub(super) fn page(results: &Results) -> serde_json::Result<String> {
    html::page(&TEMPLATE, results)
}
