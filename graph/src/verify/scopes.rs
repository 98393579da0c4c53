//! Stages and accesses in a dense form: one bit a stage, one bit a pair of stage and access.
//!
//! Only accesses that an image or a buffer can have form a pair. The order of the graphics pipeline's stages, and the stages
//! of each access, are those of the Vulkan specification, chapter "Synchronization and Cache Control".

use crate::vulkan::{Accesses, Stages};

/// Number of stages.
pub(super) const STAGES: usize = 19;
/// Number of pairs that write; they come first.
pub(super) const WRITE_PAIRS: usize = 18;
/// Number of pairs.
pub(super) const PAIRS: usize = 61;

/// A set of stages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct StageSet(pub(super) u32);

/// A set of pairs of stage and access.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct PairSet(pub(super) u64);

const DRAW_INDIRECT: usize = 0;
const VERTEX_INPUT: usize = 1;
const VERTEX_SHADER: usize = 2;
const FRAGMENT_SHADER: usize = 3;
const EARLY_TESTS: usize = 4;
const LATE_TESTS: usize = 5;
const COLOR_OUTPUT: usize = 6;
const COMPUTE_SHADER: usize = 7;
const HOST: usize = 8;
const TASK_SHADER: usize = 9;
const MESH_SHADER: usize = 10;
const RAY_TRACING: usize = 11;
const SHADING_RATE: usize = 12;
const BUILD: usize = 13;
const STRUCTURE_COPY: usize = 14;
const COPY: usize = 15;
const RESOLVE: usize = 16;
const BLIT: usize = 17;
const CLEAR: usize = 18;

/// Pipelines in logical order: graphics with vertices, and with meshes; compute, which is two stages long. Ray tracing is left out: a
/// barrier must name each of its stages, as if they had no order.
const PIPELINES: [&[usize]; 3] = [
    &[DRAW_INDIRECT, VERTEX_INPUT, VERTEX_SHADER, SHADING_RATE, EARLY_TESTS, FRAGMENT_SHADER, LATE_TESTS, COLOR_OUTPUT],
    &[DRAW_INDIRECT, TASK_SHADER, MESH_SHADER, SHADING_RATE, EARLY_TESTS, FRAGMENT_SHADER, LATE_TESTS, COLOR_OUTPUT],
    &[DRAW_INDIRECT, COMPUTE_SHADER],
];

/// Everything but the host: `ALL_COMMANDS` leaves it out.
const ALL_COMMANDS: u32 = ((1 << STAGES) - 1) & !(1 << HOST);

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
    (TASK_SHADER, Accesses::SHADER_STORAGE_WRITE),
    (MESH_SHADER, Accesses::SHADER_STORAGE_WRITE),
    (RAY_TRACING, Accesses::SHADER_STORAGE_WRITE),
    (BUILD, Accesses::ACCELERATION_STRUCTURE_WRITE_KHR),
    (STRUCTURE_COPY, Accesses::ACCELERATION_STRUCTURE_WRITE_KHR),
    (BUILD, Accesses::TRANSFER_WRITE),
    (STRUCTURE_COPY, Accesses::TRANSFER_WRITE),
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
    (TASK_SHADER, Accesses::SHADER_SAMPLED_READ),
    (MESH_SHADER, Accesses::SHADER_SAMPLED_READ),
    (RAY_TRACING, Accesses::SHADER_SAMPLED_READ),
    (TASK_SHADER, Accesses::SHADER_STORAGE_READ),
    (MESH_SHADER, Accesses::SHADER_STORAGE_READ),
    (RAY_TRACING, Accesses::SHADER_STORAGE_READ),
    (TASK_SHADER, Accesses::UNIFORM_READ),
    (MESH_SHADER, Accesses::UNIFORM_READ),
    (RAY_TRACING, Accesses::UNIFORM_READ),
    (BUILD, Accesses::INDIRECT_COMMAND_READ),
    (VERTEX_SHADER, Accesses::ACCELERATION_STRUCTURE_READ_KHR),
    (FRAGMENT_SHADER, Accesses::ACCELERATION_STRUCTURE_READ_KHR),
    (COMPUTE_SHADER, Accesses::ACCELERATION_STRUCTURE_READ_KHR),
    (TASK_SHADER, Accesses::ACCELERATION_STRUCTURE_READ_KHR),
    (MESH_SHADER, Accesses::ACCELERATION_STRUCTURE_READ_KHR),
    (RAY_TRACING, Accesses::ACCELERATION_STRUCTURE_READ_KHR),
    (BUILD, Accesses::ACCELERATION_STRUCTURE_READ_KHR),
    (STRUCTURE_COPY, Accesses::ACCELERATION_STRUCTURE_READ_KHR),
    (RAY_TRACING, Accesses::SHADER_BINDING_TABLE_READ_KHR),
    (BUILD, Accesses::SHADER_READ),
    (BUILD, Accesses::TRANSFER_READ),
    (STRUCTURE_COPY, Accesses::TRANSFER_READ),
    (SHADING_RATE, Accesses::FRAGMENT_SHADING_RATE_ATTACHMENT_READ_KHR),
];

