//! The tree form of a Plan, for people.

use super::Plan;

/// The tree form.
pub(super) fn tree(_plan: &Plan) -> String {
    String::new()
}
