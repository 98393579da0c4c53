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
mod document;
mod extend;
mod facts;
mod fragments;
mod images;
mod includes;
mod known;
mod lifetimes;
mod loader;
mod lower;
mod mistakes;
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
mod read;
mod resolves;
mod resources;
mod schema;
mod scope;
mod scope_names;
mod settings;
mod sizes;
mod surroundings;
mod targets;
mod textures;
mod unused;
mod uses;
mod values;
mod views;
mod work;

pub(crate) use buffers::LARGEST_BUFFER;
pub use choices::{Choice, ChosenBy, InForce, Preset, SETTINGS_VERSION, SettingsFile};
pub use document::Document;
pub use facts::{Fact, FactType, FactValue, Facts};
pub(crate) use images::LARGEST_SIZE;
pub use includes::{Files, Found, NoFiles, Unread};
pub use loader::{LANGUAGE_VERSION, LARGEST_FILE};
pub(crate) use mistakes::in_order;
pub(crate) use origins::{USED_HERE, users_first};
pub use pass::{
    BufferPart, Color, Depth, Draw, Face, Forward, Groups, ImagePart, LeftOut, Off, Param, Part, Pass, Sample,
    Selection, StandIn, Storage, StorageAccess, Uniform, Work,
};
pub use pipeline::{BufferRef, ImageRef, Instance, Output, Pipeline, RemovedPass, ResourceRef, Setting, SettingKind};
pub use pipeline_files::{PipelineFiles, Shipped};
pub(crate) use properties::{Area, area};
pub use read::{read, read_bytes, read_bytes_with, read_extended, read_with};
pub use resources::{
    Buffer, Bytes, Fill, Format, Image, Layers, Lifetime, Mips, Precision, Precisions, Resolves, Samples,
    Shape as ImageShape, Size, State, StateWord,
};
pub use schema::{FILES, goes_with, schema};
pub use settings::{last_step, nth as nth_step};
pub use surroundings::{Surroundings, names_of};
pub use views::View;
pub(crate) use work::MOST_GROUPS;
