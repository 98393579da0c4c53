//! The places that name files: a mistake in a file that was included shows both places.

use crate::base::{Diagnostic, FilePath, Label, Sources, Span};

/// A longer way to a file is not shown whole.
const MOST_SHOWN: usize = 10;

/// Files that others name, by number, and where.
#[derive(Debug, Clone, Default)]
pub(crate) struct Origins(Vec<(u32, Origin)>);

/// The place that names a file, and the words for it.
#[derive(Debug, Clone, Copy)]
struct Origin {
    span: Span,
    words: &'static str,
}

impl Origins {
    /// The file numbered `file` is named at `span`; `words` name the purpose: "included here".
    pub(crate) fn add(&mut self, file: u32, span: Span, words: &'static str) {
        if span.file().is_some() {
            self.0.push((file, Origin { span, words }));
        }
    }

    fn of(&self, file: usize) -> Option<Origin> {
        self.0.iter().find(|(named, _)| *named as usize == file).map(|(_, origin)| *origin)
    }

    /// Adds to each mistake how its file came in, as far as it doesn't show that already.
    pub(crate) fn tell(&self, errors: &mut [Diagnostic]) {
        for error in errors {
            let mut file = error.labels.first().and_then(|label| label.span.file());
            for _ in 0..MOST_SHOWN {
                let Some(origin) = file.and_then(|file| self.of(file)) else { break };
                file = origin.span.file();
                if error.labels.iter().any(|label| label.span.file() == file) {
                    break;
                }
                error.labels.push(Label::new(origin.span, origin.words));
            }
        }
    }
}

/// Lets mistakes that come to light in a shipped file begin with the place in the user's own file that led there: only that
/// can be mended.
pub(crate) fn users_first(sources: &Sources, errors: &mut [Diagnostic]) {
    let shipped = |label: &Label| {
        let file = label.span.file().and_then(|file| sources.file(file));
        file.is_some_and(|file| matches!(FilePath::of_text(&file.relative), FilePath::Shipped(_)))
    };
    for error in errors.iter_mut().filter(|error| error.labels.first().is_some_and(shipped)) {
        let used = |label: &Label| !shipped(label) && label.is_use;
        let own = error.labels.iter().position(used);
        let Some(own) = own.or_else(|| error.labels.iter().position(|label| !shipped(label))) else { continue };
        if error.labels[0].text.is_empty() {
            "comes to light here".clone_into(&mut error.labels[0].text);
        }
        error.labels[..=own].rotate_right(1);
    }
}
