//! The gain of passes that share a rendering scope. Its bytes are counted for the Plan: sizes may have changed by then.

use super::step::{Scope, Target, op_name, resource_name};
use crate::compile::model::{AdaptedFrame, Use};
use crate::frame::Frame;
use crate::plan::Reason;

/// The gain of a pass by joining the scope before it.
#[derive(Debug, Clone)]
pub(super) enum Gain {
    /// It draws into attachments that the scope has already.
    Shared {
        /// The last operation of the scope so far.
        before: Option<u32>,
        attachments: Vec<Target>,
    },
    /// It reads at its own position what the scope drew.
    ReadLocally(Target),
}

impl Gain {
    /// The gain of an operation with these uses that joins `scope`.
    pub(super) fn shared(adapted: &AdaptedFrame, scope: &Scope, uses: &[Use]) -> Gain {
        let attached = |used: &&Use| used.role.is_attachment() && scope.attaches(adapted, used);
        let attachments = uses.iter().filter(attached).map(|used| Target::of(adapted, used)).collect();
        Gain::Shared { before: scope.ops.last().copied(), attachments }
    }

    pub(super) fn read_locally(adapted: &AdaptedFrame, used: &Use) -> Gain {
        Gain::ReadLocally(Target::of(adapted, used))
    }

    pub(super) fn reason(&self, frame: &Frame, adapted: &AdaptedFrame) -> Reason {
        let name = |target: &Target| resource_name(frame, adapted, target.resource).clone();
        let bytes = |target: &Target| adapted.bytes(target.resource, target.range);
        match self {
            Gain::Shared { before, attachments } => Reason::SharesAttachments {
                attachments: attachments.iter().map(name).collect(),
                before: before.and_then(|op| op_name(frame, adapted, op)).cloned(),
                bytes: attachments.iter().map(bytes).fold(0, u64::saturating_add),
            },
            Gain::ReadLocally(target) => Reason::ReadsLocally { image: name(target), bytes: bytes(target) },
        }
    }
}
