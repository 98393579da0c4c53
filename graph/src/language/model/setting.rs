//! A setting: a value that a user may choose, of one of five kinds.

use crate::base::{enumerated, shown_number};
use crate::expression::{Type, Value};
use crate::ron::Name;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// A value that a user may choose.
#[derive(Debug, Clone)]
pub struct Setting {
    /// Unique name.
    pub name: Name,
    /// Its type, its default and its allowed values.
    pub kind: SettingKind,
    /// A description for people.
    pub about: Option<String>,
}

/// A setting's type, default and allowed values. The default is always allowed.
#[derive(Debug, Clone, PartialEq)]
pub enum SettingKind {
    /// `true` or `false`.
    Bool {
        /// The value without a choice.
        default: bool,
    },
    /// One of a few whole numbers.
    OneOf {
        /// The value without a choice.
        default: i64,
        /// The allowed values; not empty.
        of: Vec<i64>,
    },
    /// One of a few texts.
    Choice {
        /// The value without a choice.
        default: Arc<str>,
        /// The allowed values; not empty.
        of: Vec<Arc<str>>,
    },
    /// A finite number.
    Number {
        /// The value without a choice.
        default: f64,
        /// Least allowed.
        min: f64,
        /// Greatest allowed.
        max: f64,
        /// The distance from one allowed value to the next, counted from `min`; `None`: all between are allowed.
        step: Option<f64>,
    },
    /// A whole number.
    Integer {
        /// The value without a choice.
        default: i64,
        /// Least allowed.
        min: i64,
        /// Greatest allowed.
        max: i64,
        /// The distance from one allowed value to the next, counted from `min`; at least 1.
        step: i64,
    },
}

impl SettingKind {
    /// The name in messages.
    #[must_use]
    pub fn words(&self) -> &'static str {
        match self {
            SettingKind::Bool { .. } => "`true` or `false`",
            SettingKind::OneOf { .. } => "one of several whole numbers",
            SettingKind::Choice { .. } => "one of several texts",
            SettingKind::Number { .. } => "a number",
            SettingKind::Integer { .. } => "a whole number",
        }
    }

    /// The allowed values, for people.
    #[must_use]
    pub fn allowed(&self) -> String {
        match self {
            SettingKind::Bool { .. } => "`true` or `false`".to_owned(),
            SettingKind::OneOf { of, .. } => format!("one of {}", enumerated(of.iter())),
            SettingKind::Choice { of, .. } => {
                format!("one of {}", enumerated(of.iter().map(|text| format!("`{text}`"))))
            }
            SettingKind::Number { min, max, step, .. } => {
                let steps = step.map(|step| format!(" in steps of {}", shown_number(step))).unwrap_or_default();
                format!("a number{}{steps}", between([*min, *max], [f64::MIN, f64::MAX], shown_number))
            }
            SettingKind::Integer { min, max, step, .. } => {
                let steps = if *step == 1 { String::new() } else { format!(" in steps of {step}") };
                let range = between([*min, *max], [i64::MIN, i64::MAX], |bound| bound.to_string());
                format!("a whole number{range}{steps}")
            }
        }
    }

    /// The allowed values, for people who tried `value`; if that lies between two steps, with the nearest allowed numbers.
    #[must_use]
    pub fn instead_of(&self, value: &Value) -> String {
        let nearest = match (self, value) {
            (SettingKind::Number { min, max, step: Some(step), .. }, Value::Number(value))
                if (min..=max).contains(&value) =>
            {
                let below = ((value - min) / step).floor();
                let above = Some(below + 1.0).filter(|above| *above <= last_step(*min, *max, *step));
                Some([Some(below), above].map(|steps| steps.map(|steps| shown_number(nth(*min, *step, steps)))))
            }
            (SettingKind::Integer { min, max, step, .. }, Value::Integer(value)) if (min..=max).contains(&value) => {
                let [least, step] = [min, step].map(|number| i128::from(*number));
                let below = i128::from(*value) - (i128::from(*value) - least) % step;
                let above = Some(below + step).filter(|above| *above <= i128::from(*max));
                Some([Some(below), above].map(|number| number.map(|number| number.to_string())))
            }
            _ => None,
        };
        let nearest = match nearest.filter(|_| !self.allows(value)) {
            Some([Some(below), Some(above)]) => format!("; the nearest are {below} and {above}"),
            Some([Some(only), None] | [None, Some(only)]) => format!("; the nearest is {only}"),
            Some([None, None]) | None => String::new(),
        };
        format!("it is {}{nearest}", self.allowed())
    }

    /// The value without a choice.
    #[must_use]
    pub fn default(&self) -> Value {
        match self {
            SettingKind::Bool { default } => Value::Bool(*default),
            SettingKind::OneOf { default, .. } | SettingKind::Integer { default, .. } => Value::Integer(*default),
            SettingKind::Choice { default, .. } => Value::Text(default.clone()),
            SettingKind::Number { default, .. } => Value::Number(*default),
        }
    }

    /// The type of its values.
    #[must_use]
    pub const fn ty(&self) -> Type {
        match self {
            SettingKind::Bool { .. } => Type::Bool,
            SettingKind::OneOf { .. } | SettingKind::Integer { .. } => Type::Integer,
            SettingKind::Choice { .. } => Type::Text,
            SettingKind::Number { .. } => Type::Number,
        }
    }

    /// Whether it allows a value. A number may be off its step by rounding.
    #[must_use]
    pub fn allows(&self, value: &Value) -> bool {
        match (self, value) {
            (SettingKind::Bool { .. }, Value::Bool(_)) => true,
            (SettingKind::OneOf { of, .. }, Value::Integer(value)) => of.contains(value),
            (SettingKind::Choice { of, .. }, Value::Text(value)) => of.contains(value),
            (SettingKind::Number { min, max, step, .. }, Value::Number(value)) => {
                (min..=max).contains(&value) && step.is_none_or(|step| on_step(value - min, step))
            }
            (SettingKind::Integer { min, max, step, .. }, Value::Integer(value)) => {
                // The distance is beyond 64 bits if `min` is far below 0.
                let from_min = i128::from(*value) - i128::from(*min);
                (min..=max).contains(&value) && from_min % i128::from(*step) == 0
            }
            _ => false,
        }
    }
}

