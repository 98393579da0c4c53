//! A pipeline file's bytes become a [`Document`], with the files that it names.

use super::document::Document;
use super::mistakes::{in_order, never_none};
use crate::base::{Code, Diagnostic, FilePath, NoText, Sources, Span, text_of, without_mark};
use crate::language::compose::extend;
use crate::language::compose::files::{Files, FoundFile, LARGEST_FILE, NoFiles, no_pipeline};
use crate::language::compose::layers::Layer;
use crate::language::compose::loader::{self, Loader};
use crate::ron::{Reader, Tree};
use std::sync::Arc;

/// Reads a pipeline file's bytes; `shown` and `relative` are as in [`read`].
///
/// # Errors
/// The mistakes of [`read`], and bytes that are no text.
pub fn read_bytes(
    sources: &mut Sources,
    shown: &str,
    relative: &str,
    bytes: Vec<u8>,
) -> Result<Document, Vec<Diagnostic>> {
    read_bytes_with(sources, &mut NoFiles, shown, relative, bytes)
}

/// Reads a pipeline file's bytes and the files that it names, as [`read_bytes`] does.
///
/// # Errors
/// The mistakes of [`read_with`], and bytes that are no text.
pub fn read_bytes_with(
    sources: &mut Sources,
    files: &mut dyn Files,
    shown: &str,
    relative: &str,
    bytes: Vec<u8>,
) -> Result<Document, Vec<Diagnostic>> {
    let pipeline = FoundFile { shown: shown.to_owned(), relative: relative.into(), bytes };
    read_extended(sources, files, pipeline, Vec::new())
}

/// Reads a pipeline file's bytes and the files that it names, as [`read_bytes_with`] does, and applies extensions to it,
/// one after the other.
///
/// # Errors
/// The mistakes of [`read_bytes_with`], and mistakes in the extensions, by themselves and for this pipeline.
pub fn read_extended(
    sources: &mut Sources,
    files: &mut dyn Files,
    pipeline: FoundFile,
    extensions: Vec<FoundFile>,
) -> Result<Document, Vec<Diagnostic>> {
    let FoundFile { shown, relative, bytes } = pipeline;
    if bytes.len() > LARGEST_FILE {
        return Err(vec![too_large(&shown, bytes.len())]);
    }
    match text_of(&bytes) {
        Ok(text) => read_all(sources, files, (&shown, &relative, text), extensions),
        Err(why) => {
            let valid = match why {
                NoText::Encoding(_) => 0,
                NoText::Byte { at, .. } => at,
            };
            let text = String::from_utf8_lossy(&bytes[..valid]).into_owned();
            let file = sources.add(shown, &relative, text);
            let at = u32::try_from(valid).unwrap_or(u32::MAX);
            let wrong = Diagnostic::new(
                Code::FILE_NOT_TEXT,
                Span::new(file, at, at),
                format!("this is not a text file: {why}"),
            );
            Err(vec![wrong.help("a pipeline is RON text in UTF-8")])
        }
    }
}

/// Reads a pipeline file's text, which is added to `sources`, and which includes no other file. `shown` is the path as the
/// user named it; `relative` is the path from the pipeline's own folder, usually the file's name, which stands in Plans.
///
/// # Errors
/// All mistakes that don't depend on settings, scene, view or device, in the order of the file.
pub fn read(sources: &mut Sources, shown: &str, relative: &str, text: String) -> Result<Document, Vec<Diagnostic>> {
    read_with(sources, &mut NoFiles, shown, relative, text)
}

/// Reads a pipeline file's text and the files that it includes, as [`read`] does.
///
/// # Errors
/// The mistakes of [`read`], and mistakes in included files, file by file.
pub fn read_with(
    sources: &mut Sources,
    files: &mut dyn Files,
    shown: &str,
    relative: &str,
    text: String,
) -> Result<Document, Vec<Diagnostic>> {
    if text.len() > LARGEST_FILE {
        return Err(vec![too_large(shown, text.len())]);
    }
    read_all(sources, files, (shown, &relative.into(), without_mark(&text)), Vec::new())
}

fn read_all(
    sources: &mut Sources,
    files: &mut dyn Files,
    (shown, relative, text): (&str, &FilePath, &str),
    extensions: Vec<FoundFile>,
) -> Result<Document, Vec<Diagnostic>> {
    let text: Arc<str> = text.into();
    let file = sources.add(shown, relative, text.clone());
    if let Some(error) = no_pipeline(file, &text) {
        return Err(vec![error]);
    }
    let mut reader = Reader::default();
    let Some(tree) = Tree::read(file, text, &mut reader.errors) else { return Err(in_order(reader.errors)) };
    if !loader::version(&mut reader, tree.root()) {
        // The words of a later version are not known.
        return Err(reader.errors.pop().into_iter().collect());
    }
    let mut loader = Loader::new(sources, files);
    let composed = extend::read(&mut reader, &mut loader, Layer::pipeline(tree, relative), extensions);
    let Some(composed) = composed else {
        loader.origins.tell(&mut reader.errors);
        return Err(in_order(never_none(reader.errors)));
    };
    Document::read(reader, &mut loader, relative, composed).map_err(in_order)
}

fn too_large(shown: &str, bytes: usize) -> Diagnostic {
    Diagnostic::nowhere(
        Code::FILE_TOO_LARGE,
        format!("`{shown}` has {bytes} bytes; a pipeline file has at most {LARGEST_FILE}"),
    )
}
