//! The files that a pipeline on disk names: those beside it, then those that are shipped with the program.

use super::files::{Files, FoundFile, LARGEST_FILE, ReadFailure};
use crate::base::{Code, FilePath, NoFile, OutsideChoice, Root, for_shell, nearest};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Path and text of files that are shipped with the program.
pub type ShippedFiles = &'static [(&'static str, &'static str)];

/// The help for a file that lies outside the root.
pub(crate) const WITHIN_ROOT: &str = "give a folder that holds both";

/// Files beside a pipeline, then shipped ones.
///
/// A path is counted from the file in which it stands. Where there is no such file, the shipped file of that path is
/// taken. A path in a shipped file is counted from it, and leads to a shipped file.
#[derive(Debug)]
pub struct PipelineFiles {
    /// `None`: the pipeline is itself shipped, and the user's own files are those that are shipped.
    root: Option<Root>,
    shipped: ShippedFiles,
    /// Files that were read, and the first path that led to each: a second path leads to the same file.
    paths: HashMap<PathBuf, FilePath>,
}

impl PipelineFiles {
    /// The files of the pipeline called `name` in the folder of `root`.
    #[must_use]
    pub fn beside(root: Root, name: &str, shipped: ShippedFiles) -> PipelineFiles {
        let paths = root.locate(name).map(|own| (own, name.into())).into_iter().collect();
        PipelineFiles { root: Some(root), shipped, paths }
    }

    /// The files of a shipped pipeline to which files in the folder of `root` are applied.
    #[must_use]
    pub fn of_shipped(root: Root, shipped: ShippedFiles) -> PipelineFiles {
        PipelineFiles { root: Some(root), shipped, paths: HashMap::new() }
    }

    /// The files of a pipeline that is itself shipped.
    #[must_use]
    pub fn shipped(shipped: ShippedFiles) -> PipelineFiles {
        PipelineFiles { root: None, shipped, paths: HashMap::new() }
    }

    /// The path in Plans of the file that the user names `file`, wherever it lies. A file that was read already keeps its path.
    pub fn which(&mut self, file: &Path) -> FilePath {
        let relative = || {
            let relative = self.root.as_ref().and_then(|root| root.relative(file).ok());
            FilePath::Own(relative.unwrap_or_else(|| file.to_string_lossy().into_owned()).into())
        };
        match file.canonicalize() {
            Ok(found) => match self.paths.get(&found) {
                Some(known) => known.clone(),
                None => {
                    let relative = relative();
                    self.paths.entry(found).or_insert(relative).clone()
                }
            },
            Err(_) => relative(),
        }
    }

    /// The file at `relative`, if there is one on disk.
    fn on_disk(&mut self, root: &Root, relative: FilePath) -> Result<FoundFile, NoFile> {
        let found = root.locate(relative.path())?;
        let bytes = root.read(&found, LARGEST_FILE)?;
        let relative = self.paths.entry(found).or_insert(relative).clone();
        let shown = match root.folder() {
            here if here == Path::new(".") => relative.path().to_owned(),
            folder => folder.join(relative.path()).to_string_lossy().into_owned(),
        };
        Ok(FoundFile { shown, relative, bytes })
    }

    /// The shipped file at `path`.
    fn carried(&self, path: &str) -> Option<FoundFile> {
        let (path, text) = self.shipped.iter().find(|(shipped, _)| *shipped == path)?;
        let relative = match self.root {
            Some(_) => FilePath::Shipped((*path).into()),
            None => FilePath::Own((*path).into()),
        };
        Some(FoundFile { shown: relative.to_string(), relative, bytes: text.as_bytes().to_vec() })
    }

    fn near(&self, path: &str) -> Option<String> {
        let near = nearest(path, self.shipped.iter().map(|(path, _)| *path))?;
        Some(format!("did you mean `{near}`, which is shipped?"))
    }
}

impl Files for PipelineFiles {
    fn read(&mut self, from: &FilePath, path: &str) -> Result<FoundFile, ReadFailure> {
        let unread = |problem: NoFile| ReadFailure::from(format!("`{path}` {problem}"));
        let beside = from.beside(path).map_err(unread)?;
        let root = match (&beside, &self.root) {
            (FilePath::Own(_), Some(root)) => root.clone(),
            (beside, _) => {
                return self.carried(beside.path()).ok_or_else(|| ReadFailure {
                    code: Code::FILE_NAMED_UNREAD,
                    why: format!("there is no file `{path}` among those that are shipped"),
                    help: self.near(path),
                    choice: None,
                    of_machine: false,
                });
            }
        };
        let named = beside.path().to_owned();
        match self.on_disk(&root, beside) {
            Ok(found) => Ok(found),
            Err(NoFile::Missing) => {
                let shipped = FilePath::Shipped("".into()).beside(path).map_err(unread)?;
                self.carried(shipped.path()).ok_or_else(|| ReadFailure {
                    code: Code::FILE_NAMED_UNREAD,
                    why: format!("there is no file `{path}` beside `{from}`, and none of that path is shipped"),
                    help: self.near(path),
                    choice: None,
                    of_machine: false,
                })
            }
            Err(outside @ NoFile::Outside { .. }) => Err(ReadFailure {
                code: Code::FILE_OUTSIDE_ROOT,
                why: format!("`{path}` {outside}, from which nothing may be read"),
                help: Some(WITHIN_ROOT.to_owned()),
                choice: Some(OutsideChoice::Root),
                of_machine: false,
            }),
            Err(refused) if refused.is_of_machine() => {
                let rights = matches!(refused, NoFile::Denied { .. });
                let allow = || format!("chmod u+r {}", for_shell(&root.folder().join(&named)));
                Err(ReadFailure { help: rights.then(allow), of_machine: true, ..unread(refused) })
            }
            Err(other) => Err(unread(other)),
        }
    }
}
