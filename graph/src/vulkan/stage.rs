//! The table of stages: their order in pipelines, the queues that have them, and the features that bring them.

use super::Stages;

/// A row of the table.
#[derive(Debug, Clone, Copy)]
struct StageRow {
    stage: Stages,
    /// Whether a queue for compute has it.
    compute: bool,
    /// Whether a queue for transfer alone has it.
    transfer: bool,
    /// The device feature that brings it, by Vulkan's name; `None`: every device has it.
    feature: Option<&'static str>,
}

const fn row(stage: Stages, compute: bool, transfer: bool, feature: Option<&'static str>) -> StageRow {
    StageRow { stage, compute, transfer, feature }
}

/// The rows, by their bits.
const ROWS: [StageRow; 20] = [
    row(Stages::DRAW_INDIRECT, true, false, None),
    row(Stages::VERTEX_INPUT, false, false, None),
    row(Stages::VERTEX_SHADER, false, false, None),
    row(Stages::FRAGMENT_SHADER, false, false, None),
    row(Stages::EARLY_FRAGMENT_TESTS, false, false, None),
    row(Stages::LATE_FRAGMENT_TESTS, false, false, None),
    row(Stages::COLOR_ATTACHMENT_OUTPUT, false, false, None),
    row(Stages::COMPUTE_SHADER, true, false, None),
    row(Stages::HOST, true, true, None),
    row(Stages::ALL_COMMANDS, false, false, None),
    row(Stages::TASK_SHADER_EXT, false, false, Some("taskShader")),
    row(Stages::MESH_SHADER_EXT, false, false, Some("meshShader")),
    row(Stages::RAY_TRACING_SHADER_KHR, true, false, Some("rayTracingPipeline")),
    row(Stages::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR, false, false, Some("attachmentFragmentShadingRate")),
    row(Stages::ACCELERATION_STRUCTURE_BUILD_KHR, true, false, Some("accelerationStructure")),
    row(Stages::ACCELERATION_STRUCTURE_COPY_KHR, true, false, Some("rayTracingMaintenance1")),
    row(Stages::COPY, true, true, None),
    row(Stages::RESOLVE, false, false, None),
    row(Stages::BLIT, false, false, None),
    row(Stages::CLEAR, true, true, None),
];

/// The graphics pipelines in logical order: with vertices, and with meshes.
const PIPELINES: [&[Stages]; 2] = [
    &[
        Stages::DRAW_INDIRECT,
        Stages::VERTEX_INPUT,
        Stages::VERTEX_SHADER,
        Stages::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR,
        Stages::EARLY_FRAGMENT_TESTS,
        Stages::FRAGMENT_SHADER,
        Stages::LATE_FRAGMENT_TESTS,
        Stages::COLOR_ATTACHMENT_OUTPUT,
    ],
    &[
        Stages::DRAW_INDIRECT,
        Stages::TASK_SHADER_EXT,
        Stages::MESH_SHADER_EXT,
        Stages::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR,
        Stages::EARLY_FRAGMENT_TESTS,
        Stages::FRAGMENT_SHADER,
        Stages::LATE_FRAGMENT_TESTS,
        Stages::COLOR_ATTACHMENT_OUTPUT,
    ],
];

/// Each stage, by the number of its bit, with the stages before it in one of its pipelines.
const EARLIER: [Stages; 64] = reach(true);
/// Each stage, by the number of its bit, with the stages after it in one of its pipelines.
const LATER: [Stages; 64] = reach(false);

const fn reach(earlier: bool) -> [Stages; 64] {
    let mut reach = [Stages::empty(); 64];
    let mut row = 0;
    while row < ROWS.len() {
        let stage = ROWS[row].stage;
        reach[stage.bits().trailing_zeros() as usize] = stage;
        row += 1;
    }
    let mut which = 0;
    while which < PIPELINES.len() {
        let pipeline = PIPELINES[which];
        let mut first = 0;
        while first < pipeline.len() {
            let mut second = first + 1;
            while second < pipeline.len() {
                let (of, other) =
                    if earlier { (pipeline[second], pipeline[first]) } else { (pipeline[first], pipeline[second]) };
                let bit = of.bits().trailing_zeros() as usize;
                reach[bit] = reach[bit].union(other);
                second += 1;
            }
            first += 1;
        }
        which += 1;
    }
    reach
}

impl Stages {
    /// Those that every device has.
    pub(crate) const CORE: Stages = {
        let mut core = Stages::empty();
        let mut row = 0;
        while row < ROWS.len() {
            if ROWS[row].feature.is_none() {
                core = core.union(ROWS[row].stage);
            }
            row += 1;
        }
        core
    };

    /// Those that a queue for compute has.
    pub(crate) const ON_COMPUTE: Stages = Stages::on_queue(false);
    /// Those that a queue for transfer alone has.
    pub(crate) const ON_TRANSFER: Stages = Stages::on_queue(true);

    const fn on_queue(transfer: bool) -> Stages {
        let mut stages = Stages::empty();
        let mut row = 0;
        while row < ROWS.len() {
            let has = if transfer { ROWS[row].transfer } else { ROWS[row].compute };
            if has {
                stages = stages.union(ROWS[row].stage);
            }
            row += 1;
        }
        stages
    }

    /// The features that bring these stages, by Vulkan's names.
    pub(crate) fn features(self) -> impl Iterator<Item = &'static str> {
        ROWS.iter().filter(move |row| self.contains(row.stage)).filter_map(|row| row.feature)
    }

    /// With the logically earlier stages, which a barrier's first scope includes.
    pub(crate) fn and_earlier(self) -> Stages {
        self.iter().fold(self, |all, stage| all | EARLIER[stage.bits().trailing_zeros() as usize])
    }

    /// With the logically later stages, which a barrier's second scope includes.
    pub(crate) fn and_later(self) -> Stages {
        self.iter().fold(self, |all, stage| all | LATER[stage.bits().trailing_zeros() as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stage_has_a_row() {
        let all = ROWS.iter().fold(Stages::empty(), |all, row| {
            assert!(!all.intersects(row.stage), "{:?} stands in two rows", row.stage);
            all | row.stage
        });
        assert_eq!(all, Stages::all());
    }

    #[test]
    fn vertices_and_meshes_go_different_ways_to_one_fragment() {
        let fragment = Stages::FRAGMENT_SHADER.and_earlier();
        assert!(fragment.contains(Stages::VERTEX_SHADER | Stages::MESH_SHADER_EXT | Stages::DRAW_INDIRECT));
        assert!(!fragment.contains(Stages::LATE_FRAGMENT_TESTS));
        assert!(!Stages::VERTEX_SHADER.and_earlier().contains(Stages::MESH_SHADER_EXT));
        assert!(Stages::MESH_SHADER_EXT.and_later().contains(Stages::COLOR_ATTACHMENT_OUTPUT));
        assert!(!Stages::MESH_SHADER_EXT.and_later().contains(Stages::VERTEX_SHADER));
        assert_eq!(Stages::COPY.and_later(), Stages::COPY);
    }
}
