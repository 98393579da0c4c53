//! Pages of one file: a template with its style, its script and its data.
//!
//! Data is JSON that the script reads. The script makes elements and sets their text: nothing from a file becomes HTML. A
//! content-security policy names the style and the script by their digests, so that nothing else can act.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use serde::Serialize;
use sha2::{Digest, Sha256};

/// What all pages look like: colours, type and controls. A page's own style comes after it.
const LOOK: &str = include_str!("look.css");

/// The parts of a page.
pub struct Template<'t> {
    /// The page, with `/*policy*/`, `/*style*/`, `/*script*/` and `/*data*/` where those belong.
    pub page: &'t str,
    /// What its style has of its own.
    pub style: &'t str,
    /// The script.
    pub script: &'t str,
    /// Where images may come from, as the policy writes it.
    pub images: &'t str,
    /// Where the script may ask for more, as the policy writes it.
    pub asked: &'t str,
}

/// The page around `data`.
///
/// # Errors
/// If the data has no JSON form.
pub fn page(template: &Template<'_>, data: &impl Serialize) -> serde_json::Result<String> {
    page_allowing(template, ["", ""], data)
}

/// The page around `data`, whose script runs WebAssembly that the data holds, in workers of its own.
///
/// # Errors
/// If the data has no JSON form.
pub(crate) fn page_of_modules(template: &Template<'_>, data: &impl Serialize) -> serde_json::Result<String> {
    page_allowing(template, [" 'wasm-unsafe-eval'", "; worker-src blob:"], data)
}

/// The page around `data`. `more`: what the policy allows further, of scripts and in directives of its own.
fn page_allowing(template: &Template<'_>, more: [&str; 2], data: &impl Serialize) -> serde_json::Result<String> {
    // A text that ends the element can't be in it.
    let data = serde_json::to_string(data)?.replace('<', "\\u003c");
    let style = [LOOK, template.style].concat();
    let digest = |text: &str| BASE64_STANDARD.encode(Sha256::digest(text.as_bytes()));
    let policy = format!(
        "default-src 'none'; script-src 'sha256-{}'{}; style-src 'sha256-{}'; img-src {}; connect-src {}; base-uri 'none'; \
         form-action 'none'{}",
        digest(template.script),
        more[0],
        digest(&style),
        template.images,
        template.asked,
        more[1]
    );
    let parts =
        [("/*policy*/", &*policy), ("/*style*/", &*style), ("/*script*/", template.script), ("/*data*/", &data)];
    // The data comes last: it may hold anything.
    Ok(parts.into_iter().fold(template.page.to_owned(), |page, (mark, part)| page.replacen(mark, part, 1)))
}
