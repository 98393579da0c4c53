//! Everything that can go wrong between a pipeline file and a frame, as data.

use framewright_graph::base::{self, Diagnostic, NoText, Sources, amount, escape};
use framewright_graph::verify::Violation;
use framewright_passes::scene::SceneError;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// An error of this crate. Its text shows mistakes in files with their lines; [`Error::diagnostics`] has them as data. `{:?}` is the same
/// text, which a `main` that returns an error prints.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file is missing, and nothing shipped has its name.
    #[error("there is no {what} `{}`, and none of that name is shipped (shipped: {})", shown(path), shipped.join(", "))]
    Missing {
        /// The kind of file.
        what: &'static str,
        /// The name that was asked for.
        path: PathBuf,
        /// The names of those that are shipped.
        shipped: Vec<&'static str>,
    },
    /// A file can't be read.
    #[error("the {what} `{}` can't be read: {}", shown(path), escape(&source.to_string()))]
    Unreadable {
        /// The kind of file.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// A file is larger than anything that a person writes.
    #[error("the {what} `{}` is larger than {}", shown(path), amount::bytes(*limit))]
    TooLarge {
        /// The kind of file.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// The bytes that it may have.
        limit: u64,
    },
    /// A file isn't text.
    #[error("the {what} `{}` is not text: {}", shown(path), why.brief())]
    NotText {
        /// The kind of file.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// The encoding that it has, or the first byte that isn't text.
        why: NoText,
    },
    /// The pipeline lies outside of the folder that its files may lie in: see [`Reach::Within`](crate::Reach::Within).
    #[error("`{}` lies outside of `{}`: name a folder that the pipeline lies in", shown(pipeline), shown(root))]
    OutsideRoot {
        /// The pipeline.
        pipeline: PathBuf,
        /// The folder.
        root: PathBuf,
    },
    /// The pipeline, its shaders, or what was chosen for it are wrong.
    #[error("{}", base::render(&mistakes.sources, &mistakes.diagnostics))]
    Mistakes {
        /// The mistakes.
        mistakes: Box<Mistakes>,
    },
    /// The scene is wrong.
    #[error("{0}")]
    Scene(Box<SceneError>),
    /// The device can't draw for two eyes as was asked.
    #[error("{why}")]
    Stereo {
        /// What it lacks.
        why: String,
    },
    /// A pass that no scene draws: the program that has its shader records it.
    #[error("nobody records `{}`, which the custom pass `{}` asks for", escape(name), escape(pass))]
    CustomPass {
        /// The pass.
        pass: String,
        /// What it asks for.
        name: String,
    },
    /// No output has the name.
    #[error("there is no output `{}`: there are {}", escape(name), list(known))]
    UnknownOutput {
        /// The name that was asked for.
        name: String,
        /// Those that there are.
        known: Vec<String>,
    },
    /// An error of the device, a shader or a draw source.
    #[error(transparent)]
    Vulkan(#[from] framewright_vulkan::Error),
}

/// Mistakes in a pipeline's files, and the texts that they point into.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Mistakes {
    /// The texts.
    pub sources: Sources,
    /// At least one mistake.
    pub diagnostics: Vec<Diagnostic>,
    /// Whether nothing is wrong with the files by themselves: what was chosen for the pipeline is wrong.
    pub of_choices: bool,
}

impl Mistakes {
    /// Whether nothing is wrong with the files: the machine doesn't let one be read, or lacks something.
    #[must_use]
    pub fn is_of_machine(&self) -> bool {
        self.diagnostics.iter().any(|mistake| mistake.of_machine)
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{self}")
    }
}

impl Error {
    /// Mistakes in files.
    pub(crate) fn mistakes(sources: &Sources, diagnostics: Vec<Diagnostic>) -> Error {
        Error::Mistakes { mistakes: Box::new(Mistakes { sources: sources.clone(), diagnostics, of_choices: false }) }
    }

    /// Mistakes in what was chosen.
    pub(crate) fn of_choices(sources: &Sources, diagnostics: Vec<Diagnostic>) -> Error {
        Error::Mistakes { mistakes: Box::new(Mistakes { sources: sources.clone(), diagnostics, of_choices: true }) }
    }

    /// The mistakes in files as data, with the texts that they point into; `None`: it is another error.
    #[must_use]
    pub fn diagnostics(&self) -> Option<(&Sources, &[Diagnostic])> {
        match self {
            Error::Mistakes { mistakes } => Some((&mistakes.sources, &mistakes.diagnostics)),
            Error::Scene(problem) => match &**problem {
                SceneError::Text { sources, mistakes } => Some((sources, mistakes)),
                _ => None,
            },
            _ => None,
        }
    }

    /// The rules that a Plan breaks, which would be a mistake of the compiler; none: it is another error.
    #[must_use]
    pub fn violations(&self) -> &[Violation] {
        match self {
            Error::Vulkan(framewright_vulkan::Error::Violations { violations }) => violations,
            _ => &[],
        }
    }
}

fn shown(path: &Path) -> String {
    escape(&path.to_string_lossy())
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_owned();
    }
    names.iter().map(|name| format!("`{}`", escape(name))).collect::<Vec<_>>().join(", ")
}
