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
//! `docs/pipeline-format.md` tells what each field means; this is its grammar.
//! ```text
//! Pipeline(version: 1, include: ["file"…], extensions: ["file"…], settings: [SETTING…], presets: [PRESET…],
//!          views: [VIEW…], fragments: [FRAGMENT…], textures: [TEXTURE…], images: [IMAGE…], buffers: [BUFFER…],
//!          passes: [ITEM…], outputs: [OUTPUT…], changes: [CHANGE…])
//! Pipeline(version: 1, extends: "file", …)                            all of the above but `passes`, added to what there is
//! Fragments(version: 1, include: ["file"…], fragments: [FRAGMENT…])
//! Extension(version: 1, about: "…", include: ["file"…], settings: [SETTING…], presets: [PRESET…], views: [VIEW…],
//!           fragments: [FRAGMENT…], textures: [TEXTURE…], images: [IMAGE…], buffers: [BUFFER…], changes: [CHANGE…])
//!
//! CHANGE     Set(THING, to: (field: value…), without: ["field"…])    `to` or `without` may be left out
//!            | Remove(THING) | Remove(output: "name")
//!            | Insert(PLACE, passes: [ITEM…]) | Insert(outputs: [OUTPUT…])
//! THING      pass: "name" | image: "name" | buffer: "name" | texture: "name" | setting: "name" | preset: "name"
//!            | view: "name"
//! PLACE      before: "pass" | after: "pass" | at: "anchor" | at: Start | at: End
//!
//! SETTING    (name: "…", value: KIND, about: "…")                  `about` may be left out
//! KIND       Bool(default: true) | OneOf(default: 4, of: [1, 4]) | OneOf(default: "low", of: ["low", "high"])
//!            | Number(default: 1.0, min: 0.0, max: 2.0) | Integer(default: 1, min: 0, max: 9)    with `step: 1` too
//!
//! PRESET     (name: "…", about: "…", set: {"setting": value…})     `about` may be left out
//!
//! VIEW       (name: "…", about: "…", size: Output | Scaled(0.5) | Fixed(640, 360), camera: "…", allows_msaa: true,
//!             allows_hdr: true, allows_scale: true, set: {"setting": value…})     all but the name may be left out
//!
//! FRAGMENT   (name: "…", about: "…", parameters: [PARAMETER…], textures: [TEXTURE…], images: [IMAGE…],
//!             buffers: [BUFFER…], passes: [ITEM…])
//! PARAMETER  (name: "…", value: TYPE, about: "…")
//! TYPE       Image | Buffer | KIND | Format(default: R8_UNORM)      without `default`: it has to be given
//! ITEM       PASS | USE | (anchor: "…")
//! USE        (use: "fragment", name: "…", view: "…", with: {"parameter": VALUE…}, repeat: REPEAT, when: …,
//!             otherwise: OTHERWISE)
//! REPEAT     ("i", 8)                                              `i` counts from 0; may stand in IMAGE, BUFFER and PASS
//!
//! TEXTURE    (name: "…", file: "…", color_space: Srgb | Linear, format: R8_UNORM, shape: D2 | D3)
//!                                       by default Srgb, a format that holds what the file does, D2; D3 takes a strip
//! IMAGE      (name: "…", view: "…", format: FORMAT, size: SIZE, samples: SAMPLES, mips: MIPS, layers: LAYERS, shape: SHAPE,
//!             lifetime: LIFETIME)
//! FORMAT     Color(hdr: true) | Depth | DepthStencil | Output | Like("image") | R8_UNORM and others of Vulkan
//! SIZE       Output | Scaled(FACTOR) | Scaled(FACTOR, "image") | Fixed(640, 480) | Like("image")
//! FACTOR     0.5                                                   of the view or an image, rounded down, at least 1
//! SAMPLES    4 | Like("image")                         by default 1
//! MIPS       4 | Full | Like("image")                  by default 1
//! LAYERS     4 | Like("image")                         by default 1, of a cube 6
//! SHAPE      D2 | D3(64) | Cube                        by default D2; D3 takes the depth
//! BUFFER     (name: "…", view: "…", bytes: BYTES, lifetime: LIFETIME)
//! BYTES      4096 | Times(16, 9) | PerTexel(4, "image") | Like("buffer")
//! LIFETIME   Transient | Persistent(initial: VALUE) | History(frames: 1, initial: VALUE)
//!            | Imported(before: STATE, after: STATE) | Like("name")           `initial`, `frames`, `after` may be left out
//! VALUE      0 | (0.0, 0) | (0.0, 0.0, 0.0, 1.0)                   every component or word | depth, stencil | colour
//! STATE      Undefined | ColorAttachment | DepthAttachment | Sampled | Storage | Uniform | Vertex | Index | Indirect
//!            | TransferSource | TransferTarget | Present | Host | (stages: [STAGE…], accesses: [ACCESS…], layout: LAYOUT)
//!
//! PASS       (name: "…", view: "…", WORK, sample: {"shader's name": SAMPLED…}, storage: {"shader's name": STORAGE…},
//!             uniform: {"shader's name": BUFFERS…}, params: {"shader's name": PARAM…}, color: [COLOR…], depth: DEPTH,
//!             side_effect: true, when: "true", otherwise: OTHERWISE)
//! OTHERWISE  Forward(from: "image", to: "image") | Clear(image: "image", value: VALUE) | [OTHERWISE…]
//! WORK       draw: DRAW | dispatch: "shader", groups: GROUPS | copy: (from: PART, to: PART)
//!            | blit: (from: PART, to: PART, filter: FILTER) | fill: (to: PART, value: VALUE)
//!            | custom: "name", reads: [PART…], writes: [PART…]
//! DRAW       Objects(Opaque | Masked | Transparent), shader: "…" | FullScreen("shader")
//!            | Sky                                                 without `shader`: "sky"
//!            | Vertices(COUNT, COUNT), shader: "…", vertex: BUFFERS, index: BUFFERS       vertices, instances
//!            | Indirect(BUFFERS), shader: "…", vertex: BUFFERS, index: BUFFERS
//! GROUPS     Count(COUNT, COUNT, COUNT) | Invocations(COUNT, COUNT, COUNT) | Texels(IMAGES) | Indirect(BUFFERS, OFFSET)
//! COUNT      8
//! PART       IMAGES | BUFFERS
//! IMAGES     "image" | (image: "…", SELECTED)
//! SELECTED   mip: 1, mips: 2 | Rest, layer: 1, layers: 2 | Rest, plane: Depth | Stencil, previous: 1
//! BUFFERS    "buffer" | (buffer: "…", previous: 1)
//! SAMPLED    FACE | (image: FACE, SELECTED, filter: FILTER, mip_filter: FILTER, address: ADDRESS, own_pixel: true)
//! FILTER     Nearest | Linear                                      by default Linear for colour, else Nearest
//!                                                                  between mip levels by default Nearest
//! ADDRESS    Clamp | Repeat | Mirror                               beyond the edges, by default Clamp
//! FACE       "image" | Samples("image") | Resolved("image")        the plain name: as the shader declares it
//! STORAGE    PART | (image: "…", SELECTED, access: ACCESS) | (buffer: "…", previous: 1, access: ACCESS)
//! ACCESS     Read | Write | ReadWrite                              by default as the shader declares it
//! COLOR      "image" | (image: "…", SELECTED, clear: (r, g, b, a), blend: Replace | Alpha | Premultiplied | Additive)
//! DEPTH      "image" | (image: "…", SELECTED, clear: 0.0, test: GreaterOrEqual, write: true, stencil: STENCIL)
//! STENCIL    (clear: 0, test: Always, reference: 0, pass: Keep)
//! PARAM      1.0 | 1 | true
//! OUTPUT     "name" | (image: "…", after: STATE, encoding: ENCODING) | (buffer: "…", after: STATE)
//! ENCODING   Srgb | Unorm | Linear | Hdr10                         by default what the format says
//! ```
//! Wherever a number, a truth, a format, an image or a buffer stands, an [expression](crate::expression) in quotes may
//! stand; `when` always is one.
//!
//! Names that a file gives begin with a letter or `_` and go on with letters, digits and `_`, those of shaders and
//! custom work with `-` too, at most 64 bytes.

