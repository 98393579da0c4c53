//! The settings of a pipeline as data for the controls of the page, and the choices that people make there.

use framewright_graph::language::{Document, SettingKind};
use framewright_graph::plan::Plan;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A setting, as its control needs it.
#[derive(Debug, Serialize)]
pub(super) struct Control {
    name: String,
    about: Option<String>,
    /// The value of the frame that is shown.
    value: Option<String>,
    #[serde(flatten)]
    range: Range,
}

/// The values that a setting may have.
#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
enum Range {
    /// One of these.
    OneOf(Vec<String>),
    /// A number from the first to the second, in steps of the third if there is one.
    Between(f64, f64, Option<f64>),
}

/// The settings and presets of a pipeline.
#[derive(Debug, Default, Serialize)]
pub struct Controls {
    settings: Vec<Control>,
    presets: Vec<String>,
}

impl Controls {
    /// Those of `pipeline`, with the values that they have in `plan`.
    pub fn of(pipeline: &Document, plan: &Plan) -> Controls {
        let value = |name: &str| {
            plan.settings.iter().find(|chosen| *chosen.name == *name).map(|chosen| chosen.value.to_string())
        };
        let control = |setting: &framewright_graph::language::Setting| Control {
            name: setting.name.text.to_string(),
            about: setting.about.clone(),
            value: value(&setting.name.text),
            range: Range::of(&setting.kind),
        };
        Controls {
            settings: pipeline.settings.iter().map(control).collect(),
            presets: pipeline.presets.iter().map(|preset| preset.name.text.to_string()).collect(),
        }
    }
}

impl Range {
    #[allow(clippy::cast_precision_loss, reason = "a slider needs no more digits")]
    fn of(kind: &SettingKind) -> Range {
        match kind {
            SettingKind::Bool { .. } => Range::OneOf(vec!["false".to_owned(), "true".to_owned()]),
            SettingKind::OneOf { of, .. } => Range::OneOf(of.iter().map(ToString::to_string).collect()),
            SettingKind::Choice { of, .. } => Range::OneOf(of.iter().map(ToString::to_string).collect()),
            SettingKind::Number { min, max, step, .. } => Range::Between(*min, *max, *step),
            SettingKind::Integer { min, max, step, .. } => Range::Between(*min as f64, *max as f64, Some(*step as f64)),
        }
    }
}

/// A choice that was made in the page.
#[derive(Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Choice {
    /// Settings get these values, beside those that were chosen before.
    Set(BTreeMap<String, String>),
    /// The preset of this name with settings of these values, and nothing else that was chosen in the page: those of an earlier state.
    Exactly {
        /// The preset; `None`: that of the command line.
        preset: Option<String>,
        /// The settings.
        set: BTreeMap<String, String>,
    },
    /// The preset of this name, and nothing else that was chosen in the page; `None`: that of the command line.
    Preset(Option<String>),
}
