//! One thing that varies: a setting, a fact of the scene, or the device.

use framewright_graph::facts::Fact;

/// What an axis varies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Varied {
    /// A setting, by name.
    Setting(String),
    /// A fact of the scene.
    Fact(Fact),
    /// The device, by the name of its profile.
    Device,
}

/// Something that varies, and the values that it takes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Axis {
    /// What varies.
    pub(crate) varied: Varied,
    /// Its values as the command line has them, each once; what is in force without a choice comes first.
    pub(crate) values: Vec<String>,
    /// How many of them, from the first on, are combined with those of other axes. The rest stand in presets alone.
    pub(crate) combined: usize,
}

impl Axis {
    pub(super) fn new(varied: Varied, values: Vec<String>) -> Axis {
        Axis { varied, combined: values.len(), values }
    }
}
