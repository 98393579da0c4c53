//! The files that a pipeline on disk names: those beside it, then those that are shipped with the program.

use super::{Files, Found, LARGEST_FILE, Unread, suggest};
use crate::root::{NoFile, Root, beside};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// What stands before the path of a shipped file, where it isn't a shipped pipeline that names it.
pub const SHIPPED: &str = "shipped:";

/// Path and text of files that are shipped with the program.
pub type Shipped = &'static [(&'static str, &'static str)];

/// Files beside a pipeline, then shipped ones.
///
/// A path is counted from the file in which it stands. Where there is no such file, the shipped file of that path is
/// taken. What a shipped file names is counted from it, and shipped too.
#[derive(Debug)]
pub struct PipelineFiles {
    /// `None`: the pipeline is itself shipped.
    root: Option<Root>,
    shipped: Shipped,
    /// Files that were read, and the first path that led to each: a second path leads to the same file.
    paths: HashMap<PathBuf, String>,
}

impl PipelineFiles {
    /// Those of the pipeline called `name` in the folder of `root`.
    #[must_use]
    pub fn beside(root: Root, name: &str, shipped: Shipped) -> PipelineFiles {
        let paths = root.locate(name).map(|own| (own, name.to_owned())).into_iter().collect();
        PipelineFiles { root: Some(root), shipped, paths }
    }

    /// Those of a pipeline that is itself shipped.
    #[must_use]
    pub fn shipped(shipped: Shipped) -> PipelineFiles {
        PipelineFiles { root: None, shipped, paths: HashMap::new() }
    }

    /// The file at `relative`, if there is one on disk.
    fn on_disk(&mut self, root: &Root, relative: String) -> Result<Found, NoFile> {
        let found = root.locate(&relative)?;
        let bytes = root.read(&found, LARGEST_FILE)?;
        let relative = self.paths.entry(found).or_insert(relative).clone();
        let shown = match root.folder() {
            here if here == Path::new(".") => relative.clone(),
            folder => folder.join(&relative).to_string_lossy().into_owned(),
        };
        Ok(Found { shown, relative, bytes })
    }

    /// The shipped file at `path`.
    fn carried(&self, path: &str) -> Option<Found> {
        let (_, text) = self.shipped.iter().find(|(shipped, _)| *shipped == path)?;
        let before = if self.root.is_some() { SHIPPED } else { "" };
        let relative = format!("{before}{path}");
        Some(Found { shown: relative.clone(), relative, bytes: text.as_bytes().to_vec() })
    }

    fn near(&self, path: &str) -> Option<String> {
        let near = suggest::nearest(path, self.shipped.iter().map(|(path, _)| *path))?;
        Some(format!("did you mean `{near}`, which is shipped?"))
    }
}

impl Files for PipelineFiles {
    fn read(&mut self, from: &str, path: &str) -> Result<Found, Unread> {
        let shipped = from.strip_prefix(SHIPPED).or(if self.root.is_none() { Some(from) } else { None });
        if let Some(from) = shipped {
            let carried = self.carried(&beside(from, path));
            return carried.ok_or_else(|| Unread {
                why: format!("there is no file `{path}` among those that are shipped"),
                help: self.near(path),
            });
        }
        let Some(root) = self.root.clone() else { return Err(format!("there is no file `{path}`").into()) };
        match self.on_disk(&root, beside(from, path)) {
            Ok(found) => Ok(found),
            Err(NoFile::Missing) => self.carried(&beside("", path)).ok_or_else(|| Unread {
                why: format!("there is no file `{path}` beside `{from}`, and none of that path is shipped"),
                help: self.near(path),
            }),
            Err(outside @ NoFile::Outside { .. }) => Err(Unread {
                why: format!("`{path}` {outside}, from which nothing may be read"),
                help: Some("give a folder that holds both by `--root`, or allow all by `--allow-outside`".to_owned()),
            }),
            Err(other) => Err(format!("`{path}` {other}").into()),
        }
    }
}
