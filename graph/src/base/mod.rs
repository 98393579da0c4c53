//! Tools for everything else: places in source text, mistakes and how they are shown, near names, numbers, paths.

pub mod amount;
mod code;
mod diagnostic;
mod encoding;
mod file_path;
mod json;
mod machine;
mod near_names;
mod read_files;
mod render;
mod root;
mod shorten;
mod source;
mod text;

pub use code::{Code, Room};
pub use diagnostic::{Diagnostic, Label, OutsideChoice, Quote};
pub(crate) use diagnostic::{MOST_KEPT, keep};
pub use encoding::{NoText, other_encoding, text_of, without_mark};
pub use file_path::{FilePath, for_shell};
pub use json::to_json;
pub use machine::is_of_machine;
pub(crate) use near_names::without_quotes;
pub use near_names::{nearest, suggestion};
pub use read_files::{FileIdentity, ReadFiles};
pub use render::{escape, render};
pub use root::{NoFile, Root};
pub(crate) use shorten::enumerated;
pub use source::{Place, SourceFile, Sources, Span};
pub(crate) use text::shown_number;
pub use text::unix_lines;
