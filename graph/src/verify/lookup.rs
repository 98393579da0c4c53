//! The dense forms of stages and accesses, looked up: a Plan names few of them, over and over.

use super::scopes::{PairSet, StageSet, impossible};
use crate::vulkan::{Accesses, Stages, Usage};

/// Stages and accesses that a Plan names together, in dense form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scope {
    /// Exactly these stages.
    pub(super) stages: StageSet,
    /// With what a barrier's source waits for, see [`StageSet::and_earlier`].
    pub(super) earlier: StageSet,
    /// With what a barrier's destination holds up, see [`StageSet::and_later`].
    pub(super) later: StageSet,
    /// Every pair of one of the stages and one of the accesses.
    pub(super) pairs: PairSet,
    /// Whether all flags are known, and each access belongs to one of the stages.
    pub(super) sound: bool,
    /// The usages that an image must have for these accesses, other than as an attachment.
    pub(super) usage: Usage,
}

/// The last stages and accesses that were looked up.
#[derive(Debug)]
pub(super) struct Scopes {
    known: [(Stages, Accesses, Scope); Scopes::KNOWN],
}

impl Scope {
    #[inline(never)]
    fn of(stages: Stages, accesses: Accesses) -> Scope {
        let known = Stages::from_bits(stages.bits()).is_some() && Accesses::from_bits(accesses.bits()).is_some();
        let set = StageSet::of(stages);
        Scope {
            stages: set,
            earlier: set.and_earlier(),
            later: set.and_later(),
            pairs: PairSet::of(stages, accesses),
            sound: known && impossible(stages, accesses).is_empty(),
            usage: usage(accesses),
        }
    }
}

impl Scopes {
    const KNOWN: usize = 32;

    pub(super) fn new() -> Scopes {
        let (stages, accesses) = (Stages::empty(), Accesses::empty());
        Scopes { known: [(stages, accesses, Scope::of(stages, accesses)); Scopes::KNOWN] }
    }

    /// The dense form of `stages` and `accesses`.
    #[inline]
    pub(super) fn of(&mut self, stages: Stages, accesses: Accesses) -> Scope {
        // Odd factors with bits all over mix the few bits that are set; the highest ones depend on all of them.
        let mixed =
            stages.bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ accesses.bits().wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let known = &mut self.known[(mixed >> (u64::BITS - Scopes::KNOWN.ilog2())) as usize];
        if (known.0, known.1) != (stages, accesses) {
            *known = (stages, accesses, Scope::of(stages, accesses));
        }
        known.2
    }
}

fn usage(accesses: Accesses) -> Usage {
    let storage = Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE;
    [
        (Accesses::SHADER_SAMPLED_READ, Usage::SAMPLED),
        (storage, Usage::STORAGE),
        (Accesses::INPUT_ATTACHMENT_READ, Usage::INPUT_ATTACHMENT),
        (Accesses::TRANSFER_READ, Usage::TRANSFER_SRC),
        (Accesses::TRANSFER_WRITE, Usage::TRANSFER_DST),
        (Accesses::FRAGMENT_SHADING_RATE_ATTACHMENT_READ_KHR, Usage::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR),
    ]
    .into_iter()
    .filter(|(those, _)| accesses.intersects(*those))
    .fold(Usage::empty(), |all, (_, usage)| all | usage)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_asked_before_changes_no_answer() {
        let mut scopes = Scopes::new();
        for _ in 0..2 {
            for stages in Stages::all().iter().chain([Stages::empty(), Stages::all()]) {
                for accesses in Accesses::all().iter().chain([Accesses::empty(), Accesses::all()]) {
                    assert_eq!(scopes.of(stages, accesses), Scope::of(stages, accesses), "{stages:?} {accesses:?}");
                }
            }
        }
    }
}
