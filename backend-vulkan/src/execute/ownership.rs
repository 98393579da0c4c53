//! Who has each image or buffer that stands for an external one: this device, or somebody outside.

use framewright_graph::vulkan::OutsideOwner;

/// Who has an external image or buffer between frames, and what became of those that the program imported for it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Ownership {
    /// Who gets it after each frame, as the Plan says: `None`: the device keeps it.
    pub(super) owner: Option<OutsideOwner>,
    /// Those that frames have used.
    held: Vec<HolderRecord>,
}

/// Who has one of them after a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct HolderRecord {
    /// Vulkan's handle.
    raw: u64,
    /// `None`: the device.
    holder: Option<OutsideOwner>,
    /// The last frame that used it, by the number that the program is told.
    frame: u64,
    /// Who had it before that frame, if one had used it.
    before: Option<Option<OutsideOwner>>,
}

impl Ownership {
    /// That of one that no frame has used.
    pub(super) fn of(owner: Option<OutsideOwner>) -> Ownership {
        Ownership { owner, held: Vec::new() }
    }

    /// Who outside of the device has this one now. Before a frame has used it, it is the owner.
    pub(super) fn holder(&self, raw: u64) -> Option<OutsideOwner> {
        self.known(raw).unwrap_or(self.owner)
    }

    /// Takes over what became of those that an executor before this one had.
    pub(super) fn take_over(&mut self, before: &Ownership) {
        if self.held.is_empty() {
            self.held.clone_from(&before.held);
        }
    }

    /// Whether no frame has used any.
    pub(super) fn is_unused(&self) -> bool {
        self.held.is_empty()
    }

    /// Notes that a frame took it, if it was outside, and gave it to the owner.
    pub(super) fn drawn(&mut self, raw: u64, frame: u64) {
        let held = HolderRecord { raw, holder: self.owner, frame, before: self.known(raw) };
        match self.held.iter_mut().find(|it| it.raw == raw) {
            Some(known) => *known = held,
            None => self.held.push(held),
        }
    }

    /// Takes back what a frame did that is never submitted.
    pub(super) fn discard(&mut self, frame: u64) {
        self.held.retain_mut(|it| {
            if it.frame == frame {
                it.holder = it.before.flatten();
            }
            it.frame != frame || it.before.is_some()
        });
    }

    /// Others were imported, or the same anew. What was given away stays so. Of the others the program says who has them: another image
    /// may have the handle of one that it destroyed.
    pub(super) fn imported(&mut self, now: impl Fn(u64) -> bool) {
        self.held.retain(|it| it.holder.is_some() && now(it.raw));
    }

    fn known(&self, raw: u64) -> Option<Option<OutsideOwner>> {
        self.held.iter().find(|it| it.raw == raw).map(|it| it.holder)
    }
}

#[cfg(test)]
mod tests {
    use super::OutsideOwner::{External, Foreign};
    use super::*;

    fn owned_by(owner: OutsideOwner) -> Ownership {
        Ownership::of(Some(owner))
    }

    #[test]
    fn do_11_each_is_taken_from_whom_it_was_given_to() {
        let mut it = owned_by(Foreign);
        assert_eq!(it.holder(1), Some(Foreign), "the owner has it at first");
        it.drawn(1, 0);
        it.owner = None;
        assert_eq!(it.holder(1), Some(Foreign), "it was given away");
        assert_eq!(it.holder(2), None, "no frame has used this one");
        it.drawn(1, 1);
        it.owner = Some(External);
        assert_eq!(it.holder(1), None, "nobody gave it to the new owner yet");
        assert_eq!(it.holder(2), Some(External));
        it.drawn(1, 2);
        it.owner = Some(Foreign);
        assert_eq!(it.holder(1), Some(External));
    }

    #[test]
    fn do_11_a_frame_that_is_never_submitted_gives_nothing_away() {
        let mut it = owned_by(Foreign);
        it.drawn(1, 0);
        it.owner = None;
        it.drawn(1, 1);
        it.drawn(2, 1);
        it.owner = Some(External);
        it.discard(1);
        assert_eq!(it.holder(1), Some(Foreign));
        assert_eq!(it.holder(2), Some(External), "no frame has used it");
    }

    #[test]
    fn do_11_what_was_given_away_and_is_imported_again_is_taken_from_there() {
        let mut it = owned_by(Foreign);
        it.drawn(1, 0);
        it.drawn(2, 1);
        it.owner = None;
        it.drawn(3, 2);
        it.owner = Some(External);
        it.imported(|raw| raw != 2);
        assert_eq!([1, 2, 3].map(|raw| it.holder(raw)), [Foreign, External, External].map(Some));
    }
}
