//! The accesses of steps to subresources so far, and whether a pass can join the last step.

use crate::compile::model::Use;

/// The last steps that used a subresource, by their numbers in execution order. Whether passes can share a scope depends on how they
/// use it, not on its layouts: so this is no [`AccessChain`](crate::compile::access_chain::AccessChain).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Trace {
    /// The last step that used it.
    pub(super) used: Option<usize>,
    /// The last step that wrote it.
    pub(super) written: Option<usize>,
    /// The last scope that wrote it as an attachment.
    pub(super) drawn: Option<usize>,
    /// In what ways the last step that used it did.
    pub(super) ways: ScopeUse,
}

/// Ways in which the passes of one scope use a subresource.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ScopeUse {
    attached: bool,
    sampled: bool,
    stored: bool,
    /// Whether a shader writes it.
    shaded: bool,
}

impl ScopeUse {
    /// Whether a use can't be in one scope with these.
    pub(super) fn clash(self, used: &Use) -> bool {
        let ScopeUse { attached, sampled, stored, shaded } = self;
        let others = if used.role.is_sampled() { stored } else { sampled };
        match used.role.is_attachment() {
            true => sampled || stored,
            false => attached || shaded || others || (used.writes && (sampled || stored)),
        }
    }

    pub(super) fn add(&mut self, used: &Use) {
        self.attached |= used.role.is_attachment();
        self.sampled |= used.role.is_sampled();
        self.stored |= used.role.is_stored();
        self.shaded |= !used.role.is_attachment() && used.writes;
    }
}
