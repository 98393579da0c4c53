//! The files of a subject, with the texts that were chosen for them.

use crate::subject::{Choices, Subject, TextFile};
use framewright_graph::base::{Code, FilePath};
use framewright_graph::frame::{TextureFile, TextureInfo, TextureProblem};
use framewright_graph::language::{Files, FoundFile, LARGEST_FILE, ReadFailure};

/// The files that a pipeline names: those that its subject carries, and no others.
pub(crate) struct CarriedFiles<'s> {
    subject: &'s Subject,
    choices: &'s Choices,
}

impl<'s> CarriedFiles<'s> {
    pub(crate) fn new(subject: &'s Subject, choices: &'s Choices) -> CarriedFiles<'s> {
        CarriedFiles { subject, choices }
    }

    /// A file with its text as it was chosen.
    pub(crate) fn found(&self, file: &TextFile) -> FoundFile {
        let text = self.choices.texts.get(&file.path).unwrap_or(&file.text);
        let relative = FilePath::of_text(&file.path);
        FoundFile { shown: file.shown.clone(), relative, bytes: text.as_bytes().to_vec() }
    }

    /// The file that a path leads to: as it did when the subject was made, else beside the file that names it, else a shipped one.
    fn file(&self, from: &FilePath, path: &str) -> Result<Option<&'s TextFile>, ReadFailure> {
        let named = |path: &str| self.subject.files.iter().find(|file| file.path == path);
        let from_text = from.to_string();
        let known = self.subject.paths.iter().find(|known| known.from == from_text && known.path == path);
        if let Some(known) = known {
            return Ok(named(&known.to));
        }
        let unread = |problem| ReadFailure::from(format!("`{path}` {problem}"));
        let beside = from.beside(path).map_err(unread)?;
        let shipped = FilePath::Shipped("".into()).beside(path).map_err(unread)?;
        Ok(named(&beside.to_string()).or_else(|| named(&shipped.to_string())))
    }
}

impl Files for CarriedFiles<'_> {
    fn read(&mut self, from: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        let Some(file) = self.file(from, path)? else {
            return Err(ReadFailure::from(format!("`{path}` isn't among the files that this page carries")));
        };
        let found = self.found(file);
        match found.bytes.len() {
            bytes if bytes > LARGEST_FILE => {
                let why = format!("`{path}` has {bytes} bytes; a pipeline file has at most {LARGEST_FILE}");
                Err(ReadFailure { code: Code::FILE_TOO_LARGE, ..ReadFailure::from(why) })
            }
            _ => Ok(found),
        }
    }

    fn picture(&mut self, file: &TextureFile) -> Result<TextureInfo, TextureProblem> {
        let known = self.subject.pictures.iter().find(|(known, _)| known == file);
        let reason = || "this page knows nothing of it".to_owned();
        known.map(|(_, info)| *info).ok_or_else(|| TextureProblem::Machine { reason: reason() })
    }
}
