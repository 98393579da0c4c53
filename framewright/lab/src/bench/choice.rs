//! The choices that are measured, and the scenes that they are drawn with.

use crate::digest::Digest;
use crate::sweep::{Sweep, size_name, text, values};
use framewright::{Choices, Pipeline, Scene, Stereo};
use std::collections::BTreeMap;
use std::rc::Rc;

/// The preset whose settings decide how right a picture is. All other settings decide how it looks.
pub const REFERENCE: &str = "reference";

/// A scene that choices are drawn with.
#[derive(Debug)]
pub struct MeasuredScene {
    /// Its file, as it was named.
    pub file: String,
    /// A digest of what it holds.
    pub digest: String,
    /// As it stands at its first frame.
    pub still: Scene,
    /// As it moves.
    pub moving: Scene,
}

impl MeasuredScene {
    /// A scene by the name of its file.
    #[must_use]
    pub fn new(file: String, scene: Scene) -> MeasuredScene {
        MeasuredScene { file, digest: Digest::of_value(&scene), still: scene.still_at(0), moving: scene }
    }

    /// The scene as it stands at a frame.
    pub(super) fn still_at(&self, frame: u32) -> Scene {
        self.moving.still_at(frame.into())
    }
}

/// A choice of a sweep.
#[derive(Debug, Clone)]
pub struct Choice {
    /// The values that the sweep chose, by name.
    pub values: BTreeMap<String, String>,
    /// The scene that it is drawn with.
    pub scene: Rc<MeasuredScene>,
    /// Width and height of the output.
    pub size: [u32; 2],
    /// Ways of drawing for two eyes, as [`Choices::stereo`] has them.
    pub stereo: Vec<Stereo>,
}

impl Choice {
    /// The settings among its values.
    pub fn settings(&self) -> impl Iterator<Item = (String, String)> + '_ {
        let settings = self.values.iter().filter(|(name, _)| !name.starts_with('@'));
        settings.map(|(name, value)| (name.clone(), value.clone()))
    }

    /// What is chosen for its frame with a scene, on top of what is chosen for all choices.
    pub(super) fn of(&self, of_all: &Choices, scene: &Scene) -> Choices {
        let mut choices = of_all.clone();
        choices.set.extend(self.settings());
        (choices.facts, choices.extent) = (Some(scene.facts()), self.size);
        choices.stereo.clone_from(&self.stereo);
        choices
    }

    /// A name for its files, other than that of every other choice.
    pub(super) fn key(&self) -> String {
        let values = self.values.iter().flat_map(|(name, value)| [&**name, &**value]);
        let rest = [self.scene.digest.clone(), size_name(self.size), format!("{:?}", self.stereo)];
        Digest::of(values.chain(rest.iter().map(|it| &**it)))
    }
}

/// A sweep over each setting that the preset [`REFERENCE`] names.
#[must_use]
pub fn of_reference(pipeline: &Pipeline) -> Vec<Sweep> {
    let settings = &pipeline.document.settings;
    let preset = pipeline.document.presets.iter().find(|preset| *preset.name.text == *REFERENCE);
    let named = preset.into_iter().flat_map(|preset| &preset.set).filter_map(|chosen| settings.get(chosen.setting));
    named.map(|it| Sweep { name: it.name.text.to_string(), values: values(&it.kind) }).collect()
}

/// The settings of the preset [`REFERENCE`]; `None` if there is no such preset.
#[must_use]
pub fn reference_settings(pipeline: &Pipeline) -> Option<Vec<(String, String)>> {
    let settings = &pipeline.document.settings;
    let preset = pipeline.document.presets.iter().find(|preset| *preset.name.text == *REFERENCE)?;
    let named = preset.set.iter().filter_map(|chosen| Some((settings.get(chosen.setting)?, &chosen.value)));
    Some(named.map(|(setting, value)| (setting.name.text.to_string(), text(value))).collect())
}
