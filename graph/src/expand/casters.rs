//! Cascades of one view, which are looked up together, are cut from it in one way.

use super::order::State;
use crate::describe::{self, Diagnostic};
use crate::frame::{Cascade, Draw, Work};
use crate::view::ViewIndex;
use std::collections::HashMap;

/// Reports passes that cut what one view shows into cascades otherwise than those before them.
pub(super) fn agree(described: &[describe::Pass], states: &[State], errors: &mut Vec<Diagnostic>) {
    let mut first: HashMap<ViewIndex, (Cascade, &describe::Pass)> = HashMap::new();
    for (pass, state) in described.iter().zip(states) {
        let State::On(lowered) = state else { continue };
        let Work::Draw { draw: Draw::Casters(cascade), .. } = lowered.work else { continue };
        let (other, before) = first.entry(pass.view).or_insert((cascade, pass));
        if (other.of, other.reach) != (cascade.of, cascade.reach) {
            let [here, there] = [&cascade, other].map(words);
            let message =
                format!("pass `{}` draws cascades otherwise than pass `{}`", pass.name.text, before.name.text);
            let wrong = Diagnostic::new(pass.name.span, message).remark(here).label(before.name.span, there);
            errors.push(wrong.help("all cascades of a view are of one number and reach: give both the same"));
        }
    }
}

fn words(cascade: &Cascade) -> String {
    let reach = cascade.reach.map_or_else(|| "the whole scene".to_owned(), |reach| format!("{} m", f32::from(reach)));
    format!("one of {} through {reach}", cascade.of)
}
