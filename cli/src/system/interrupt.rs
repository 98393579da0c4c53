//! Signals: none ends the command in the middle of a file.
//!
//! After Ctrl-C (and a request to terminate) work stops at its next good moment. A file that grows beyond what the user may
//! write (`ulimit -f`) is an error like a full disk.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Has too large a file answered by an error of the write. To be called before there are other threads, which take it over.
pub(crate) fn survive_large_files() {
    #[cfg(unix)]
    {
        use nix::sys::signal::{SigSet, Signal};
        // That can only fail for a signal that doesn't exist.
        let _ = SigSet::from(Signal::SIGXFSZ).thread_block();
    }
}

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
