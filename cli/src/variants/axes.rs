//! The axes along which a pipeline varies: settings, facts of the scene, devices.

use super::axis::{Axis, AxisSubject};
use super::facts;
use super::space::Choice;
use framewright_graph::base::Sources;
use framewright_graph::language::{ChosenBy, Document, Facts, Preset};
use framewright_lab::mentions::Mentions;
use framewright_lab::sweep::{text, values};

/// Everything that varies: settings in the file's order, then facts; the device comes last, even if there is only one.
#[derive(Debug)]
pub(crate) struct Axes {
    pub(crate) list: Vec<Axis>,
    /// Settings that the user chose, and that therefore don't vary.
    pub(crate) fixed: Vec<(String, String)>,
    /// Presets with what they choose, on the first device. None if the user chose one.
    pub(crate) presets: Vec<(String, Choice)>,
}

impl Axes {
    /// The axes of a pipeline: settings and facts that its files mention, unless a preset, a settings file or `set` chooses them.
    #[must_use]
    pub(crate) fn of(pipeline: &Document, sources: &Sources, set: &[(String, String)], devices: &[String]) -> Axes {
        let mentions = Mentions::of(sources);
        let fixed = fixed(pipeline, set);
        let is_fixed = |name: &str| fixed.iter().any(|(fixed, _)| fixed == name);
        let settings = pipeline.settings.iter().enumerate().filter_map(|(at, setting)| {
            let name = &*setting.name.text;
            let in_presets = pipeline.presets.iter().flat_map(|preset| &preset.set);
            let in_presets = in_presets.filter(|choice| choice.setting == at).count();
            // A setting that stands in its declaration and in presets alone changes nothing.
            let varies = mentions.may_hold(name, 2 + in_presets) && !is_fixed(name);
            varies.then(|| Axis::new(AxisSubject::Setting(name.to_owned()), values(&setting.kind)))
        });
        let device = Axis::new(AxisSubject::Device, devices.to_vec());
        let list =
            settings.chain(facts::axes(&mentions)).filter(|axis| axis.values.len() > 1).chain([device]).collect();
        let mut axes = Axes { list, fixed, presets: Vec::new() };
        let one_is_chosen = pipeline.in_force().iter().any(|chosen| matches!(chosen.by, ChosenBy::Preset(_)));
        if !one_is_chosen {
            axes.presets = pipeline.presets.iter().map(|preset| axes.preset(pipeline, preset)).collect();
        }
        axes
    }

    /// The variant that a preset chooses. Values that no axis has yet are added; settings that don't vary stay as they are.
    fn preset(&mut self, pipeline: &Document, preset: &Preset) -> (String, Choice) {
        let mut choice = vec![0; self.list.len()];
        for chosen in &preset.set {
            let Some(setting) = pipeline.settings.get(chosen.setting) else { continue };
            let own =
                |varied: &AxisSubject| matches!(varied, AxisSubject::Setting(name) if **name == *setting.name.text);
            let Some(at) = self.list.iter().position(|axis| own(&axis.varied)) else { continue };
            let values = &mut self.list[at].values;
            let value = text(&chosen.value);
            choice[at] = values.iter().position(|known| *known == value).unwrap_or_else(|| {
                values.push(value);
                values.len() - 1
            });
        }
        (preset.name.text.to_string(), choice)
    }

    /// Presets on every device.
    #[must_use]
    pub(crate) fn variants_of_presets(&self) -> Vec<Choice> {
        let devices = self.list.last().map_or(0, |axis| axis.values.len());
        let on = |choice: &Choice, device: usize| {
            let mut choice = choice.clone();
            choice.last_mut().into_iter().for_each(|last| *last = device);
            choice
        };
        self.presets.iter().flat_map(|(_, choice)| (0..devices).map(move |device| on(choice, device))).collect()
    }

    /// Numbers of values that are combined.
    #[must_use]
    pub(crate) fn sizes(&self) -> Vec<usize> {
        self.list.iter().map(|axis| axis.combined).collect()
    }

    /// The values of a variant, axis by axis.
    pub(crate) fn chosen<'a>(&'a self, choice: &'a [usize]) -> impl Iterator<Item = (&'a AxisSubject, &'a str)> {
        self.list.iter().zip(choice).map(|(axis, value)| (&axis.varied, &*axis.values[*value]))
    }

    /// The values of a variant that depart from the defaults.
    pub(crate) fn departures<'a>(&'a self, choice: &'a [usize]) -> impl Iterator<Item = (&'a AxisSubject, &'a str)> {
        self.chosen(choice).zip(choice).filter(|(_, value)| **value != 0).map(|(chosen, _)| chosen)
    }

    /// Settings of a variant, as expansion takes them.
    #[must_use]
    pub(crate) fn settings(&self, choice: &[usize]) -> Vec<(String, String)> {
        let chosen = self.chosen(choice).filter_map(|(varied, value)| match varied {
            AxisSubject::Setting(name) => Some((name.clone(), value.to_owned())),
            AxisSubject::Fact(_) | AxisSubject::Device => None,
        });
        self.fixed.iter().cloned().chain(chosen).collect()
    }

    /// Facts of a variant; those that don't vary are as if there were no scene.
    #[must_use]
    pub(crate) fn facts(&self, choice: &[usize]) -> Facts {
        self.chosen(choice).fold(Facts::UNKNOWN, |known, (varied, value)| match varied {
            AxisSubject::Fact(fact) => known.with(*fact, facts::value(*fact, value)),
            AxisSubject::Setting(_) | AxisSubject::Device => known,
        })
    }
}

/// The device of a variant, by its number.
#[must_use]
pub(crate) fn device(choice: &Choice) -> usize {
    choice.last().copied().unwrap_or(0)
}

/// The settings that the user chose: by preset and settings files, then by `set`, which is stronger.
fn fixed(pipeline: &Document, set: &[(String, String)]) -> Vec<(String, String)> {
    let chosen = pipeline.settings.iter().zip(pipeline.in_force()).filter_map(|(setting, chosen)| {
        let name = &*setting.name.text;
        let stays = chosen.by != ChosenBy::Default && set.iter().all(|(set, _)| set != name);
        stays.then(|| (name.to_owned(), text(&chosen.value)))
    });
    chosen.chain(set.iter().cloned()).collect()
}
