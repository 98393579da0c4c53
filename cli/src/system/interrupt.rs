//! Ctrl-C, and requests to terminate: they don't end the command in the middle of a file, but work stops at its next good moment.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Begins to watch. Where that isn't possible the system's own way of ending a program stays.
pub(crate) fn watch() {
    // The error says that there is a handler already, or that the system has no signals.
    drop(ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) {
            // Asked twice: at once, then.
            framewright_vulkan::end_process(crate::system::Exit::Interrupted as u8);
        }
    }));
}

/// Whether the user asked to stop.
#[must_use]
pub(crate) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
