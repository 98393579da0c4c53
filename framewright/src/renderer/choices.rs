//! What was chosen for a pipeline, beside its files.

use framewright_graph::device::Profile;
use framewright_graph::expand::Inputs;
use framewright_graph::frame::Stereo;
use framewright_graph::language::{Document, Facts};
use framewright_graph::vulkan::{Format, Rotation};
use std::collections::BTreeMap;

/// The size of a frame that nobody chose another size for.
const USUAL_EXTENT: [u32; 2] = [1280, 720];

/// What was chosen.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Choices {
    /// Values of settings, by name. One that the file doesn't have, or no longer, waits for it.
    pub(super) set: BTreeMap<String, String>,
    pub(super) preset: Option<String>,
    /// Facts of the scene; `None`: it may hold everything.
    pub(super) facts: Option<Facts>,
    pub(super) extent: [u32; 2],
    pub(super) rotation: Rotation,
    /// The format of the window's images, if the frame is shown in one.
    pub(super) window: Option<Format>,
    pub(super) stereo: Stereo,
}

impl Default for Choices {
    fn default() -> Self {
        Choices {
            set: BTreeMap::new(),
            preset: None,
            facts: None,
            extent: USUAL_EXTENT,
            rotation: Rotation::Identity,
            window: None,
            stereo: Stereo::Off,
        }
    }
}

impl Choices {
    /// The values of settings that `document` has.
    pub(super) fn known(&self, document: &Document) -> Vec<(String, String)> {
        let has = |name: &str| document.settings.iter().any(|setting| *setting.name.text == *name);
        let known = self.set.iter().filter(|(name, _)| has(name));
        known.map(|(name, value)| (name.clone(), value.clone())).collect()
    }

    /// The inputs of a frame with these values of settings.
    pub(super) fn inputs<'a>(
        &self,
        set: &'a [(String, String)],
        dump: &'a [String],
        device: Option<&'a Profile>,
    ) -> Inputs<'a> {
        Inputs {
            set,
            facts: self.facts.unwrap_or(Facts::UNKNOWN),
            facts_known: self.facts.is_some(),
            output_extent: self.extent,
            device,
            rotation: self.rotation,
            window: self.window,
            dump,
            stereo: self.stereo,
        }
    }
}
