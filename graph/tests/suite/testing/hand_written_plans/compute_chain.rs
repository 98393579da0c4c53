//! Three dispatches; the last one's image takes the memory of the first one's, through a memory barrier.

use super::build::*;
use framewright_graph::plan::*;
use framewright_graph::vulkan::{Accesses, Format, Layout, Stages, Usage};

const CS: Stages = Stages::COMPUTE_SHADER;
const READ: Accesses = Accesses::SHADER_STORAGE_READ;
const WRITE: Accesses = Accesses::SHADER_STORAGE_WRITE;
const GENERAL: Layout = Layout::General;

pub(crate) fn plan() -> Plan {
    let format = Format::R16G16B16A16_SFLOAT;
    let seed = transient(0, "seed", format, 1, Usage::STORAGE, [0, 16384], [0, 1]);
    let grown = transient(1, "grown", format, 1, Usage::STORAGE, [16384, 16384], [1, 2]);
    let blurred = transient(2, "blurred", format, 1, Usage::STORAGE | Usage::SAMPLED, [0, 16384], [2, 3]);
    let screen = output(3, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);
    let [written, read, both]: [State; 3] = [(CS, WRITE, GENERAL), (CS, READ, GENERAL), (CS, READ | WRITE, GENERAL)];

    let sow = dispatch("sow", 10, vec![storage("target", &seed, written)]);
    let grow = dispatch("grow", 20, vec![storage("field", &seed, both), storage("target", &grown, written)]);
    let blur = dispatch("blur", 30, vec![storage("source", &grown, read), storage("target", &blurred, written)]);

    let mut steps = vec![
        // In the frame before, the memory belonged to `blurred`, which `tonemap` samples.
        step(
            vec![barrier(&seed, (SAMPLED.0, Accesses::empty()), UNDEFINED, written, Hazard::FirstUse, None)],
            Work::Dispatch(sow),
        ),
        step(
            vec![
                between(&seed, written, both, Hazard::ReadAfterWrite, 0),
                barrier(&grown, (CS, Accesses::empty()), UNDEFINED, written, Hazard::FirstUse, None),
            ],
            Work::Dispatch(grow),
        ),
        step(
            vec![barrier(&blurred, (CS, Accesses::empty()), UNDEFINED, written, Hazard::FirstUse, Some(1))],
            Work::Dispatch(blur),
        ),
    ];
    // One for what `grow` wrote: `grown`, which `blur` reads, and `seed`, whose memory `blurred` takes.
    steps[2].memory_barriers.push(MemoryBarrier {
        src_stages: CS,
        src_accesses: WRITE,
        dst_stages: CS,
        dst_accesses: READ,
        hand_overs: vec![[Resource::Image(seed.id), Resource::Image(blurred.id)]],
        buffers: Vec::new(),
    });
    steps.extend(tone_map(&blurred, written, &screen, 3));
    super::build::plan(vec![seed, grown, blurred, screen], 32768, steps)
}
