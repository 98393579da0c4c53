//! What people look at, in the page of a program: it is the same for all who look.

use serde::Deserialize;

/// What is looked at.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Look {
    /// The renderer that was chosen, by its id; `None`: the first.
    pub(crate) renderer: Option<u64>,
    /// Whether the frame that is shown stays.
    pub(crate) held: bool,
    /// How often the next frame was asked for while one was held.
    pub(crate) steps: u64,
}

/// A change to it that was made in the page.
#[derive(Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum LookChange {
    /// The renderer of this id is looked at.
    Renderer(u64),
    /// The frame that is shown stays, or doesn't any more.
    Hold(bool),
    /// The next frame is shown, and stays.
    Step,
}

impl Look {
    pub(super) fn take(&mut self, change: LookChange) {
        match change {
            LookChange::Renderer(id) => self.renderer = Some(id),
            LookChange::Hold(held) => self.held = held,
            LookChange::Step => {
                self.held = true;
                self.steps = self.steps.wrapping_add(1);
            }
        }
    }
}
