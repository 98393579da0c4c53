//! `framewright new`: a file to begin with.

use crate::command_line::args::NewArguments;
use crate::error::Error;
use crate::files::outputs;
use crate::system::{Exit, text};
use std::path::{Path, PathBuf};

/// The file, with `{name}` where its name stands.
const STARTING: &str = include_str!("starting.ron");

/// A name has at most this many bytes.
const LONGEST: usize = 64;

/// Writes a pipeline to begin with.
///
/// # Errors
/// If the name is none that a pipeline may have, if there is such a file already, or if it can't be written.
pub(crate) fn new(arguments: &NewArguments) -> Result<Exit, Error> {
    let path = file(&arguments.name).ok_or_else(|| Error::NoName { path: arguments.name.clone() })?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    outputs::write_new(&path, STARTING.replace("{name}", &name).as_bytes())?;
    let shown = text::path(&path);
    text::print(&format!("{shown}: written; begin with `framewright check {shown}`\n")).map_err(Error::Print)?;
    Ok(Exit::Fine)
}

/// The file that a name asks for: `NAME` and `NAME.ron`, in a folder or not, are `NAME.ron`. `None` if the name is not made of
/// letters, digits, `_` and `-`, or begins with a digit or `-`.
fn file(name: &Path) -> Option<PathBuf> {
    let last = name.file_name()?.to_str()?;
    let stem = last.strip_suffix(".ron").unwrap_or(last);
    let mut letters = stem.chars();
    let first = letters.next().is_some_and(|c| c.is_alphabetic() || c == '_');
    let others = letters.all(|c| c.is_alphanumeric() || matches!(c, '_' | '-'));
    // A name that ends in a slash is a folder's.
    let ends = name.as_os_str().to_string_lossy().ends_with(last);
    (first && others && ends && stem.len() <= LONGEST).then(|| name.with_file_name(format!("{stem}.ron")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_letters_digits_and_two_signs() {
        let of = |name: &str| file(Path::new(name)).map(|path| path.to_string_lossy().into_owned());
        assert_eq!(of("glow").as_deref(), Some("glow.ron"));
        assert_eq!(of("glow.ron").as_deref(), Some("glow.ron"));
        assert_eq!(of("a/b/Größe-2_x").as_deref(), Some("a/b/Größe-2_x.ron"));
        let long = "a".repeat(65);
        for bad in [
            "",
            ".",
            "..",
            "/",
            "a/",
            "a/..",
            "2d",
            "-o",
            "a b",
            "a.b",
            "a.ron.ron",
            ".ron",
            "a\n",
            "a\u{1b}[2J",
            &long,
        ] {
            assert_eq!(of(bad), None, "{bad:?}");
        }
    }
}
