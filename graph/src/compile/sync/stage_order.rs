//! The logical order of pipeline stages, which the scopes of barriers follow.

use crate::vulkan::Stages;

/// The stages of the graphics pipeline in logical order.
const PIPELINE: [Stages; 7] = [
    Stages::DRAW_INDIRECT,
    Stages::VERTEX_INPUT,
    Stages::VERTEX_SHADER,
    Stages::EARLY_FRAGMENT_TESTS,
    Stages::FRAGMENT_SHADER,
    Stages::LATE_FRAGMENT_TESTS,
    Stages::COLOR_ATTACHMENT_OUTPUT,
];

/// With the logically earlier stages, which a barrier's first scope includes.
pub(super) fn and_earlier(stages: Stages) -> Stages {
    let last = PIPELINE.iter().rposition(|stage| stages.contains(*stage));
    PIPELINE[..last.map_or(0, |last| last + 1)].iter().fold(stages, |all, stage| all | *stage)
}

/// With the logically later stages, which a barrier's second scope includes.
pub(super) fn and_later(stages: Stages) -> Stages {
    let first = PIPELINE.iter().position(|stage| stages.contains(*stage)).unwrap_or(PIPELINE.len());
    PIPELINE[first..].iter().fold(stages, |all, stage| all | *stage)
}