const EARLIER: [u32; STAGES] = closure(true);
const LATER: [u32; STAGES] = closure(false);
const PAIRS_OF_STAGE: [u64; STAGES] = pairs_of_stages();
const PAIRS_OF_ACCESS: [u64; 64] = pairs_of_accesses();
/// The accesses that happen in each stage.
const ACCESSES_OF_STAGE: [u64; STAGES] = accesses_of_stages();

const fn closure(earlier: bool) -> [u32; STAGES] {
    let mut reach = [0; STAGES];
    let mut stage = 0;
    while stage < STAGES {
        reach[stage] = 1 << stage;
        stage += 1;
    }
    let mut which = 0;
    while which < PIPELINES.len() {
        let pipeline = PIPELINES[which];
        let mut first = 0;
        while first < pipeline.len() {
            let mut second = first;
            while second < pipeline.len() {
                if earlier {
                    reach[pipeline[second]] |= 1 << pipeline[first];
                } else {
                    reach[pipeline[first]] |= 1 << pipeline[second];
                }
                second += 1;
            }
            first += 1;
        }
        which += 1;
    }
    reach
}

const fn pairs_of_stages() -> [u64; STAGES] {
    let mut pairs = [0; STAGES];
    let mut pair = 0;
    while pair < PAIRS {
        pairs[PAIR[pair].0] |= 1 << pair;
        pair += 1;
    }
    pairs
}

const fn accesses_of_stages() -> [u64; STAGES] {
    let mut accesses = [0; STAGES];
    let mut pair = 0;
    while pair < PAIRS {
        accesses[PAIR[pair].0] |= PAIR[pair].1.bits();
        pair += 1;
    }
    accesses
}

/// The pairs of each access, by the number of its bit.
const fn pairs_of_accesses() -> [u64; 64] {
    let mut pairs = [0; 64];
    let mut pair = 0;
    while pair < PAIRS {
        pairs[PAIR[pair].1.bits().trailing_zeros() as usize] |= 1 << pair;
        pair += 1;
    }
    pairs[Accesses::MEMORY_WRITE.bits().trailing_zeros() as usize] = WRITES;
    pairs[Accesses::MEMORY_READ.bits().trailing_zeros() as usize] = !WRITES & ((1 << PAIRS) - 1);
    pairs
}

const WRITES: u64 = (1 << WRITE_PAIRS) - 1;

impl StageSet {
    /// Every stage of a device.
    pub(super) const ALL: StageSet = StageSet(ALL_COMMANDS);

