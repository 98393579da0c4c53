//! A Plan's totals, in words.

use crate::system::text;
use framewright_graph::plan::Totals;

/// Its passes, scopes, resolves, barriers and memory, for a device that isn't here.
pub(crate) fn estimated(totals: &Totals) -> String {
    sentence(totals) + " (estimated)"
}

/// Its passes, scopes, resolves, barriers and memory.
pub(crate) fn sentence(totals: &Totals) -> String {
    let waits = match totals.waits {
        0 => String::new(),
        waits => format!("{} between queues, ", text::count(waits as usize, "wait", "waits")),
    };
    format!(
        "{} in {}, {}, {}, {waits}{} placed in {}",
        text::count((totals.passes + totals.inserted_passes) as usize, "pass", "passes"),
        text::count(totals.scopes as usize, "rendering scope", "rendering scopes"),
        text::count(totals.resolves as usize, "resolve", "resolves"),
        text::count((totals.image_barriers + totals.memory_barriers) as usize, "barrier", "barriers"),
        text::bytes(totals.transient_bytes),
        text::bytes(totals.placed_bytes),
    )
}
