//! Changes that files made to the pipeline that they extend.

use crate::base::Span;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A change that a file made to a pipeline.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Action {
    /// The file extends another pipeline.
    Extends {
        /// The path of the other pipeline's file, from the folder of the pipeline on.
        file: Arc<str>,
    },
    /// The file applies an extension.
    Extension {
        /// The path of the extension's file, from the folder of the pipeline on.
        file: Arc<str>,
    },
    /// It adds to a list.
    Add {
        /// The kind of the entries.
        of: Kind,
        /// Their names.
        names: Vec<Arc<str>>,
    },
    /// It gives fields other values, or takes fields away.
    Set {
        /// The kind of the entry.
        of: Kind,
        /// Its name.
        name: Arc<str>,
        /// Fields that it gives values.
        fields: Vec<Arc<str>>,
        /// Fields that it takes away.
        without: Vec<Arc<str>>,
    },
    /// It removes something.
    Remove {
        /// The kind of the entry.
        of: Kind,
        /// Its name.
        name: Arc<str>,
    },
    /// It puts passes, uses of fragments and anchors between those that are there.
    Insert {
        /// Where.
        place: InsertPlace,
        /// Their names.
        names: Vec<Arc<str>>,
    },
    /// It names other outputs in place of all that there were.
    Outputs {
        /// Their names.
        names: Vec<Arc<str>>,
    },
}

/// The kind of the entries of one of a pipeline's lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A setting.
    Setting,
    /// A preset.
    Preset,
    /// A view.
    View,
    /// A fragment.
    Fragment,
    /// A texture.
    Texture,
    /// An image.
    Image,
    /// A buffer.
    Buffer,
    /// A pass, or a use of a fragment.
    Pass,
    /// An output.
    Output,
}

impl Kind {
    /// The kind's name in messages.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Kind::Setting => "setting",
            Kind::Preset => "preset",
            Kind::View => "view",
            Kind::Fragment => "fragment",
            Kind::Texture => "texture",
            Kind::Image => "image",
            Kind::Buffer => "buffer",
            Kind::Pass => "pass",
            Kind::Output => "output",
        }
    }

    /// The plural of the kind's name in messages.
    #[must_use]
    pub const fn plural(self) -> &'static str {
        match self {
            Kind::Setting => "settings",
            Kind::Preset => "presets",
            Kind::View => "views",
            Kind::Fragment => "fragments",
            Kind::Texture => "textures",
            Kind::Image => "images",
            Kind::Buffer => "buffers",
            Kind::Pass => "passes",
            Kind::Output => "outputs",
        }
    }
}

/// Where passes are inserted.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InsertPlace {
    /// Before all others.
    Start,
    /// Before the pass of that name.
    Before(Arc<str>),
    /// After the pass of that name.
    After(Arc<str>),
    /// At the anchor of that name.
    At(Arc<str>),
    /// After all others.
    End,
}

/// A change that a file made to a pipeline, and its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// The place in the file.
    pub span: Span,
    /// The change.
    pub action: Action,
}

impl Change {
    /// Whether it removes something of this kind.
    pub(crate) fn removes(&self, kind: Kind) -> bool {
        matches!(self.action, Action::Remove { of, .. } if of == kind)
    }
}
