//! Conditions meet settings and facts.

use super::{Chosen, settings};
use crate::describe::{Condition, Subject, Term};
use crate::frame::ParamValue;

/// `None` if the condition holds; else the values that make it fail: "tone_mapping = false".
pub(super) fn failing(chosen: &Chosen<'_>, condition: &Condition) -> Option<String> {
    let mut values: Vec<String> = Vec::new();
    for group in &condition.any {
        let failing: Vec<String> = group.iter().filter_map(|term| failing_term(chosen, *term)).collect();
        if failing.is_empty() {
            return None;
        }
        for value in failing {
            if !values.contains(&value) {
                values.push(value);
            }
        }
    }
    Some(values.join(", "))
}

fn failing_term(chosen: &Chosen<'_>, term: Term) -> Option<String> {
    let (name, holds) = match term.subject {
        Subject::Setting(reference) => {
            let (setting, value) = chosen.setting(reference);
            (&*setting.name.text, matches!(value, ParamValue::Bool(true)))
        }
        Subject::Fact(fact) => (fact.name(), chosen.facts.holds(fact)),
    };
    (holds == term.negated).then(|| format!("{name} = {}", settings::show(ParamValue::Bool(holds))))
}
