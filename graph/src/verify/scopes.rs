//! Stages and accesses in a dense form: one bit a stage, one bit a pair of stage and access.
//!
//! Only accesses that an image or a buffer can have form a pair. The order of the graphics pipeline's stages, and the stages
//! of each access, are those of the Vulkan specification, chapter "Synchronization and Cache Control".

use crate::vulkan::{Accesses, Stages};

/// Number of stages.
pub(super) const STAGES: usize = 13;
/// Number of pairs that write; they come first.
pub(super) const WRITE_PAIRS: usize = 11;
/// Number of pairs.
pub(super) const PAIRS: usize = 31;

/// A set of stages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct StageSet(pub(super) u16);

/// A set of pairs of stage and access.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct PairSet(pub(super) u32);

const DRAW_INDIRECT: usize = 0;
const VERTEX_INPUT: usize = 1;
const VERTEX_SHADER: usize = 2;
const FRAGMENT_SHADER: usize = 3;
const EARLY_TESTS: usize = 4;
const LATE_TESTS: usize = 5;
const COLOR_OUTPUT: usize = 6;
const COMPUTE_SHADER: usize = 7;
const HOST: usize = 8;
const COPY: usize = 9;
const RESOLVE: usize = 10;
const BLIT: usize = 11;
const CLEAR: usize = 12;

/// The graphics pipeline in logical order: indirect, vertex input, vertex shader, early tests, fragment shader, late
/// tests, colour output.
const PIPELINE: [usize; 7] =
    [DRAW_INDIRECT, VERTEX_INPUT, VERTEX_SHADER, EARLY_TESTS, FRAGMENT_SHADER, LATE_TESTS, COLOR_OUTPUT];

/// Everything but the host: `ALL_COMMANDS` leaves it out.
const ALL_COMMANDS: u16 = ((1 << STAGES) - 1) & !(1 << HOST);

const PAIR: [(usize, Accesses); PAIRS] = [
    (VERTEX_SHADER, Accesses::SHADER_STORAGE_WRITE),
    (FRAGMENT_SHADER, Accesses::SHADER_STORAGE_WRITE),
    (COMPUTE_SHADER, Accesses::SHADER_STORAGE_WRITE),
    (EARLY_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE),
    (LATE_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE),
    (COLOR_OUTPUT, Accesses::COLOR_ATTACHMENT_WRITE),
    (COPY, Accesses::TRANSFER_WRITE),
    (RESOLVE, Accesses::TRANSFER_WRITE),
    (BLIT, Accesses::TRANSFER_WRITE),
    (CLEAR, Accesses::TRANSFER_WRITE),
    (HOST, Accesses::HOST_WRITE),
    (VERTEX_SHADER, Accesses::SHADER_SAMPLED_READ),
    (FRAGMENT_SHADER, Accesses::SHADER_SAMPLED_READ),
    (COMPUTE_SHADER, Accesses::SHADER_SAMPLED_READ),
    (VERTEX_SHADER, Accesses::SHADER_STORAGE_READ),
    (FRAGMENT_SHADER, Accesses::SHADER_STORAGE_READ),
    (COMPUTE_SHADER, Accesses::SHADER_STORAGE_READ),
    (EARLY_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_READ),
    (LATE_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_READ),
    (COLOR_OUTPUT, Accesses::COLOR_ATTACHMENT_READ),
    (COPY, Accesses::TRANSFER_READ),
    (RESOLVE, Accesses::TRANSFER_READ),
    (BLIT, Accesses::TRANSFER_READ),
    (HOST, Accesses::HOST_READ),
    (DRAW_INDIRECT, Accesses::INDIRECT_COMMAND_READ),
    (VERTEX_INPUT, Accesses::INDEX_READ),
    (VERTEX_INPUT, Accesses::VERTEX_ATTRIBUTE_READ),
    (VERTEX_SHADER, Accesses::UNIFORM_READ),
    (FRAGMENT_SHADER, Accesses::UNIFORM_READ),
    (COMPUTE_SHADER, Accesses::UNIFORM_READ),
    (FRAGMENT_SHADER, Accesses::INPUT_ATTACHMENT_READ),
];

const EARLIER: [u16; STAGES] = closure(true);
const LATER: [u16; STAGES] = closure(false);
const PAIRS_OF_STAGE: [u32; STAGES] = pairs_of_stages();
const PAIRS_OF_ACCESS: [u32; 32] = pairs_of_accesses();
/// The accesses that happen in each stage.
const ACCESSES_OF_STAGE: [u32; STAGES] = accesses_of_stages();

