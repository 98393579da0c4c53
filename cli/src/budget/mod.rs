//! Budgets: upper bounds on what a frame may take, by variant. A Plan beyond a bound is a mistake of the pipeline.
//!
//! ```ron
//! Budget(
//!     version: 1,
//!     limits: [
//!         (resolves: 3, barriers: 20, memory_mib: 64),
//!         (settings: {"msaa": 1}, resolves: 0),
//!         (device: "mali-g78", stored_mib: 24),
//!     ],
//! )
//! ```

mod bound;
mod breach;
mod read;

use bound::Bound;
use framewright_graph::base::Span;
use framewright_graph::plan::Plan;

pub(crate) use read::read;

/// A budget. The default one has no limits.
#[derive(Debug, Default)]
pub(crate) struct Budget {
    limits: Vec<Limit>,
}

/// Bounds for the Plans that meet its conditions.
#[derive(Debug)]
struct Limit {
    /// Its place in the budget's file.
    span: Span,
    /// Settings that a Plan must have, and their values.
    settings: Vec<(String, String)>,
    /// The device that a Plan must be for, by its own name.
    device: Option<String>,
    bounds: Vec<(Bound, f64)>,
}

impl Limit {
    fn is_for(&self, plan: &Plan) -> bool {
        let has = |(name, value): &(String, String)| {
            plan.settings.iter().any(|used| *used.name == **name && used.value == *value)
        };
        self.settings.iter().all(has) && self.device.as_ref().is_none_or(|device| *device == plan.device.name)
    }
}

impl Budget {
    /// The settings that decide which limits hold.
    pub(crate) fn settings(&self) -> impl Iterator<Item = &str> {
        self.limits.iter().flat_map(|limit| limit.settings.iter().map(|(name, _)| name.as_str()))
    }
}
