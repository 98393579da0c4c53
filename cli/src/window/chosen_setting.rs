//! The setting that keys turn, and the values that they gave to settings.

use super::choices;
use crate::error::Error;
use crate::system::text;
use framewright::Renderer;
use framewright_graph::language::Setting;
use std::collections::BTreeMap;

/// The setting that keys turn.
#[derive(Default)]
pub(super) struct ChosenSetting {
    /// Its number among the settings of the pipeline. One that is too large stands for the last.
    number: usize,
    /// Values that keys gave to settings since the frame that is shown was planned.
    turned: BTreeMap<String, String>,
}

impl ChosenSetting {
    /// Chooses the next setting, or the one before, and says which.
    pub(super) fn choose(&mut self, renderer: &Renderer, forwards: bool) {
        let count = renderer.document().settings.len();
        if count > 0 {
            self.number = (self.number.min(count - 1) + if forwards { 1 } else { count - 1 }) % count;
        }
        if let Some((setting, value)) = self.setting(renderer) {
            let about = setting.about.as_ref().map_or_else(String::new, |about| format!(": {about}"));
            let line = format!("{} = {value}{about} ({})", setting.name.text, setting.kind.allowed());
            text::say(&text::escape(&line));
        }
    }

    /// Gives the setting its next value, or the one before, and says which.
    ///
    /// # Errors
    /// Those of [`Renderer::set`].
    pub(super) fn turn(&mut self, renderer: &mut Renderer, forwards: bool) -> Result<(), Error> {
        let Some((setting, value)) = self.setting(renderer) else { return Ok(()) };
        let (name, next) = (setting.name.text.to_string(), choices::next(setting, value, forwards));
        let Some(next) = next else { return Ok(()) };
        renderer.set(&name, &next)?;
        text::say(&text::escape(&format!("{name} = {next}")));
        self.turned.insert(name, next);
        Ok(())
    }

    /// What keys turned is in the Plan now, or was refused.
    pub(super) fn planned(&mut self) {
        self.turned.clear();
    }

    /// The setting that keys turn, and its value.
    pub(super) fn setting<'r>(&'r self, renderer: &'r Renderer) -> Option<(&'r Setting, &'r str)> {
        let settings = &renderer.document().settings;
        let setting = settings.get(self.number.min(settings.len().checked_sub(1)?))?;
        Some((setting, self.value(renderer, setting)?))
    }

    /// The value of a setting: in the next frame, or in the one that is shown.
    pub(super) fn value<'r>(&'r self, renderer: &'r Renderer, setting: &Setting) -> Option<&'r str> {
        if let Some(value) = self.turned.get(&*setting.name.text) {
            return Some(value);
        }
        let mut used = renderer.plan()?.settings.iter();
        used.find(|used| *used.name == *setting.name.text).map(|used| &*used.value)
    }
}