const fn closure(earlier: bool) -> [u16; STAGES] {
    let mut reach = [0; STAGES];
    let mut stage = 0;
    while stage < STAGES {
        reach[stage] = 1 << stage;
        stage += 1;
    }
    let mut first = 0;
    while first < PIPELINE.len() {
        let mut second = first;
        while second < PIPELINE.len() {
            if earlier {
                reach[PIPELINE[second]] |= 1 << PIPELINE[first];
            } else {
                reach[PIPELINE[first]] |= 1 << PIPELINE[second];
            }
            second += 1;
        }
        first += 1;
    }
    // A compute pipeline is two stages long: indirect, compute.
    if earlier {
        reach[COMPUTE_SHADER] |= 1 << DRAW_INDIRECT;
    } else {
        reach[DRAW_INDIRECT] |= 1 << COMPUTE_SHADER;
    }
    reach
}

const fn pairs_of_stages() -> [u32; STAGES] {
    let mut pairs = [0; STAGES];
    let mut pair = 0;
    while pair < PAIRS {
        pairs[PAIR[pair].0] |= 1 << pair;
        pair += 1;
    }
    pairs
}

const fn accesses_of_stages() -> [u32; STAGES] {
    let mut accesses = [0; STAGES];
    let mut pair = 0;
    while pair < PAIRS {
        accesses[PAIR[pair].0] |= PAIR[pair].1.bits();
        pair += 1;
    }
    accesses
}

/// The pairs of each access, by the number of its bit.
const fn pairs_of_accesses() -> [u32; 32] {
    let mut pairs = [0; 32];
    let mut pair = 0;
    while pair < PAIRS {
        pairs[PAIR[pair].1.bits().trailing_zeros() as usize] |= 1 << pair;
        pair += 1;
    }
    pairs[Accesses::MEMORY_WRITE.bits().trailing_zeros() as usize] = WRITES;
    pairs[Accesses::MEMORY_READ.bits().trailing_zeros() as usize] = !WRITES & ((1 << PAIRS) - 1);
    pairs
}

const WRITES: u32 = (1 << WRITE_PAIRS) - 1;

impl StageSet {
    /// Every stage of a device.
    pub(super) const ALL: StageSet = StageSet(ALL_COMMANDS);

    /// Exactly these stages; `ALL_COMMANDS` stands for every one on a device.
    pub(super) fn of(stages: Stages) -> StageSet {
        let bits = stages.bits();
        // Bits 1–3, 7–11, 14 and 24–27, pushed together.
        let dense = (bits >> 1 & 0x7) | (bits >> 4 & 0xf8) | (bits >> 6 & 0x100) | (bits >> 15 & 0x1e00);
        let all = if stages.contains(Stages::ALL_COMMANDS) { ALL_COMMANDS } else { 0 };
        StageSet(dense as u16 | all)
    }

    /// With every stage of the same pipeline that logically comes before: what a barrier's source waits for.
    pub(super) fn and_earlier(self) -> StageSet {
        self.spread(&EARLIER)
    }

    /// With every stage of the same pipeline that logically comes after: what a barrier's destination holds up.
    pub(super) fn and_later(self) -> StageSet {
        self.spread(&LATER)
    }

    fn spread(self, reach: &[u16; STAGES]) -> StageSet {
        StageSet(self.iter().fold(0, |set, stage| set | reach[stage]))
    }

    pub(super) fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether all of `other` is among these.
    pub(super) fn contains_all(self, other: StageSet) -> bool {
        other.0 & !self.0 == 0
    }

    /// Indices of its stages.
    pub(super) fn iter(self) -> impl Iterator<Item = usize> {
        bits(self.0.into())
    }

    pub(super) fn contains(self, stage: usize) -> bool {
        self.0 >> stage & 1 == 1
    }

    pub(super) fn union(self, other: StageSet) -> StageSet {
        StageSet(self.0 | other.0)
    }
}

impl PairSet {
    /// Every pair of one of these stages, as they are written, and one of these accesses.
    pub(super) fn of(stages: Stages, accesses: Accesses) -> PairSet {
        let of_accesses = bits(accesses.bits().into()).fold(0, |set, access| set | PAIRS_OF_ACCESS[access]);
        PairSet(PairSet::of_stages(StageSet::of(stages)).0 & of_accesses)
    }

    /// One pair.
    pub(super) fn only(pair: usize) -> PairSet {
        PairSet(1 << pair)
    }

    /// Every pair of one of these stages.
    pub(super) fn of_stages(stages: StageSet) -> PairSet {
        PairSet(stages.iter().fold(0, |set, stage| set | PAIRS_OF_STAGE[stage]))
    }

    pub(super) fn writes(self) -> PairSet {
        PairSet(self.0 & WRITES)
    }

    pub(super) fn reads(self) -> PairSet {
        PairSet(self.0 & !WRITES)
    }

    pub(super) fn iter(self) -> impl Iterator<Item = usize> {
        bits(self.0.into())
    }