    /// Exactly these stages; `ALL_COMMANDS` stands for every one on a device.
    pub(super) fn of(stages: Stages) -> StageSet {
        let bits = stages.bits();
        // Bits 1–3, 7–11, 14, 19–22, 25, 28 and 32–35, pushed together.
        let low = (bits >> 1 & 0x7) | (bits >> 4 & 0xf8) | (bits >> 6 & 0x100) | (bits >> 10 & 0x1e00);
        let high = (bits >> 12 & 0x2000) | (bits >> 14 & 0x4000) | (bits >> 17 & 0x7_8000);
        let all = if stages.contains(Stages::ALL_COMMANDS) { ALL_COMMANDS } else { 0 };
        StageSet((low | high) as u32 | all)
    }

    /// With every stage of the same pipeline that logically comes before: what a barrier's source waits for.
    pub(super) fn and_earlier(self) -> StageSet {
        self.spread(&EARLIER)
    }

    /// With every stage of the same pipeline that logically comes after: what a barrier's destination holds up.
    pub(super) fn and_later(self) -> StageSet {
        self.spread(&LATER)
    }

    fn spread(self, reach: &[u32; STAGES]) -> StageSet {
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
        let of_accesses = bits(accesses.bits()).fold(0, |set, access| set | PAIRS_OF_ACCESS[access]);
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
        bits(self.0)
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
        Stages::TASK_SHADER_EXT,
        Stages::MESH_SHADER_EXT,
        Stages::RAY_TRACING_SHADER_KHR,
        Stages::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR,
        Stages::ACCELERATION_STRUCTURE_BUILD_KHR,
        Stages::ACCELERATION_STRUCTURE_COPY_KHR,
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
        let of_host = Accesses::HOST_READ | Accesses::HOST_WRITE;
        return if stages.contains(Stages::HOST) { Accesses::empty() } else { accesses & of_host };
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
        let vertices = Stages::DRAW_INDIRECT | Stages::VERTEX_INPUT | Stages::VERTEX_SHADER;
        let meshes = Stages::TASK_SHADER_EXT | Stages::MESH_SHADER_EXT;
        let both =
            Stages::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR | Stages::EARLY_FRAGMENT_TESTS | Stages::FRAGMENT_SHADER;
        assert_eq!(fragment.and_earlier(), StageSet::of(vertices | meshes | both));
        assert!(!StageSet::of(meshes).and_earlier().contains(VERTEX_SHADER));
        let later = Stages::LATE_FRAGMENT_TESTS | Stages::COLOR_ATTACHMENT_OUTPUT;
        assert_eq!(fragment.and_later(), StageSet::of(later | Stages::FRAGMENT_SHADER));
        assert_eq!(StageSet::of(Stages::COPY).and_later(), StageSet::of(Stages::COPY));
        assert!(StageSet::of(Stages::DRAW_INDIRECT).and_later().contains(COMPUTE_SHADER));
        assert!(!StageSet::of(Stages::ALL_COMMANDS).contains(HOST));
    }

    #[test]
    fn the_host_accesses_in_its_own_stage_alone() {
        let of_host = Accesses::HOST_READ | Accesses::HOST_WRITE;
        for (stages, found) in [
            (Stages::ALL_COMMANDS, of_host),
            (Stages::HOST, Accesses::empty()),
            (Stages::HOST | Stages::ALL_COMMANDS, Accesses::empty()),
        ] {
            assert_eq!(impossible(stages, of_host), found, "{stages:?}");
        }
    }

    #[test]
    fn any_read_and_any_write_stand_for_all_of_their_kind() {
        let all = PairSet::of(Stages::ALL_COMMANDS | Stages::HOST, Accesses::MEMORY_READ | Accesses::MEMORY_WRITE);
        assert_eq!(all.0.count_ones() as usize, PAIRS);
        let reads = PairSet::of(Stages::ALL_COMMANDS, Accesses::MEMORY_READ);
        assert!(reads.writes().is_empty());
    }
}
