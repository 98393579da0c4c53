//! The settings and facts that decided what a frame is made of.

use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A property of an image or a pass that a setting or a fact decided.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DecidedProperty {
    /// The image or pass.
    pub subject: Subject,
    /// Its property.
    pub what: Property,
    /// The names whose values decided.
    pub by: Arc<DecidedBy>,
}

/// An image or pass of a frame, by its name.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Subject {
    /// An image.
    Image(Arc<str>),
    /// A pass.
    Pass(Arc<str>),
}

/// A property of an image or a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Property {
    /// That an image is there. Each of its uses has a condition: this is the condition of the first use.
    Exists,
    /// An image's format.
    Format,
    /// An image's width and height.
    Size,
    /// An image's samples a texel.
    Samples,
    /// An image's mip levels.
    Mips,
    /// An image's array layers.
    Layers,
    /// An image's depth in texels.
    Depth,
    /// That a pass runs.
    Runs,
    /// That a pass doesn't run.
    LeftOut,
    /// Which images a pass uses.
    Images,
    /// How often an image or a pass is repeated.
    Repeat,
}

/// The names whose values decided.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DecidedBy {
    /// Facts of the scene, and properties of the view and the device.
    pub facts: Vec<NamedValue>,
    /// Settings, which a user chooses.
    pub settings: Vec<NamedValue>,
}

/// A name, and its value as it is shown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedValue {
    /// The name: `scene.peak_radiance`, `hdr`.
    pub name: Arc<str>,
    /// The value.
    pub value: String,
}

impl Property {
    /// The word for it in the tree form.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Property::Exists => "exists",
            Property::Format => "format",
            Property::Size => "size",
            Property::Samples => "samples",
            Property::Mips => "mips",
            Property::Layers => "layers",
            Property::Depth => "depth",
            Property::Runs => "runs",
            Property::LeftOut => "left out",
            Property::Images => "images",
            Property::Repeat => "repeat",
        }
    }
}
