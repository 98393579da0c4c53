//! What is chosen for a frame, beside the files of its pipeline.

use crate::error::Error;
use framewright_graph::device::Profile;
use framewright_graph::expand::Inputs;
use framewright_graph::frame::Stereo;
use framewright_graph::language::Facts;
use framewright_graph::vulkan::{Format, Rotation};

/// The size of a frame that nobody chose another size for.
const USUAL_EXTENT: [u32; 2] = [1280, 720];

/// What is chosen for a frame, beside the files of its pipeline. Begin with the default, and set fields.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Choices {
    /// Values of settings, by name, which are stronger than presets and settings files. If there are several for one setting, the last counts.
    pub set: Vec<(String, String)>,
    /// Facts of the scene; `None`: it may hold everything.
    pub facts: Option<Facts>,
    /// Width and height of the output.
    pub extent: [u32; 2],
    /// The rotation of the screen.
    pub rotation: Rotation,
    /// The format of the window's images, if the frame is shown in one.
    pub window: Option<Format>,
    /// Ways of drawing for two eyes, of which the first counts that the device has. Without any the frame is for one eye.
    pub stereo: Vec<Stereo>,
    /// Names of images that leave the frame beside its outputs, so that they can be read.
    pub dump: Vec<String>,
}

impl Default for Choices {
    fn default() -> Self {
        Choices {
            set: Vec::new(),
            facts: None,
            extent: USUAL_EXTENT,
            rotation: Rotation::Identity,
            window: None,
            stereo: vec![Stereo::Off],
            dump: Vec::new(),
        }
    }
}

impl Choices {
    /// The way of drawing for two eyes that counts on a device.
    ///
    /// # Errors
    /// [`Error::Stereo`] if the device has none of those that are chosen.
    pub fn stereo_on(&self, device: &Profile) -> Result<Stereo, Error> {
        match &*self.stereo {
            [] => Ok(Stereo::Off),
            wanted => Stereo::first_fit(wanted, device).map_err(|why| Error::Stereo { why }),
        }
    }

    /// The inputs of a frame that is drawn in this way for two eyes.
    #[must_use]
    pub fn inputs<'a>(&'a self, stereo: Stereo, device: Option<&'a Profile>) -> Inputs<'a> {
        Inputs {
            set: &self.set,
            facts: self.facts.unwrap_or(Facts::UNKNOWN),
            facts_known: self.facts.is_some(),
            output_extent: self.extent,
            device,
            rotation: self.rotation,
            window: self.window,
            dump: &self.dump,
            stereo,
        }
    }

    /// The inputs of a frame on no device in particular.
    pub(crate) fn on_any_device(&self) -> Inputs<'_> {
        self.inputs(self.stereo.first().copied().unwrap_or_default(), None)
    }
}
