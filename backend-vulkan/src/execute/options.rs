//! How a Plan is executed.

use crate::prepare::{Debugging, Preparation};
use std::time::Duration;

/// How a Plan is executed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExecutorOptions {
    /// Whether each transient image and buffer is filled with conspicuous values when the frame takes it into use, which
    /// must not change the picture. Needs a Plan that was compiled with poison.
    pub poison: bool,
    /// Whether each step waits for all that its queue did before, whatever the Plan's barriers say. The picture must be the same:
    /// if it isn't, a barrier is missing without this.
    pub full_barriers: bool,
    /// Whether each step is submitted by itself and waited for before the next. The picture must be the same, and a device that
    /// is lost or doesn't answer is told with its step ([`AtStep`](crate::Error::AtStep)). Such a frame goes into no command buffer of the program's.
    pub step_by_step: bool,
    /// Whether the device notes for the host each step that it begins. If the device is lost or doesn't answer, the error names the step
    /// that each queue was at ([`AtStep`](crate::Error::AtStep)). Each step then waits for all before it, as with `full_barriers`; the host
    /// waits for none. A lost device may take its notes with it.
    pub breadcrumbs: bool,
    /// Whether what custom passes do is held against what the pipeline says of them, to look for mistakes:
    ///
    /// - What a pass doesn't write must be the same after it.
    /// - What it doesn't name holds garbage while its commands run, and then what it held before: a pass that reads it shows another picture.
    /// - What it writes and doesn't read holds garbage before it where the Plan gives up what was there, and all of it must be set. That
    ///   takes two frames.
    /// - What the program asks the recorder of a pass for, the pass names.
    /// - What the validation layer finds is led back to what passes [declare](framewright_graph::frame::DeclaredUse). Under the layer,
    ///   contents are looked at in every second frame in which a pass runs, from the second on, since to look takes barriers, which hide hazards;
    ///   those of a pass that runs once in that frame.
    ///
    /// A broken promise is an error of the call that waits for the frame, or for it to make room for another one
    /// ([`BrokenPromises`](crate::Error::BrokenPromises)), and is told once; the frame is done all the same. What frames did that nobody waits
    /// for, the next such call tells, or that of an executor that [goes on](crate::Executor::migrate_from) from this one; if there is none, it isn't
    /// told. Attachments of rendering scopes,
    /// images of several samples and textures from files aren't looked at, and depth and compressed images hold no garbage. Needs a Plan
    /// that was compiled as [`readable`](framewright_graph::compile::Options::readable), and for each such pass three times the memory of
    /// all that lives beside it, which the host can read. A Plan for several queues is executed step by step.
    pub check_uses: bool,
    /// How long the device may take for a frame. If it takes longer the device is given up: nothing that was made from it
    /// can be used any more.
    pub timeout: Duration,
    /// How many frames may be on their way before [`submit`](crate::Executor::submit) waits for the oldest; 0 counts as 1.
    pub frames_in_flight: u32,
    /// Whether each frame copies its outputs to the host (colour or depth of the first mip level), for
    /// [`read_back_image`](crate::Executor::read_back_image) and [`read_back_buffer`](crate::Executor::read_back_buffer).
    pub readback: bool,
    /// Whether the device notes when each step and pass begins and ends, for [`report`](crate::Executor::report). That takes commands of its own,
    /// and some devices finish one pass before they begin the next to tell the time.
    pub timestamps: bool,
    /// Whether the device counts how often fragment shaders run, for [`report`](crate::Executor::report). Custom passes can't make queries of the
    /// same kind then.
    pub fragment_counts: bool,
}

impl ExecutorOptions {
    /// How frames are prepared.
    pub(super) fn preparation(&self) -> Preparation {
        let debugging = Debugging { poison: self.poison, full_barriers: self.full_barriers };
        Preparation { debugging, frames_in_flight: self.frames_in_flight.max(1) }
    }
}

impl Default for ExecutorOptions {
    fn default() -> Self {
        let timeout = Duration::from_secs(120);
        ExecutorOptions {
            poison: false,
            full_barriers: false,
            step_by_step: false,
            breadcrumbs: false,
            check_uses: false,
            timeout,
            frames_in_flight: 1,
            readback: false,
            timestamps: false,
            fragment_counts: false,
        }
    }
}