mod bindings;
mod body;
mod buffers;
mod choices;
mod circles;
mod diagnostic;
mod document;
mod escapes;
mod extend;
mod fields;
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
mod previous;
mod properties;
mod put_in;
mod reader;
mod render;
mod resources;
mod scope;
mod scope_names;
mod settings;
mod suggest;
mod surroundings;
mod syntax;
mod targets;
mod textures;
mod tree;
mod uses;
mod values;
mod views;
mod work;

pub(crate) use buffers::LARGEST_BUFFER;
pub use choices::{Choice, ChosenBy, InForce, Preset, SETTINGS_VERSION, SettingsFile};
pub use diagnostic::{Diagnostic, Label};
pub use document::Document;
pub(crate) use images::LARGEST_SIZE;
pub use includes::{Files, Found, NoFiles, Unread};
pub use json::to_json;
pub use pass::{
    BufferPart, Color, Depth, Draw, Face, Forward, Groups, ImagePart, Off, Param, Part, Pass, Sample, Selection,
    StandIn, Storage, StorageAccess, Uniform, Work,
};
pub use pipeline::{
    BufferRef, ImageRef, Instance, Name, Output, Pipeline, RemovedPass, ResourceRef, Setting, SettingKind, Spanned,
};
pub use pipeline_files::{PipelineFiles, SHIPPED, Shipped};
pub(crate) use properties::scaled;
pub use render::{escape, render};
pub use resources::{
    Buffer, Bytes, Fill, Format, Image, Layers, Lifetime, Mips, Samples, Shape as ImageShape, Size, State, StateWord,
};
pub(crate) use settings::shown as shown_number;
pub use settings::{last_step, nth as nth_step};
pub use suggest::{help as suggestion, nearest};
pub use surroundings::Surroundings;
pub use views::View;
pub(crate) use work::MOST_GROUPS;

