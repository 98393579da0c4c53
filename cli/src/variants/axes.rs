//! The axes along which a pipeline varies: settings, facts of the scene, devices.

use super::axis::{Axis, Varied};
use super::facts;
use super::mentions::Mentions;
use super::space::Choice;
use framewright_graph::base::Sources;
use framewright_graph::expression::Value;
use framewright_graph::language::{ChosenBy, Document, Facts, Preset, SettingKind, last_step, nth_step};

/// Whole numbers up to this many are all tried.
const MOST_INTEGERS: i128 = 16;

/// Numbers with up to this many steps are all tried.
const MOST_STEPS: f64 = 16.0;

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
            varies.then(|| Axis::new(Varied::Setting(name.to_owned()), values(&setting.kind)))
        });
        let device = Axis::new(Varied::Device, devices.to_vec());
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
            let own = |varied: &Varied| matches!(varied, Varied::Setting(name) if **name == *setting.name.text);
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
    pub(crate) fn chosen<'a>(&'a self, choice: &'a [usize]) -> impl Iterator<Item = (&'a Varied, &'a str)> {
        self.list.iter().zip(choice).map(|(axis, value)| (&axis.varied, &*axis.values[*value]))
    }

    /// The values of a variant that depart from the defaults.
    pub(crate) fn departures<'a>(&'a self, choice: &'a [usize]) -> impl Iterator<Item = (&'a Varied, &'a str)> {
        self.chosen(choice).zip(choice).filter(|(_, value)| **value != 0).map(|(chosen, _)| chosen)
    }

    /// Settings of a variant, as expansion takes them.
    #[must_use]
    pub(crate) fn settings(&self, choice: &[usize]) -> Vec<(String, String)> {
        let chosen = self.chosen(choice).filter_map(|(varied, value)| match varied {
            Varied::Setting(name) => Some((name.clone(), value.to_owned())),
            Varied::Fact(_) | Varied::Device => None,
        });
        self.fixed.iter().cloned().chain(chosen).collect()
    }

    /// Facts of a variant; those that don't vary are as if there were no scene.
    #[must_use]
    pub(crate) fn facts(&self, choice: &[usize]) -> Facts {
        self.chosen(choice).fold(Facts::UNKNOWN, |known, (varied, value)| match varied {
            Varied::Fact(fact) => known.with(*fact, facts::value(*fact, value)),
            Varied::Setting(_) | Varied::Device => known,
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

/// A value as the command line has it; numbers so that they read as the very same.
pub(crate) fn text(value: &Value) -> String {
    match value {
        Value::Number(number) => format!("{number:?}"),
        Value::Text(text) => text.to_string(),
        other => other.to_string(),
    }
}

/// Values of a setting that are tried, the default first.
pub(crate) fn values(kind: &SettingKind) -> Vec<String> {
    match kind {
        SettingKind::Bool { default } => vec![default.to_string(), (!default).to_string()],
        SettingKind::OneOf { default, of } => first(default.to_string(), of.iter().map(i64::to_string)),
        SettingKind::Choice { default, of } => first(default.to_string(), of.iter().map(ToString::to_string)),
        SettingKind::Integer { default, min, max, step } => {
            let (least, step) = (i128::from(*min), i128::from(*step).max(1));
            let steps = (i128::from(*max) - least) / step;
            let nth = |number: i128| least + number * step;
            let some: Vec<i128> = if steps < MOST_INTEGERS {
                (0..=steps).map(nth).collect()
            } else {
                let between = steps / 2;
                // Another one, should that be the default.
                let between = if nth(between) == i128::from(*default) { between + 1 } else { between };
                [0, between, steps].map(nth).to_vec()
            };
            first(default.to_string(), some.iter().map(i128::to_string))
        }
        SettingKind::Number { default, min, max, step } => {
            // Written so that it reads as the very same number.
            let text = |number: f64| format!("{number:?}");
            let others: Vec<f64> = match step.map(|step| (step, last_step(*min, *max, step))) {
                None => vec![*min, *max],
                Some((step, last)) => {
                    // Rounding alone may set the default apart from the step that it is on.
                    let own = ((default - min) / step).round();
                    let steps: Vec<f64> = if last < MOST_STEPS {
                        std::iter::successors(Some(0.0), |steps| Some(steps + 1.0))
                            .take_while(|steps| *steps <= last)
                            .collect()
                    } else {
                        vec![0.0, last]
                    };
                    steps.into_iter().filter(|steps| *steps != own).map(|steps| nth_step(*min, step, steps)).collect()
                }
            };
            first(text(*default), others.into_iter().map(text))
        }
    }
}

/// `default`, then the others, each once.
fn first(default: String, others: impl Iterator<Item = String>) -> Vec<String> {
    let mut values = vec![default];
    for value in others {
        if !values.contains(&value) {
            values.push(value);
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_takes_all_values_or_those_at_the_ends_the_default_first() {
        assert_eq!(values(&SettingKind::Bool { default: true }), ["true", "false"]);
        assert_eq!(values(&SettingKind::OneOf { default: 4, of: vec![1, 2, 4] }), ["4", "1", "2"]);
        assert_eq!(values(&SettingKind::Integer { default: 2, min: 1, max: 3, step: 1 }), ["2", "1", "3"]);
        assert_eq!(values(&SettingKind::Integer { default: 1, min: 0, max: 15, step: 1 }).len(), 16);
        assert_eq!(values(&SettingKind::Integer { default: 1, min: 0, max: 16, step: 1 }), ["1", "0", "8", "16"]);
        assert_eq!(values(&SettingKind::Integer { default: 8, min: 0, max: 16, step: 1 }), ["8", "0", "9", "16"]);
        let widest = SettingKind::Integer { default: 0, min: i64::MIN, max: i64::MAX, step: 1 };
        assert_eq!(values(&widest), ["0", "-9223372036854775808", "-1", "9223372036854775807"]);
        assert_eq!(
            values(&SettingKind::Number { default: 0.1, min: 0.0, max: 1e300, step: None }),
            ["0.1", "0.0", "1e300"]
        );
        assert_eq!(values(&SettingKind::Number { default: 1.0, min: 1.0, max: 1.0, step: None }), ["1.0"]);
        let texts = ["low", "high"].map(std::sync::Arc::from).to_vec();
        assert_eq!(values(&SettingKind::Choice { default: "high".into(), of: texts }), ["high", "low"]);
    }

    #[test]
    fn of_numbers_with_few_steps_all_are_tried_each_once() {
        assert_eq!(values(&SettingKind::Integer { default: 5, min: 1, max: 8, step: 2 }), ["5", "1", "3", "7"]);
        let number = |default, max| values(&SettingKind::Number { default, min: 0.0, max, step: Some(0.1) });
        // 3 · 0.1 is 0.30000000000000004, and 0.7 / 0.1 is 6.999999999999999.
        assert_eq!(number(0.3, 0.5), ["0.3", "0.0", "0.1", "0.2", "0.4", "0.5"]);
        assert_eq!(number(0.0, 0.75).last().map(String::as_str), Some("0.7"));
        assert_eq!(number(0.0, 1.5).len(), 16);
        assert_eq!(number(0.5, 1.6), ["0.5", "0.0", "1.6"]);
    }
}
