//! Data outside the binary chunk: in the file itself as a `data:` URI (RFC 2397), or in a file beside it.

use super::problem::{GltfError, Problem, at_most_in_all};
use crate::scene::limits;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use framewright_graph::base::{FilePath, NoFile, Root};
use percent_encoding::percent_decode_str;
use std::cell::{Cell, RefCell};

/// The data behind URIs.
#[derive(Debug)]
pub(super) struct External<'a> {
    /// The folder that files are read from; `None`: none are.
    beside: Option<&'a Root>,
    /// Bytes that were read so far.
    taken: Cell<u64>,
    /// Mistakes in URIs that were read all the same.
    mistakes: RefCell<Vec<String>>,
}

/// Exporters leave the padding at the end out now and then.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Characters of an URI that messages show: it may hold all the data.
const SHOWN: usize = 40;
/// And of a path.
const LONGEST_PATH: usize = 256;

impl<'a> External<'a> {
    pub(super) fn new(beside: Option<&'a Root>) -> External<'a> {
        External { beside, taken: Cell::new(0), mistakes: RefCell::default() }
    }

    /// The bytes that an URI refers to: those of a data URI, or the relative path of a file, percent-encoded (RFC 3986, section 2.1).
    pub(super) fn bytes(&self, uri: &str, at: &str) -> Result<Vec<u8>, GltfError> {
        let shown = || uri.chars().take(SHOWN).flat_map(char::escape_debug).collect::<String>();
        let bytes = match scheme(uri) {
            Some(scheme) if scheme.eq_ignore_ascii_case("data") => {
                data(&uri[scheme.len() + 1..]).map_err(|reason| Problem::DataUri { uri: shown(), reason }.at(at))?
            }
            Some(_) => return Err(Problem::Scheme(shown()).at(at)),
            None => {
                let root = self.beside.ok_or_else(|| Problem::External(shown()).at(at))?;
                self.file(root, uri, at).map_err(|problem| {
                    let path = percent_decode_str(uri).decode_utf8_lossy();
                    let (path, of_machine) = (shown_path(&path), problem.is_of_machine());
                    let error = Problem::File { path, problem }.at(at);
                    if of_machine { error.of_whole() } else { error }
                })?
            }
        };
        self.taken.set(self.taken.get() + bytes.len() as u64);
        at_most_in_all("bytes of all files and data URIs up to here", self.taken.get(), limits::FILE_BYTES, at)?;
        Ok(bytes)
    }

    /// The mistakes in URIs that were read all the same.
    pub(super) fn mistakes(&self) -> Vec<String> {
        self.mistakes.take()
    }

    /// The bytes of a file beside this one.
    fn file(&self, root: &Root, uri: &str, at: &str) -> Result<Vec<u8>, NoFile> {
        let mut path = percent_decode_str(uri).decode_utf8().map_err(|_| NoFile::NoPath)?;
        if path.contains('\\') {
            let divided = path.replace('\\', "/");
            let [named, read] = [&*path, &divided].map(shown_path);
            let mistake = format!("{at}: its file `{named}` is named with backslashes, so it is taken as `{read}`");
            self.mistakes.borrow_mut().push(mistake);
            path = divided.into();
        }
        // The path must have the form that this project accepts; the system may accept more.
        FilePath::from("").beside(&path)?;
        let left = limits::FILE_BYTES.saturating_sub(self.taken.get());
        root.read(&root.locate(&path)?, usize::try_from(left).unwrap_or(usize::MAX))
    }
}

/// A path as messages show it.
fn shown_path(path: &str) -> String {
    path.chars().take(LONGEST_PATH).flat_map(char::escape_debug).collect()
}

/// The scheme of an absolute URI (RFC 3986, section 3.1).
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let begins = scheme.starts_with(|first: char| first.is_ascii_alphabetic());
    let goes_on = scheme.chars().all(|letter| letter.is_ascii_alphanumeric() || "+-.".contains(letter));
    (begins && goes_on).then_some(scheme)
}

/// The data of a data URI, without its scheme.
///
/// # Errors
/// Why there are none, in words.
fn data(uri: &str) -> Result<Vec<u8>, String> {
    let (kind, data) = uri.split_once(',').ok_or("it has no comma before its data")?;
    let bytes: Vec<u8> = percent_decode_str(data).collect();
    let base64 = kind.rsplit(';').next().is_some_and(|last| last.eq_ignore_ascii_case("base64"));
    if !base64 {
        return Ok(bytes);
    }
    // Long lines are broken by some.
    let data: Vec<u8> = bytes.into_iter().filter(|byte| !byte.is_ascii_whitespace()).collect();
    BASE64.decode(data).map_err(|error| error.to_string())
}