    pub(super) fn contains(self, pair: usize) -> bool {
        self.0 >> pair & 1 == 1
    }

    pub(super) fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether all of `other` is among these.
    pub(super) fn contains_all(self, other: PairSet) -> bool {
        other.0 & !self.0 == 0
    }

    /// These without those of `other`.
    pub(super) fn without(self, other: PairSet) -> PairSet {
        PairSet(self.0 & !other.0)
    }

    pub(super) fn union(self, other: PairSet) -> PairSet {
        PairSet(self.0 | other.0)
    }

    /// The stages that its pairs happen in.
    pub(super) fn stages(self) -> StageSet {
        StageSet(self.iter().fold(0, |set, pair| set | 1 << PAIR[pair].0))
    }
}

/// The stage of a pair.
pub(super) fn stage_of(pair: usize) -> usize {
    PAIR[pair].0
}

/// A pair in Vulkan's words.
pub(super) fn words(pair: usize) -> (Stages, Accesses) {
    (stage_word(PAIR[pair].0), PAIR[pair].1)
}

/// A stage in Vulkan's words.
pub(super) fn stage_word(stage: usize) -> Stages {
    const WORDS: [Stages; STAGES] = [
        Stages::DRAW_INDIRECT,
        Stages::VERTEX_INPUT,
        Stages::VERTEX_SHADER,
        Stages::FRAGMENT_SHADER,
        Stages::EARLY_FRAGMENT_TESTS,
        Stages::LATE_FRAGMENT_TESTS,
        Stages::COLOR_ATTACHMENT_OUTPUT,
        Stages::COMPUTE_SHADER,
        Stages::HOST,
        Stages::COPY,
        Stages::RESOLVE,
        Stages::BLIT,
        Stages::CLEAR,
    ];
    WORDS[stage]
}

/// Accesses among `accesses` that none of `stages` can make.
pub(super) fn impossible(stages: Stages, accesses: Accesses) -> Accesses {
    if stages.contains(Stages::ALL_COMMANDS) {
        return accesses & (Accesses::HOST_READ | Accesses::HOST_WRITE);
    }
    let any = Accesses::MEMORY_READ | Accesses::MEMORY_WRITE;
    let possible = StageSet::of(stages).iter().fold(any.bits(), |all, stage| all | ACCESSES_OF_STAGE[stage]);
    accesses.difference(Accesses::from_bits_retain(possible))
}

fn bits(mut set: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lowest = set.trailing_zeros();
        set &= set.checked_sub(1)?;
        Some(lowest as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_has_its_own_bit_and_keeps_its_name() {
        let mut seen = 0;
        for stage in Stages::all().difference(Stages::ALL_COMMANDS).iter() {
            let set = StageSet::of(stage);
            assert_eq!(set.0.count_ones(), 1, "{stage:?}");
            assert_eq!(seen & set.0, 0, "{stage:?}");
            seen |= set.0;
        }
        assert_eq!(seen.count_ones() as usize, STAGES);
        for pair in 0..PAIRS {
            let (stage, access) = words(pair);
            assert_eq!(PairSet::of(stage, access), PairSet(1 << pair));
            assert_eq!(Accesses::WRITES.contains(access), pair < WRITE_PAIRS, "{access:?}");
        }
    }

    #[test]
    fn a_source_waits_for_earlier_stages_and_a_destination_holds_up_later_ones() {
        let fragment = StageSet::of(Stages::FRAGMENT_SHADER);
        let earlier =
            Stages::DRAW_INDIRECT | Stages::VERTEX_INPUT | Stages::VERTEX_SHADER | Stages::EARLY_FRAGMENT_TESTS;
        assert_eq!(fragment.and_earlier(), StageSet::of(earlier | Stages::FRAGMENT_SHADER));
        let later = Stages::LATE_FRAGMENT_TESTS | Stages::COLOR_ATTACHMENT_OUTPUT;
        assert_eq!(fragment.and_later(), StageSet::of(later | Stages::FRAGMENT_SHADER));
        assert_eq!(StageSet::of(Stages::COPY).and_later(), StageSet::of(Stages::COPY));
        assert!(StageSet::of(Stages::DRAW_INDIRECT).and_later().contains(COMPUTE_SHADER));
        assert!(!StageSet::of(Stages::ALL_COMMANDS).contains(HOST));
    }

    #[test]
    fn any_read_and_any_write_stand_for_all_of_their_kind() {
        let all = PairSet::of(Stages::ALL_COMMANDS | Stages::HOST, Accesses::MEMORY_READ | Accesses::MEMORY_WRITE);
        assert_eq!(all.0.count_ones() as usize, PAIRS);
        let reads = PairSet::of(Stages::ALL_COMMANDS, Accesses::MEMORY_READ);
        assert!(reads.writes().is_empty());
    }
}
