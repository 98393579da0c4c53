//! What the list tells.

use crate::system::text;
use crate::window::chosen_setting::ChosenSetting;
use crate::window::pace::Speed;
use framewright::Renderer;
use framewright_graph::language::ChosenBy;
use framewright_lab::timings::Row;

/// What the list tells. All texts are escaped.
#[derive(Debug, Clone, Default, PartialEq)]
pub(in crate::window) struct Contents {
    /// The pipeline and the size of its picture.
    pub(super) title: String,
    /// The preset in force.
    pub(super) preset: Option<String>,
    /// How fast frames are shown.
    pub(super) speed: String,
    /// What keeps the newest files and choices from being shown.
    pub(super) wrong: Option<String>,
    /// The settings.
    pub(super) settings: Vec<Entry>,
    /// Times of passes on the device in milliseconds, the longest first.
    pub(super) times: Vec<(String, f64)>,
}

/// A setting.
#[derive(Debug, Clone, Default, PartialEq)]
pub(in crate::window) struct Entry {
    pub(super) name: String,
    pub(super) value: String,
    /// The values that it may have, if it is the one that keys turn.
    pub(super) allowed: Option<String>,
}

impl Contents {
    /// What the list tells of the pipeline `name`, whose picture has this size.
    pub(in crate::window) fn of(
        name: &str,
        [width, height]: [u32; 2],
        renderer: &Renderer,
        chosen: &ChosenSetting,
        speed: Option<Speed>,
        wrong: Option<&str>,
        times: &[Row],
    ) -> Contents {
        let speed = speed.map_or_else(String::new, |Speed { milliseconds, each_second }| {
            format!("{milliseconds:.1} ms · {each_second:.0} frames/s")
        });
        let turned = chosen.setting(renderer).map(|(setting, _)| &setting.name.text);
        let settings = renderer.document().settings.iter().filter_map(|setting| {
            let kind = &setting.kind;
            Some(Entry {
                name: text::escape(&setting.name.text),
                value: text::escape(chosen.value(renderer, setting)?),
                allowed: (turned == Some(&setting.name.text)).then(|| text::escape(&kind.allowed())),
            })
        });
        Contents {
            title: text::escape(&format!("{name} · {width}×{height}")),
            preset: preset(renderer),
            speed,
            wrong: wrong.and_then(|wrong| wrong.lines().next()).map(text::escape),
            settings: settings.collect(),
            times: times.iter().map(|row| (named(row), row.gpu_milliseconds)).collect(),
        }
    }
}

/// The preset in force, by the values that it chose.
fn preset(renderer: &Renderer) -> Option<String> {
    renderer.document().in_force().iter().find_map(|in_force| match &in_force.by {
        ChosenBy::Preset(name) => Some(text::escape(name)),
        _ => None,
    })
}

/// A pass, or the work that was inserted.
fn named(row: &Row) -> String {
    let inserted = row.inserted.map_or_else(String::new, |word| format!("{word} "));
    text::escape(&format!("{inserted}{}", row.name))
}
