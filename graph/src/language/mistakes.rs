//! Mistakes of a whole pipeline: in the order of its files, and never none.

use crate::base::{Code, Diagnostic};

/// The first mistakes first: file by file as they were read, in each from top to bottom.
pub(crate) fn in_order(mut errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    errors.sort_by_key(|error| error.labels.first().map_or((None, 0), |label| (label.span.file(), label.span.start)));
    errors
}

/// The mistakes, or one that says that none was reported although the pipeline is wrong.
pub(crate) fn never_none(mut errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    if errors.is_empty() {
        let message = "this pipeline can't be put together, and why was not found out: a mistake of framewright itself";
        errors.push(Diagnostic::nowhere(Code::OWN_MISTAKE, message));
    }
    errors
}
