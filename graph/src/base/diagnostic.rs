//! Mistakes in a file: the message, its places, and the help.

use super::shorten::bounded;
use super::{Code, Span};
use std::ops::Range;
use std::panic::Location;

/// The largest number of mistakes that one reading or making keeps: with most files the first mistakes explain the rest.
pub(crate) const MOST_KEPT: usize = 256;

/// Adds a mistake, unless [`MOST_KEPT`] are kept already.
pub(crate) fn keep(errors: &mut Vec<Diagnostic>, mistake: Diagnostic) {
    if errors.len() < MOST_KEPT {
        errors.push(mistake);
    }
}

/// One mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// The rule that is broken. Programs tell mistakes apart by it; the message is for people.
    pub code: Code,
    /// The check that reports it, by its place in this program. What one check reports at one place is one mistake, whatever names and
    /// numbers the message has.
    pub check: Option<&'static Location<'static>>,
    /// The mistake, and what was expected, in one sentence without final stop. Not yet escaped.
    pub message: String,
    /// Where: the first is the primary place. May be empty when no file is involved.
    pub labels: Vec<Label>,
    /// Lines of other files that the mistake is about.
    pub quotes: Vec<Quote>,
    /// A way to mend the mistake.
    pub help: Option<String>,
    /// The choice outside of all files that may mend the mistake.
    pub choice: Option<OutsideChoice>,
    /// Whether nothing is wrong with the files: the machine doesn't let one be read, or lacks something.
    pub of_machine: bool,
}

/// A choice that is made when a program is run, in no file, and that may mend a mistake. Messages don't name a program's option
/// for it: a program that has one adds its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutsideChoice {
    /// The folder from which files may be read.
    Root,
    /// Extensions that are applied to a pipeline which doesn't name them.
    Extensions,
    /// The size of the output.
    OutputSize,
    /// How long compiling a stage of a shader may take.
    ShaderTime,
    /// How much memory compiling a stage of a shader may take.
    ShaderMemory,
    /// How much stack compiling a stage of a shader may take.
    ShaderStack,
    /// The command that compiles HLSL, Slang or WGSL.
    ShaderCompiler,
    /// The interfaces of the draw source.
    DrawInterfaces,
}

/// A place with a remark.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// The remark; may be empty.
    pub text: String,
    /// Whether a fragment is used there that the mistake is in.
    pub is_use: bool,
}

impl Label {
    /// A place with a remark.
    pub(crate) fn new(span: Span, text: impl Into<String>) -> Label {
        Label { span, text: short(text.into()), is_use: false }
    }

    /// The place where a fragment is used under the name `called`.
    pub(crate) fn of_use(span: Span, called: &str) -> Label {
        Label { is_use: true, ..Label::new(span, format!("used here as `{called}`")) }
    }
}

/// A line of a file that is no part of the pipeline's own text, with a remark: a complaint of a shader's compiler.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Quote {
    /// The file's name, as it is shown.
    pub file: String,
    /// The line's number, from 1.
    pub line: u32,
    /// The line.
    pub text: String,
    /// The bytes of it that the remark is about.
    pub underlined: Range<usize>,
    /// The remark; may be empty.
    pub remark: String,
}

impl Diagnostic {
    /// A mistake that stands in no file.
    #[must_use]
    #[track_caller]
    pub fn nowhere(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            code,
            check: Some(Location::caller()),
            message: short(message.into()),
            labels: Vec::new(),
            quotes: Vec::new(),
            help: None,
            choice: None,
            of_machine: false,
        }
    }

    /// A mistake at `span`.
    #[must_use]
    #[track_caller]
    pub fn new(code: Code, span: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::nowhere(code, message).at(span)
    }

    /// No `what` has this name.
    #[track_caller]
    pub(crate) fn unknown_name(code: Code, what: &str, name: &str) -> Diagnostic {
        Diagnostic::nowhere(code, format!("there is no {what} named `{name}`"))
    }

    /// With this primary place, if it has none.
    pub(crate) fn at(mut self, span: Span) -> Diagnostic {
        if self.labels.is_empty() {
            self.labels.push(Label::new(span, ""));
        }
        self
    }

    /// With a remark at the primary place.
    #[must_use]
    pub fn remark(mut self, text: impl Into<String>) -> Diagnostic {
        if let Some(label) = self.labels.first_mut() {
            label.text = short(text.into());
        }
        self
    }

    /// With another place.
    #[must_use]
    pub fn label(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label::new(span, text));
        self
    }

    /// With a choice outside of all files that may mend the mistake.
    #[must_use]
    pub fn choice(mut self, choice: OutsideChoice) -> Diagnostic {
        self.choice = Some(choice);
        self
    }

    /// With the machine to blame, and not the files.
    #[must_use]
    pub fn of_machine(self) -> Diagnostic {
        Diagnostic { of_machine: true, ..self }
    }

    /// With a way to mend the mistake.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Diagnostic {
        self.help = Some(short(text.into()));
        self
    }
}

/// A text as it is kept: its quotes from a file are bounded.
fn short(text: String) -> String {
    match bounded(&text) {
        std::borrow::Cow::Borrowed(_) => text,
        std::borrow::Cow::Owned(shorter) => shorter,
    }
}
