//! Saved profiles: a device that is not here, as a RON file.

use super::Profile;

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("profiles/", $name, ".ron"))),)*]
    };
}

/// The profiles that the library carries, by name: what lavapipe of Debian 12 says of itself comes first and is the one to
/// take where nothing else is said. The first two were read from the drivers; the others were put together from public
/// sources, which each of them names, with what they don't tell.
pub const SHIPPED_PROFILES: &[(&str, &str)] = shipped!(
    "lavapipe",
    "swiftshader",
    "nvidia-rtx-2080",
    "amd-rx-7800-xt",
    "intel-arc-a770",
    "mali-g78",
    "meta-quest-3",
);

/// What is wrong with a profile's text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{line}:{column}: {problem}")]
pub struct ProfileError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What was found and expected. Not escaped.
    pub problem: String,
}

impl Profile {
    /// Reads a saved profile.
    ///
    /// # Errors
    /// [`ProfileError`], if the text isn't a profile or has figures that would lead a compiler astray.
    pub fn from_ron(text: &str) -> Result<Profile, ProfileError> {
        ron::from_str(text).map_err(|error| ProfileError {
            line: error.span.start.line,
            column: error.span.start.col,
            problem: error.code.to_string(),
        })
    }

    /// The text of a saved profile, which [`Profile::from_ron`] reads back.
    ///
    /// # Errors
    /// None that a profile's types allow; those of the writer.
    pub fn to_ron(&self) -> Result<String, ron::Error> {
        let pretty = ron::ser::PrettyConfig::new().depth_limit(2);
        ron::ser::to_string_pretty(self, pretty).map(|text| text + "\n")
    }
}
