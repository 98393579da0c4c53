//! Mistakes as the page shows them: each with its place, and the texts that they point into.

use super::published_state::SourceText;
use framewright_graph::base::{self, Diagnostic, SourceFile, Sources};
use serde_json::{Value, json};

/// What keeps a newer frame from being drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownMistakes {
    /// A list of them, as `check --format json` has it.
    pub mistakes: Value,
    /// The same as `check` prints them; empty if there is none.
    pub message: String,
    /// The texts that they point into.
    pub sources: Vec<SourceText>,
}

impl Default for ShownMistakes {
    /// None.
    fn default() -> ShownMistakes {
        ShownMistakes { mistakes: json!([]), message: String::new(), sources: Vec::new() }
    }
}

impl ShownMistakes {
    /// Mistakes with their places; `message` has all of them in words.
    #[must_use]
    pub fn placed(message: String, sources: &Sources, mistakes: &[Diagnostic]) -> ShownMistakes {
        ShownMistakes { mistakes: base::to_json(sources, mistakes), message, sources: texts(sources) }
    }

    /// One that has no place.
    #[must_use]
    pub fn unplaced(message: String) -> ShownMistakes {
        let mistakes = json!([{ "message": message.trim_start_matches("error: "), "help": null, "labels": [] }]);
        ShownMistakes { mistakes, message, sources: Vec::new() }
    }
}

fn texts(sources: &Sources) -> Vec<SourceText> {
    let files = (0..).map_while(|file| sources.file(file));
    let text = |file: &SourceFile| SourceText {
        name: file.relative.to_string(),
        shown: file.shown.clone(),
        text: file.text.to_string(),
    };
    files.map(text).collect()
}
