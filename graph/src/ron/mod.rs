//! RON as a tree with places, and readers of the values in it, for files of pipelines, settings and scenes.

mod convert;
mod escapes;
mod fields;
mod form;
mod leaf;
mod lexer;
mod names;
pub(crate) mod node;
mod numbers;
mod reader;
mod spanned;
mod syntax;
mod tree;

pub use convert::convert;
pub use fields::{Field, FromLeaf, plain_name, slots};
pub(crate) use form::names;
pub use form::{FieldTable, Form, PlainForm, Row, Table, Word, WordContents, Words};
pub use leaf::{Leaf, Shape};
pub use names::Names;
pub use numbers::Number;
pub(crate) use reader::MANY_MISTAKES;
pub use reader::Reader;
pub use spanned::{Name, Spanned};
pub use tree::Tree;
