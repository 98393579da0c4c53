//! The language of files: one type per concept, names with source spans, diagnostics.
//!
//! ```text
//! bytes ─► text ─► tree (compose: files, extends, extensions) ─► typed entries (entries, scope) ─► Document
//! Document, values, Surroundings ─► evaluate ─► Pipeline (model)
//! ```
//! Trees and entries are made once; values are put in for each choice of settings, scene, view and device. All mistakes are
//! reported at once, and mistakes that don't depend on values already when a file is read. Mistakes that depend on shaders
//! and on the order of passes are found in [`crate::expand`].
//!
//! The modules, each of which uses only those above it:
//! - `model`: a pipeline as data, with its settings and presets.
//! - `inputs`: the surroundings of a pipeline: facts of the scene, the view and the device.
//! - `scope`: the names of one level of a file; values of fields, constant or computed at each lowering.
//! - `entries`: one file per kind of entry: its field table and its reading.
//! - `compose`: the files of a pipeline are put together: `include`, `extends`, `extensions` and `changes`.
//! - `evaluate`: all entries, repetitions and fragments become the flat lists of the model.
//!
//! # The language
//! `docs/language.md` describes it. That page and the JSON Schema are made of the tables in `entries`: [`FILES`].

mod compose;
mod document;
mod entries;
mod evaluate;
mod inputs;
mod mistakes;
mod model;
mod read;
mod schema;
mod scope;
mod settings_file;

pub use compose::files::{Files, FoundFile, LANGUAGE_VERSION, LARGEST_FILE, NoFiles, ReadFailure};
pub(crate) use compose::origins::users_first;
pub use compose::pipeline_files::{PipelineFiles, ShippedFiles};
pub use document::Document;
pub(crate) use entries::buffers::LARGEST_BUFFER;
pub(crate) use entries::dispatch::MOST_GROUPS;
pub(crate) use evaluate::Memory;
pub use inputs::{Fact, FactType, FactValue, Facts, Read, Reads, Surroundings, names_of};
pub(crate) use mistakes::in_order;
pub(crate) use model::{Area, LARGEST_SIZE, PartRef, Use, area};
pub use model::{
    Buffer, BufferPart, BufferRef, Bytes, Choice, ChosenBy, ChosenValue, Color, Decided, Decisions, DeclaredUse, Depth,
    Face, Fill, Format, Forward, Groups, Image, ImagePart, ImageRef, ImageShape, Instance, Layers, LeftOutSample,
    Lifetime, Mips, OffReason, Output, Param, Part, Pass, PassDecisions, Pipeline, Precision, Precisions, Preset,
    RemovedPass, Resolves, ResourceRef, Sample, SamplerState, Samples, Selection, Setting, SettingKind, SettingsFile,
    Size, StandIn, State, Storage, StorageAccess, Uniform, View, Work, last_step, nth_step,
};
pub use read::{read, read_bytes, read_bytes_with, read_extended, read_with};
pub use schema::{FILES, goes_with, schema};
pub use settings_file::SETTINGS_VERSION;
