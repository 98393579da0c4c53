//! What a file can say: one type per concept, names with source spans, diagnostics.
//!
//! ```text
//! bytes ─► text ─► tree (lexer, syntax) ─► Document (settings, included trees)
//! Document, values, Surroundings ─► bodies (entries with fields) ─► lower (scope, put_in) ─► images, passes … ─► Pipeline
//! ```
//! Trees are made once; lowering runs for each choice of settings, scene, view and device, and evaluates expressions on
//! the way. Everything that is wrong is reported at once, and what is wrong whatever the values already when a file is
//! read. What depends on shaders and on the order of passes comes in [`crate::expand`].
//!
//! # The language
//! `docs/language.md` describes it. That page and the JSON Schema are made of the tables beside the readers: [`forms`].

mod bindings;
mod body;
mod buffers;
mod casters;
mod choices;
mod circles;
mod diagnostic;
mod document;
mod escapes;
mod extend;
mod fields;
mod foreign_formats;
pub mod forms;
mod fragments;
mod images;
mod includes;
mod json;
mod known;
mod leaf;
mod lexer;
mod lifetimes;
mod loader;
mod lower;
mod names;
mod numbers;
mod origins;
mod outputs;
mod parameters;
mod parts;
mod pass;
mod passes;
mod pipeline;
mod pipeline_files;
mod precision;
mod previous;
mod properties;
mod put_in;
mod reader;
mod render;
mod resolves;
mod resources;
mod scope;
mod scope_names;
mod settings;
mod shorten;
mod sizes;
mod suggest;
mod surroundings;
mod syntax;
mod targets;
mod textures;
mod tree;
mod unused;
mod uses;
mod values;
mod views;
mod work;

pub(crate) use buffers::LARGEST_BUFFER;
pub use choices::{Choice, ChosenBy, InForce, Preset, SETTINGS_VERSION, SettingsFile};
pub use diagnostic::{Diagnostic, Label, OutsideChoice, Quote};
pub(crate) use diagnostic::{MOST_KEPT, keep};
pub use document::Document;
pub(crate) use foreign_formats::vulkans_name;
pub(crate) use images::LARGEST_SIZE;
pub use includes::{Files, Found, NoFiles, Unread};
pub use json::to_json;
pub(crate) use origins::{USED_HERE, users_first};
pub use pass::{
    BufferPart, Color, Depth, Draw, Face, Forward, Groups, ImagePart, LeftOut, Off, Param, Part, Pass, Sample,
    Selection, StandIn, Storage, StorageAccess, Uniform, Work,
};
pub use pipeline::{
    BufferRef, ImageRef, Instance, Name, Output, Pipeline, RemovedPass, ResourceRef, Setting, SettingKind, Spanned,
};
pub use pipeline_files::{PipelineFiles, Shipped};
pub(crate) use properties::{Area, area};
pub use render::{escape, render};
pub use resources::{
    Buffer, Bytes, Fill, Format, Image, Layers, Lifetime, Mips, Precision, Precisions, Resolves, Samples,
    Shape as ImageShape, Size, State, StateWord,
};
pub(crate) use settings::shown as shown_number;
pub use settings::{last_step, nth as nth_step};
pub(crate) use suggest::without_quotes;
pub use suggest::{help as suggestion, nearest};
pub use surroundings::{Surroundings, names_of};
pub use views::View;
pub(crate) use work::MOST_GROUPS;

/// What readers of RON files are made of: pipelines here, scenes elsewhere.
pub mod text {
    pub use super::fields::{Field, FromLeaf, plain_name, slots};
    pub use super::forms::{Described, Form, Row, Table};
    pub use super::leaf::{Leaf, Number, Shape};
    pub use super::names::Names;
    pub use super::reader::Reader;
    pub use super::tree::Tree;
}

use crate::file_path::FilePath;
use crate::source::{Sources, Span};
use extend::Layer;
use loader::Loader;
use reader::Reader;
use std::sync::Arc;
use tree::Tree;

/// The version of the language that this library reads.
pub const LANGUAGE_VERSION: i64 = 1;

/// A pipeline file has at most this many bytes (16 MiB).
pub const LARGEST_FILE: usize = 16 << 20;

/// Reads a pipeline file's bytes; `shown` and `relative` are as in [`read`].
///
/// # Errors
/// What [`read`] reports, and bytes that are no text.
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
/// What [`read_with`] reports, and bytes that are no text.
pub fn read_bytes_with(
    sources: &mut Sources,
    files: &mut dyn Files,
    shown: &str,
    relative: &str,
    bytes: Vec<u8>,
) -> Result<Document, Vec<Diagnostic>> {
    let pipeline = Found { shown: shown.to_owned(), relative: relative.into(), bytes };
    read_extended(sources, files, pipeline, Vec::new())
}

