//! Giving up waits for the device before they are over.

use std::fmt;
use std::sync::OnceLock;
use std::time::Duration;

/// How often a wait asks whether it is to be given up.
pub(crate) const SLICE: Duration = Duration::from_millis(50);

/// The function that says whether waits are to be given up, if there is one.
#[derive(Default)]
pub(crate) struct Cancel(OnceLock<Box<dyn Fn() -> bool + Send + Sync>>);

impl Cancel {
    /// Sets the function that says so. The first one set stays.
    pub(crate) fn when(&self, asked: impl Fn() -> bool + Send + Sync + 'static) {
        let _ = self.0.set(Box::new(asked));
    }

    /// Whether waits are to be given up.
    pub(crate) fn is_asked(&self) -> bool {
        self.0.get().is_some_and(|asked| asked())
    }
}

impl fmt::Debug for Cancel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Cancel").field(&self.0.get().is_some()).finish()
    }
}