/// Whether `distance` is a whole number of steps, up to rounding.
fn on_step(distance: f64, step: f64) -> bool {
    let steps = distance / step;
    (steps - steps.round()).abs() <= 1e-9 * steps.abs().max(1.0)
}

/// The number of steps from `min` to the greatest value that they reach. A last step that only rounding takes beyond `max` counts.
#[must_use]
pub fn last_step(min: f64, max: f64, step: f64) -> f64 {
    ((max - min) / step * (1.0 + 1e-9)).floor()
}

/// The number `steps` steps above `min`, without the last digits, which rounding makes.
#[must_use]
pub fn nth(min: f64, step: f64, steps: f64) -> f64 {
    let number = min + steps * step;
    let short = format!("{number:.12e}").parse().unwrap_or(number);
    if on_step(short - min, step) { short } else { number }
}

impl SettingKind {
    /// Whether its values are whole numbers.
    pub(crate) fn is_whole(&self) -> bool {
        matches!(self, SettingKind::OneOf { .. } | SettingKind::Integer { .. })
    }

    /// Whether its values are numbers.
    pub(crate) fn is_number(&self) -> bool {
        matches!(self, SettingKind::OneOf { .. } | SettingKind::Integer { .. } | SettingKind::Number { .. })
    }

    /// A whole number that it allows and that lies outside of `range`.
    pub(crate) fn whole_beyond(&self, range: &RangeInclusive<i64>) -> Option<i64> {
        match self {
            SettingKind::OneOf { of, .. } => of.iter().find(|value| !range.contains(value)).copied(),
            SettingKind::Integer { min, max, .. } => [*min, *max].into_iter().find(|value| !range.contains(value)),
            SettingKind::Bool { .. } | SettingKind::Choice { .. } | SettingKind::Number { .. } => None,
        }
    }

    /// The least number that it allows, if its values are numbers.
    pub(crate) fn least(&self) -> Option<f64> {
        #[allow(clippy::cast_precision_loss, reason = "only whether it is greater than 0 matters")]
        match self {
            SettingKind::Number { min, .. } => Some(*min),
            SettingKind::Integer { min, .. } => Some(*min as f64),
            SettingKind::OneOf { of, .. } => of.iter().min().map(|least| *least as f64),
            SettingKind::Bool { .. } | SettingKind::Choice { .. } => None,
        }
    }
}

/// The words for a range. An end that is that of `whole` is left out, since the file says none.
pub(crate) fn between<T: PartialEq + Copy>([min, max]: [T; 2], whole: [T; 2], shown: impl Fn(T) -> String) -> String {
    match (min == whole[0], max == whole[1]) {
        (false, false) => format!(" from {} to {}", shown(min), shown(max)),
        (false, true) => format!(" of at least {}", shown(min)),
        (true, false) => format!(" of at most {}", shown(max)),
        (true, true) => String::new(),
    }
}
