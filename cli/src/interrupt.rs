//! Ctrl-C (and a request to terminate): work stops at its next good moment, so that no file is left half-written.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Begins to watch. Where that isn't possible the system's own way of ending a program stays.
pub(crate) fn watch() {
    // The error says that there is a handler already, or that the system has no signals.
    drop(ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) {
            // Asked twice: at once, then.
            std::process::exit(crate::error::Exit::Interrupted as i32);
        }
    }));
}

/// Whether the user asked to stop.
#[must_use]
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
