//! Results as one HTML page, which needs nothing but the pictures beside it.

use super::results::Results;

/// The page around the results. Its script makes elements, never HTML of text from files.
const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = include_str!("page/page.js");

/// The page.
///
/// # Errors
/// If results have no JSON form.
pub(super) fn page(results: &Results) -> serde_json::Result<String> {
    // A text that ends the element can't be in it.
    let data = serde_json::to_string(results)?.replace('<', "\\u003c");
    let parts = [("/*style*/", STYLE), ("/*script*/", SCRIPT), ("/*data*/", &data)];
    // The data comes last: it may hold anything.
    Ok(parts.into_iter().fold(PAGE.to_owned(), |page, (mark, part)| page.replacen(mark, part, 1)))
}
