//! One thing that varies: a setting, a fact of the scene, or the device.

use framewright_graph::language::Fact;

/// The thing that an axis varies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum AxisSubject {
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
    /// The thing that varies.
    pub(crate) varied: AxisSubject,
    /// Its values as the command line writes them, each once, the default first.
    pub(crate) values: Vec<String>,
    /// The first of them are combined with those of other axes, this many. The rest occur in presets alone.
    pub(crate) combined: usize,
}

impl Axis {
    pub(super) fn new(varied: AxisSubject, values: Vec<String>) -> Axis {
        Axis { varied, combined: values.len(), values }
    }
}
