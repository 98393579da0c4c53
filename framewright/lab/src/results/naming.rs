//! Names of what results hold, for people and as keys.

use super::{Outcome, Results, Row, RowFigures};
use crate::sweep::size_name;
use std::collections::{BTreeMap, BTreeSet};

/// The surroundings of a row: rows of one group differ in settings alone, and can be compared.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Group {
    /// The scene's file, as it was named.
    pub scene: String,
    /// Width and height of the output in pixels.
    pub size: [u32; 2],
    /// The way of drawing for two eyes, or `off`.
    pub stereo: String,
}

impl Group {
    /// Its name for people.
    #[must_use]
    pub fn name(&self) -> String {
        let at = format!("{} at {}", self.scene, size_name(self.size));
        match &*self.stereo {
            "off" => at,
            stereo => format!("{at}, {stereo}"),
        }
    }
}

impl Row {
    /// Its surroundings.
    #[must_use]
    pub fn group(&self) -> Group {
        Group { scene: self.scene.clone(), size: self.size, stereo: self.stereo.clone() }
    }

    /// Its name for people: the choice, and where it was measured.
    #[must_use]
    pub fn name(&self) -> String {
        let settings = self.choice.iter().filter(|(name, _)| !name.starts_with('@'));
        format!("{} of {}", assignments(settings), self.group().name())
    }
}

impl RowFigures {
    /// Whether all pixels are finite, in the picture, its reference and all frames of the moving scene. If not, its figures are those
    /// of the other pixels alone.
    pub fn is_finite(&self) -> bool {
        let still = self.errors.as_ref().is_none_or(|errors| errors.non_finite == [0, 0]);
        still && self.flicker.as_ref().is_none_or(|flicker| flicker.non_finite == 0)
    }

    /// The pictures that it names, as paths within the folder.
    pub fn pictures(&self) -> impl Iterator<Item = (&'static str, &String)> {
        let named = [
            ("picture", &self.picture),
            ("reference", &self.reference),
            ("heat_map", &self.heat_map),
            ("flicker_map", &self.flicker_map),
        ];
        named.into_iter().filter_map(|(name, path)| Some((name, path.as_ref()?)))
    }
}

impl Results {
    /// Leaves out the paths of all pictures.
    pub fn forget_pictures(&mut self) {
        for row in &mut self.rows {
            if let Outcome::Measured(measured) = &mut row.outcome {
                (measured.picture, measured.reference) = (None, None);
                (measured.heat_map, measured.flicker_map) = (None, None);
            }
        }
    }

    /// The settings that the sweep varied.
    pub fn swept(&self) -> BTreeSet<&str> {
        let names = self.rows.iter().flat_map(|row| row.choice.keys());
        names.map(|name| &**name).filter(|name| !name.starts_with('@')).collect()
    }

    /// The values that some settings have for the swept ones, for people.
    pub fn shown(&self, settings: &BTreeMap<String, String>) -> String {
        let swept = self.swept();
        assignments(settings.iter().filter(|(name, _)| swept.contains(&***name)))
    }
}

fn assignments<'a>(settings: impl Iterator<Item = (&'a String, &'a String)>) -> String {
    let all: Vec<String> = settings.map(|(name, value)| format!("{name}={value}")).collect();
    if all.is_empty() { "the settings that were not swept".to_owned() } else { all.join(" ") }
}