/// Reads a pipeline file's bytes and the files that it names, as [`read_bytes_with`] does, and applies extensions to it,
/// one after the other.
///
/// # Errors
/// What [`read_bytes_with`] reports, and what is wrong with the extensions by themselves, and with them for this pipeline.
pub fn read_extended(
    sources: &mut Sources,
    files: &mut dyn Files,
    pipeline: Found,
    extensions: Vec<Found>,
) -> Result<Document, Vec<Diagnostic>> {
    let Found { shown, relative, bytes } = pipeline;
    if bytes.len() > LARGEST_FILE {
        return Err(vec![too_large(&shown, bytes.len())]);
    }
    match String::from_utf8(bytes) {
        Ok(text) => read_all(sources, files, (&shown, &relative, text), extensions),
        Err(error) => {
            let message = format!("this is not a text file: {}", odd_byte(&error));
            let valid = error.utf8_error().valid_up_to();
            let mut bytes = error.into_bytes();
            bytes.truncate(valid);
            let file = sources.add(shown, &relative, String::from_utf8_lossy(&bytes).into_owned());
            let at = u32::try_from(valid).unwrap_or(u32::MAX);
            Err(vec![Diagnostic::new(Span::new(file, at, at), message).help("a pipeline is RON text in UTF-8")])
        }
    }
}

/// Reads a pipeline file's text, which is added to `sources`, and which includes no other file. `shown` is the path as the
/// user named it; `relative` is the path from the pipeline's own folder, usually the file's name, which stands in Plans.
///
/// # Errors
/// Everything that is wrong with the file whatever it is made for, in the order of the file.
pub fn read(sources: &mut Sources, shown: &str, relative: &str, text: String) -> Result<Document, Vec<Diagnostic>> {
    read_with(sources, &mut NoFiles, shown, relative, text)
}

/// Reads a pipeline file's text and the files that it includes, as [`read`] does.
///
/// # Errors
/// What [`read`] reports, and what is wrong with included files, file by file.
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
    read_all(sources, files, (shown, &relative.into(), text), Vec::new())
}

fn read_all(
    sources: &mut Sources,
    files: &mut dyn Files,
    (shown, relative, text): (&str, &FilePath, String),
    extensions: Vec<Found>,
) -> Result<Document, Vec<Diagnostic>> {
    let text: Arc<str> = text.into();
    let file = sources.add(shown, relative, text.clone());
    if let Some(error) = no_pipeline(file, &text) {
        return Err(vec![error]);
    }
    let mut reader = Reader::default();
    let Some(tree) = Tree::read(file, text, &mut reader.errors) else { return Err(in_order(reader.errors)) };
    if !loader::version(&mut reader, tree.root()) {
        // Of a later version's words nothing is known.
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

/// The first mistakes first: file by file as they were read, in each from top to bottom.
pub(crate) fn in_order(mut errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    errors.sort_by_key(|error| error.labels.first().map_or((None, 0), |label| (label.span.file(), label.span.start)));
    errors
}

/// What is to be said if something went wrong and nothing says what.
fn never_none(mut errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    if errors.is_empty() {
        let message = "this pipeline can't be put together, and why was not found out: a mistake of framewright itself";
        errors.push(Diagnostic::nowhere(message));
    }
    errors
}

/// Which byte shows that this is no text.
fn odd_byte(error: &std::string::FromUtf8Error) -> String {
    let at = error.utf8_error().valid_up_to();
    format!("byte {at} is 0x{:02X}, which is not UTF-8", error.as_bytes().get(at).copied().unwrap_or_default())
}

fn too_large(shown: &str, bytes: usize) -> Diagnostic {
    Diagnostic::nowhere(format!("`{shown}` has {bytes} bytes; a pipeline file has at most {LARGEST_FILE}"))
}

/// What shows at once that this is not a pipeline.
fn no_pipeline(file: u32, text: &str) -> Option<Diagnostic> {
    let span = |start: usize, end: usize| {
        let [start, end] = [start, end].map(|at| u32::try_from(at).unwrap_or(u32::MAX));
        Span::new(file, start, end)
    };
    if text.trim().is_empty() {
        let empty = Diagnostic::new(span(0, text.len()), "the file is empty");
        return Some(empty.help("a pipeline begins with `Pipeline(version: 1,`"));
    }
    if let Some(at) = text.find('\0') {
        let zero = Diagnostic::new(span(at, at + 1), format!("this is not a text file: byte {at} is 0x00"));
        return Some(zero.help("a pipeline is RON text in UTF-8"));
    }
    let mark = text.starts_with('\u{feff}');
    let begins = || Diagnostic::new(span(0, 3), "the file begins with a byte order mark");
    mark.then(|| begins().help("save it as UTF-8 without one"))
}
