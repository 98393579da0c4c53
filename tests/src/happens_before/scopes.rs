//! The stages and accesses that masks take in.

use framewright_graph::vulkan::{Accesses, Stages};

/// Stages of work that draws vertices, that draws meshes, and of compute work: in each, a stage is logically earlier than the next.
const ORDERS: [&[Stages]; 3] = [
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
    &[Stages::DRAW_INDIRECT, Stages::COMPUTE_SHADER],
];

/// A mask without its collective bit.
pub(super) fn spelled_out(stages: Stages) -> Stages {
    if stages.contains(Stages::ALL_COMMANDS) { Stages::all() - Stages::ALL_COMMANDS - Stages::HOST } else { stages }
}

/// A first synchronisation scope takes in logically earlier stages.
pub(super) fn and_earlier(stages: Stages) -> Stages {
    let stages = spelled_out(stages);
    ORDERS.into_iter().fold(stages, |all, order| {
        let end = order.iter().rposition(|stage| stages.contains(*stage)).map_or(0, |last| last + 1);
        order[..end].iter().fold(all, |all, stage| all | *stage)
    })
}

/// A second synchronisation scope takes in logically later stages.
pub(super) fn and_later(stages: Stages) -> Stages {
    let stages = spelled_out(stages);
    ORDERS.into_iter().fold(stages, |all, order| {
        let start = order.iter().position(|stage| stages.contains(*stage)).unwrap_or(order.len());
        order[start..].iter().fold(all, |all, stage| all | *stage)
    })
}

/// Whether an access scope of these masks takes in one access in one stage: logically earlier and later stages don't count.
pub(super) fn take_in(stages: Stages, accesses: Accesses, stage: Stages, access: Accesses) -> bool {
    let any = if Accesses::WRITES.contains(access) { Accesses::MEMORY_WRITE } else { Accesses::MEMORY_READ };
    spelled_out(stages).contains(stage) && (accesses.contains(access) || accesses.contains(any))
}

/// Whether a stage makes accesses of this kind at all (the table of supported access types).
pub(super) fn possible(stage: Stages, access: Accesses) -> bool {
    const SHADERS: Stages = Stages::SHADERS;
    const BUILD: Stages = Stages::ACCELERATION_STRUCTURE_BUILD_KHR;
    const BUILDS: Stages = BUILD.union(Stages::ACCELERATION_STRUCTURE_COPY_KHR);
    const TESTS: Stages = Stages::EARLY_FRAGMENT_TESTS.union(Stages::LATE_FRAGMENT_TESTS);
    const TRANSFERS: Stages = Stages::COPY.union(Stages::BLIT).union(Stages::RESOLVE);
    let stages = match access {
        Accesses::INDIRECT_COMMAND_READ => Stages::DRAW_INDIRECT.union(BUILD),
        Accesses::INDEX_READ | Accesses::VERTEX_ATTRIBUTE_READ => Stages::VERTEX_INPUT,
        Accesses::INPUT_ATTACHMENT_READ => Stages::FRAGMENT_SHADER,
        Accesses::COLOR_ATTACHMENT_READ | Accesses::COLOR_ATTACHMENT_WRITE => Stages::COLOR_ATTACHMENT_OUTPUT,
        Accesses::DEPTH_STENCIL_ATTACHMENT_READ | Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE => TESTS,
        Accesses::TRANSFER_READ => TRANSFERS.union(BUILDS),
        Accesses::TRANSFER_WRITE => TRANSFERS.union(Stages::CLEAR).union(BUILDS),
        Accesses::HOST_READ | Accesses::HOST_WRITE => Stages::HOST,
        Accesses::UNIFORM_READ
        | Accesses::SHADER_SAMPLED_READ
        | Accesses::SHADER_STORAGE_READ
        | Accesses::SHADER_STORAGE_WRITE => SHADERS,
        Accesses::ACCELERATION_STRUCTURE_READ_KHR => SHADERS.union(BUILDS),
        Accesses::ACCELERATION_STRUCTURE_WRITE_KHR => BUILDS,
        Accesses::SHADER_READ => BUILD,
        Accesses::SHADER_BINDING_TABLE_READ_KHR => Stages::RAY_TRACING_SHADER_KHR,
        Accesses::FRAGMENT_SHADING_RATE_ATTACHMENT_READ_KHR => Stages::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR,
        _ => Stages::all(),
    };
    stages.contains(stage)
}

/// Every access in every stage that the masks take in, one at a time.
pub(super) fn each(stages: Stages, accesses: Accesses) -> impl Iterator<Item = (Stages, Accesses)> {
    spelled_out(stages)
        .iter()
        .flat_map(move |stage| accesses.iter().map(move |access| (stage, access)))
        .filter(|(stage, access)| possible(*stage, *access))
}