/// What readers of RON files are made of: pipelines here, scenes elsewhere.
pub mod text {
    pub use super::fields::{Field, FromLeaf, Known, plain_name, slots};
    pub use super::leaf::{Leaf, Number, Shape};
    pub use super::names::Names;
    pub use super::reader::Reader;
    pub use super::tree::Tree;
}

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
    let pipeline = Found { shown: shown.to_owned(), relative: relative.to_owned(), bytes };
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
    read_all(sources, files, (shown, relative, text), Vec::new())
}

fn read_all(
    sources: &mut Sources,
    files: &mut dyn Files,
    (shown, relative, text): (&str, &str, String),
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

/// The first mistakes first: file by file.
pub(crate) fn in_order(mut errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    errors.sort_by_key(|error| error.labels.first().map_or((None, 0), |label| (label.span.file(), label.span.start)));
    errors
}

/// What is to be said if something went wrong and nothing says what.
fn never_none(mut errors: Vec<Diagnostic>) -> Vec<Diagnostic> {
    if errors.is_empty() {
        let message = "this pipeline can't be put together, and why was not found out: a mistake of framewright itself";
        errors.push(Diagnostic { message: message.to_owned(), labels: Vec::new(), help: None });
    }
    errors
}

/// Which byte shows that this is no text.
fn odd_byte(error: &std::string::FromUtf8Error) -> String {
    let at = error.utf8_error().valid_up_to();
    format!("byte {at} is 0x{:02X}, which is not UTF-8", error.as_bytes().get(at).copied().unwrap_or_default())
}

fn too_large(shown: &str, bytes: usize) -> Diagnostic {
    Diagnostic {
        message: format!("`{shown}` has {bytes} bytes; a pipeline file has at most {LARGEST_FILE}"),
        labels: Vec::new(),
        help: None,
    }
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
