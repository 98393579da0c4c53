//! Which file it is: of the user's own, or shipped with the program.

use super::NoFile;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// A file that a pipeline is made of. The same path is the same file.
///
/// Its text stands in Plans: the path, behind `shipped:` if it is a shipped one. A user's own file that would look so has
/// `./` before it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FilePath {
    /// A file of the user's own, counted from the pipeline's own folder. Names are divided by `/`.
    Own(Arc<str>),
    /// A shipped file, counted from the folder of all shipped files.
    Shipped(Arc<str>),
}

/// The prefix of the path of a shipped file.
const SHIPPED: &str = "shipped:";

/// The prefix of the path of a user's own file that would otherwise look like a shipped file's.
const HERE: &str = "./";

impl FilePath {
    /// The file whose text this is.
    #[must_use]
    pub fn of_text(text: &str) -> FilePath {
        match text.strip_prefix(SHIPPED) {
            Some(shipped) => FilePath::Shipped(shipped.into()),
            None => FilePath::Own(text.strip_prefix(HERE).unwrap_or(text).into()),
        }
    }

    /// The path by itself.
    #[must_use]
    pub fn path(&self) -> &str {
        match self {
            FilePath::Own(path) | FilePath::Shipped(path) => path,
        }
    }

    /// The folder that the file is in; empty if that is the one that paths are counted from.
    #[must_use]
    pub fn folder(&self) -> &str {
        self.path().rfind('/').map_or("", |end| &self.path()[..end])
    }

    /// The file that `path` names inside this file, in the shortest form. An absolute path stays as it is.
    ///
    /// # Errors
    /// [`NoFile::NoPath`] if that is written in a way that no path is.
    pub fn beside(&self, path: &str) -> Result<FilePath, NoFile> {
        if !is_path(path) {
            return Err(NoFile::NoPath);
        }
        let found = beside(self.path(), path).into();
        Ok(match self {
            FilePath::Own(_) => FilePath::Own(found),
            FilePath::Shipped(_) => FilePath::Shipped(found),
        })
    }
}

impl From<&str> for FilePath {
    /// One of the user's own.
    fn from(path: &str) -> FilePath {
        FilePath::Own(path.into())
    }
}

impl From<&FilePath> for FilePath {
    fn from(path: &FilePath) -> FilePath {
        path.clone()
    }
}

impl fmt::Display for FilePath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FilePath::Own(path) if path.starts_with(SHIPPED) || path.starts_with(HERE) => write!(f, "{HERE}{path}"),
            FilePath::Own(path) => f.write_str(path),
            FilePath::Shipped(path) => write!(f, "{SHIPPED}{path}"),
        }
    }
}

/// A path as a shell takes it for one word.
#[must_use]
pub fn for_shell(path: &Path) -> String {
    let path = path.to_string_lossy();
    let plain = |letter: char| letter.is_alphanumeric() || "/._-+,:@%".contains(letter);
    if !path.is_empty() && !path.starts_with('-') && path.chars().all(plain) {
        return path.into_owned();
    }
    format!("'{}'", path.replace('\'', "'\\''"))
}

/// `path` where it stands in the file `from`: both counted from the same folder.
fn beside(from: &str, path: &str) -> String {
    if path.starts_with('/') {
        return path.to_owned();
    }
    let folder = from.rfind('/').map_or("", |end| &from[..end]);
    let (start, folder) = if from.starts_with('/') { ("/", &folder[folder.len().min(1)..]) } else { ("", folder) };
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').filter(|part| !part.is_empty()).chain(path.split('/')) {
        match part {
            "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => drop(parts.pop()),
            ".." if !start.is_empty() => {}
            part => parts.push(part),
        }
    }
    format!("{start}{}", parts.join("/"))
}

/// Whether a text in a file is written as a path.
fn is_path(path: &str) -> bool {
    let relative = path.strip_prefix('/').unwrap_or(path);
    !path.contains(['\\', '\0', ':']) && relative.split('/').all(|part| !part.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_counted_from_the_folder_of_the_file_that_names_it() {
        for (from, path, expected) in [
            ("p.ron", "a.ron", "a.ron"),
            ("p.ron", "library/a.ron", "library/a.ron"),
            ("library/p.ron", "a.ron", "library/a.ron"),
            ("library/p.ron", "./../b/./a.ron", "b/a.ron"),
            ("library/p.ron", "../../a.ron", "../a.ron"),
            ("../p.ron", "../a.ron", "../../a.ron"),
            ("p.ron", "/a.ron", "/a.ron"),
            ("/x/p.ron", "a.ron", "/x/a.ron"),
            ("/p.ron", "a.ron", "/a.ron"),
            ("/x/p.ron", "../../../a.ron", "/a.ron"),
            ("../c:/p.ron", "a.ron", "../c:/a.ron"),
        ] {
            assert_eq!(FilePath::from(from).beside(path), Ok(expected.into()), "`{path}` in `{from}`");
        }
        for path in ["c:/a.ron", "a\\b.ron", "a//b.ron", "", "a\0.ron"] {
            assert_eq!(FilePath::from("p.ron").beside(path), Err(NoFile::NoPath), "`{path}`");
        }
    }

    #[test]
    fn a_path_is_one_word_to_a_shell() {
        for (path, word) in [
            ("a/b-c.ron", "a/b-c.ron"),
            ("a b.ron", "'a b.ron'"),
            ("a'b$.ron", "'a'\\''b$.ron'"),
            ("-r", "'-r'"),
            ("", "''"),
        ] {
            assert_eq!(for_shell(Path::new(path)), word);
        }
    }

    #[test]
    fn a_file_of_the_users_is_never_taken_for_a_shipped_one() {
        for (file, text) in [
            (FilePath::Shipped("a.ron".into()), "shipped:a.ron"),
            (FilePath::Own("shipped:a.ron".into()), "./shipped:a.ron"),
            (FilePath::Own("shipped:x/a.ron".into()), "./shipped:x/a.ron"),
            (FilePath::Own("shipped/a.ron".into()), "shipped/a.ron"),
            (FilePath::Own("./a.ron".into()), "././a.ron"),
            (FilePath::Own("../a.ron".into()), "../a.ron"),
        ] {
            assert_eq!(file.to_string(), text);
            assert_eq!(FilePath::of_text(text), file);
        }
    }
}
