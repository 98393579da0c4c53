//! The values of settings that are tried.

use framewright_graph::expression::Value;
use framewright_graph::language::{SettingKind, last_step, nth_step};

/// Whole numbers up to this many are all tried.
const MOST_INTEGERS: i128 = 16;

/// Numbers with up to this many steps are all tried.
const MOST_STEPS: f64 = 16.0;

/// A value as the command line has it; numbers so that they read as the very same.
#[must_use]
pub fn text(value: &Value) -> String {
    match value {
        Value::Number(number) => format!("{number:?}"),
        Value::Text(text) => text.to_string(),
        other => other.to_string(),
    }
}

/// Values of a setting that are tried, the default first.
#[must_use]
pub fn values(kind: &SettingKind) -> Vec<String> {
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
