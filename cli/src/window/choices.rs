//! Settings that keys turn.

use framewright_graph::language::{Setting, SettingKind};

/// A number without steps of its own is turned in so many.
const STEPS: f64 = 20.0;

/// The value after `value`, or before it, of those that a setting allows; the first of a list comes after its last. `None` if there
/// is no other.
pub(super) fn next(setting: &Setting, value: &str, forwards: bool) -> Option<String> {
    let other = match &setting.kind {
        SettingKind::Bool { .. } => (value != "true").to_string(),
        SettingKind::OneOf { of, .. } => around(of, value, forwards)?,
        SettingKind::Choice { of, .. } => around(of, value, forwards)?,
        SettingKind::Integer { min, max, step, .. } => {
            let [min, max, step, now] = [*min, *max, *step, value.parse().ok()?].map(i128::from);
            let at = (now - min) / step + if forwards { 1 } else { -1 };
            (min + at.clamp(0, (max - min) / step) * step).to_string()
        }
        SettingKind::Number { min, max, step, .. } => {
            let (now, range): (f64, f64) = (value.parse().ok()?, max - min);
            let one = if forwards { 1.0 } else { -1.0 };
            let step = step.unwrap_or(range / STEPS);
            let steps = (range / step + 1e-9).floor();
            // If the range is longer than any number, the next whole number.
            let number = match steps.is_finite() {
                true => min + (((now - min) / step).round() + one).clamp(0.0, steps) * step,
                false => now + one,
            };
            number.max(*min).min(*max).to_string()
        }
    };
    (other != value).then_some(other)
}

fn around<T: ToString>(of: &[T], value: &str, forwards: bool) -> Option<String> {
    let at = of.iter().position(|one| one.to_string() == value)?;
    let next = if forwards { at + 1 } else { at + of.len() - 1 };
    of.get(next % of.len()).map(ToString::to_string)
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::base::Sources;
    use framewright_graph::language;

    /// The settings of a pipeline.
    fn settings(text: &str) -> Vec<Setting> {
        let text = format!(
            r#"Pipeline(version: 1, settings: [{text}], images: [(name: "screen", format: Output, size: Output)],
            passes: [(name: "show", draw: FullScreen("plain"), color: ["screen"])], outputs: ["screen"])"#
        );
        let mut sources = Sources::default();
        let read = language::read(&mut sources, "a.ron", "a.ron", text);
        let mistakes = |mistakes: Vec<_>| panic!("{}", framewright_graph::base::render(&sources, &mistakes));
        read.map_or_else(mistakes, |document| document.settings.clone())
    }

    /// The values that a key goes through, from the first on.
    fn walk(setting: &Setting, first: &str, forwards: bool) -> Vec<String> {
        let mut values = vec![first.to_owned()];
        while let Some(value) = next(setting, values.last().expect("one"), forwards) {
            if values.contains(&value) || values.len() > 40 {
                break;
            }
            values.push(value);
        }
        values
    }

    #[test]
    fn keys_reach_each_value_and_leave_none_that_is_not_allowed() {
        let all = settings(
            r#"(name: "a", value: Bool(default: true)), (name: "b", value: OneOf(default: 4, of: [1, 2, 4, 8])),
               (name: "c", value: Number(default: 1.0, min: 0.25, max: 1.0)),
               (name: "d", value: Integer(default: 3, min: 1, max: 10, step: 2)),
               (name: "e", value: Number(default: 1.0, min: 1.0, max: 1.0)),
               (name: "f", value: Number(default: 0.0, min: -1e308, max: 1e308))"#,
        );
        let [a, b, c, d, e, f] = all.as_slice() else { panic!("{all:?}") };
        assert_eq!(walk(a, "true", true), ["true", "false"]);
        assert_eq!(walk(b, "4", true), ["4", "8", "1", "2"]);
        assert_eq!(walk(b, "4", false), ["4", "2", "1", "8"]);
        let numbers = walk(c, "1", false);
        assert_eq!((numbers.len(), &*numbers[20]), (21, "0.25"));
        assert_eq!(walk(c, "0.25", true).last().map(|last| &**last), Some("1"));
        assert_eq!(walk(d, "3", true), ["3", "5", "7", "9"]);
        assert_eq!(walk(d, "3", false), ["3", "1"]);
        assert_eq!(walk(e, "1", true), ["1"]);
        assert_eq!(walk(f, "0", true)[1..3], ["1", "2"]);
        assert_eq!(walk(f, &1e308.to_string(), true).len(), 1);
    }
}
