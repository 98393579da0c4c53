//! Results as JSON.

use super::{FORMAT_VERSION, Results, plausible};
use serde::Deserialize;

/// A file of results that is none. Sentences go on after the file's name.
#[derive(Debug, thiserror::Error)]
pub enum ResultsProblem {
    /// Another program wrote it.
    #[error(
        "is of format version {found}, and this program reads version {FORMAT_VERSION}\nhelp: take the program that wrote it, or measure anew into another folder"
    )]
    Version {
        /// Its version.
        found: u64,
    },
    /// It is no JSON, or not that of results.
    #[error(
        "is damaged at line {line}, column {column}: {message}\nhelp: restore it, or measure anew into another folder"
    )]
    Damaged {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What is wrong there.
        message: String,
    },
    /// Its figures can't be those of a measurement.
    #[error("holds what no measurement gives: {what}\nhelp: restore it, or measure anew into another folder")]
    Impossible {
        /// The first of them.
        what: String,
    },
}

/// The only thing that all versions of the form have in common.
#[derive(Deserialize)]
struct Version {
    format_version: u64,
}

impl Results {
    /// Reads results.
    ///
    /// # Errors
    /// If they are of another version, damaged, or hold figures that no measurement gives.
    pub fn from_json(text: &str) -> Result<Results, ResultsProblem> {
        match serde_json::from_str(text) {
            Ok(Version { format_version: found }) if found != u64::from(FORMAT_VERSION) => {
                return Err(ResultsProblem::Version { found });
            }
            // What is wrong is said of the whole.
            _ => {}
        }
        let results: Results = serde_json::from_str(text).map_err(damaged)?;
        results.possible()?;
        Ok(results)
    }

    /// Makes sure that all figures are such as a measurement gives.
    ///
    /// # Errors
    /// [`ResultsProblem::Impossible`].
    pub fn possible(&self) -> Result<(), ResultsProblem> {
        plausible::problem(self).map_or(Ok(()), |what| Err(ResultsProblem::Impossible { what }))
    }
}

fn damaged(error: serde_json::Error) -> ResultsProblem {
    let (line, column) = (error.line(), error.column());
    let whole = error.to_string();
    let message = whole.strip_suffix(&format!(" at line {line} column {column}")).unwrap_or(&whole).to_owned();
    ResultsProblem::Damaged { line, column, message }
}
