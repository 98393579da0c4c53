//! Saved profiles: a device that is not here, as a RON file.

use super::Profile;

/// The profiles that the library carries, by name: what lavapipe of Debian 12 says of itself comes first and is the one to
/// take where nothing else is said.
pub const SHIPPED_PROFILES: &[(&str, &str)] = &[("lavapipe", include_str!("profiles/lavapipe.ron"))];

/// What is wrong with a profile's text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ProfileError {
    /// It isn't a profile.
    #[error("{line}:{column}: {problem}")]
    Text {
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What was found and expected. Not escaped.
        problem: String,
    },
    /// A figure that no device has.
    #[error("`{field}` is {value}, and must be {expected}")]
    Figure {
        /// The field.
        field: &'static str,
        /// What it holds.
        value: u64,
        /// What it may hold.
        expected: &'static str,
    },
}

impl Profile {
    /// Reads a saved profile.
    ///
    /// # Errors
    /// [`ProfileError`], if the text isn't a profile or has figures that would lead a compiler astray.
    pub fn from_ron(text: &str) -> Result<Profile, ProfileError> {
        let profile: Profile = ron::from_str(text).map_err(|error| ProfileError::Text {
            line: error.span.start.line,
            column: error.span.start.col,
            problem: error.code.to_string(),
        })?;
        let sound = |field, value: u64, sound: bool, expected| {
            if sound { Ok(()) } else { Err(ProfileError::Figure { field, value, expected }) }
        };
        let extent = profile.max_attachment_extent;
        sound("max_attachment_extent", extent.into(), extent >= 1, "at least 1")?;
        sound(
            "max_color_attachments",
            profile.max_color_attachments.into(),
            profile.max_color_attachments >= 1,
            "at least 1",
        )?;
        let memory = &profile.memory;
        let aligned = memory.alignment.is_power_of_two() && memory.alignment <= 1 << 30;
        sound("alignment", memory.alignment, aligned, "a power of two up to 2^30")?;
        sound("row_texels", memory.row_texels.into(), (1..=1 << 16).contains(&memory.row_texels), "1 to 65536")?;
        sound("rows", memory.rows.into(), (1..=1 << 16).contains(&memory.rows), "1 to 65536")?;
        for samples in profile.formats.iter().flat_map(|support| &support.samples).copied() {
            sound("samples", samples.into(), matches!(samples, 1 | 2 | 4 | 8 | 16), "1, 2, 4, 8 or 16")?;
        }
        Ok(profile)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn shipped() -> &'static str {
        SHIPPED_PROFILES[0].1
    }

    #[test]
    fn every_shipped_profile_is_read_and_written_back_without_loss() {
        for (name, text) in SHIPPED_PROFILES {
            let profile = Profile::from_ron(text).unwrap_or_else(|error| panic!("{name}: {error}"));
            let again = Profile::from_ron(&profile.to_ron().expect("written"));
            assert_eq!(again, Ok(profile), "{name}");
        }
    }

    #[test]
    fn a_text_that_is_no_profile_is_refused_with_its_place() {
        let wrong = shipped().replacen("max_attachment_extent", "max_attachment_size", 1);
        let error = Profile::from_ron(&wrong).expect_err("an unknown field").to_string();
        assert!(error.contains("max_attachment_size"), "{error}");
        assert!(error.split(':').next().is_some_and(|line| line.parse::<usize>().is_ok()), "{error}");
        assert!(Profile::from_ron("").is_err());
        assert!(Profile::from_ron(&"[".repeat(100_000)).is_err());
    }

    #[test]
    fn figures_that_no_device_has_are_refused() {
        let with = |field: &str, value: &str| {
            let start = shipped().find(field).expect("the field is there") + field.len();
            let end = start + shipped()[start..].find([',', ')', ']']).expect("its end");
            Profile::from_ron(&format!("{}{value}{}", &shipped()[..start], &shipped()[end..]))
        };
        for (field, value) in [
            ("max_attachment_extent: ", "0"),
            ("max_color_attachments: ", "0"),
            ("alignment: ", "3"),
            ("row_texels: ", "0"),
            ("rows: ", "70000"),
            ("samples: [", "3"),
        ] {
            assert!(matches!(with(field, value), Err(ProfileError::Figure { .. })), "{field}{value}");
        }
    }
}
