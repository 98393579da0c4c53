//! What a page carries of a pipeline, and what is chosen for its frame.

use crate::shaders::ShaderTable;
use framewright_graph::compile::Options;
use framewright_graph::frame::{Stereo, TextureFile, TextureInfo};
use framewright_graph::language::Facts;
use framewright_graph::vulkan::Rotation;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The version of the JSON form of [`Subject`].
pub const FORMAT: u32 = 1;

/// A pipeline with all that its compiler asks for.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subject {
    /// [`FORMAT`].
    pub format: u32,
    /// The name for people.
    pub name: String,
    /// The texts of its language, the pipeline first.
    pub files: Vec<TextFile>,
    /// The extensions that were chosen for it, by their numbers among the files.
    pub extensions: Vec<usize>,
    /// Settings files, of which later ones are stronger.
    pub settings: Vec<TextFile>,
    /// Where paths in files led.
    pub paths: Vec<PathUse>,
    /// What is known of each picture that it names.
    pub pictures: Vec<(TextureFile, TextureInfo)>,
    /// What draws bring along: the text of an interface.
    pub draws: String,
    /// Device profiles beside those that are shipped.
    pub profiles: Vec<NamedProfile>,
    /// Facts of the scene; `None`: it may hold everything.
    pub facts: Option<Facts>,
    /// How Plans are made.
    pub options: Options,
    /// The interfaces of its shaders.
    pub shaders: ShaderTable,
    /// What was chosen for the Plan of the page.
    pub own: Choices,
}

/// A text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextFile {
    /// As messages call it.
    pub shown: String,
    /// Which one it is, as it stands in Plans.
    pub path: String,
    /// The text.
    pub text: String,
}

/// A path that stands in a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathUse {
    /// The file in which it stands.
    pub from: String,
    /// The path as it stands there.
    pub path: String,
    /// The file that it leads to.
    pub to: String,
}

/// A device profile.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedProfile {
    /// Its name in [`Choices::device`].
    pub name: String,
    /// Its text.
    pub text: String,
}

/// What is chosen for a frame.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choices {
    /// The name of the device's profile.
    pub device: String,
    /// Width and height of the output.
    pub extent: [u32; 2],
    /// The preset in force; `None`: that of the settings files, if they name one.
    pub preset: Option<String>,
    /// Values of settings, which are stronger than presets and settings files.
    pub set: Vec<(String, String)>,
    /// Ways of drawing for two eyes, of which the first counts that the device has.
    pub stereo: Vec<Stereo>,
    /// The rotation of the screen.
    pub rotation: Rotation,
    /// The names of passes that are left out, and of uses of fragments.
    #[serde(default)]
    pub left_out: Vec<String>,
    /// Texts in place of those of files, by their paths in Plans.
    #[serde(default)]
    pub texts: BTreeMap<String, String>,
}
