//! Saved profiles: a device that is not here, as a RON file.

use super::Profile;

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("profiles/", $name, ".ron"))),)*]
    };
}

/// The profiles that the library carries, by name. That of lavapipe in Debian 12 comes first and is the default.
/// The first two were read from the drivers; the others were put together from public sources. Each of those names its
/// sources, and the values that they don't tell.
pub const SHIPPED_PROFILES: &[(&str, &str)] = shipped!(
    "lavapipe",
    "swiftshader",
    "nvidia-rtx-2080",
    "amd-rx-7800-xt",
    "intel-arc-a770",
    "mali-g78",
    "meta-quest-3",
);

/// A mistake in a profile's text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{line}:{column}: {problem}")]
pub struct ProfileError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The mistake: the text that was found, and what was expected. Not escaped.
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
