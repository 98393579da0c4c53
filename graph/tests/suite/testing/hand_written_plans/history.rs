//! History of depth 2: each frame writes `trail` from what the two frames before left, and shows it.

use super::build::*;
use framewright_graph::plan::*;
use framewright_graph::vulkan::{self, Accesses, FillValue, Format, Layout, Stages, Usage};

const CS: Stages = Stages::COMPUTE_SHADER;

fn history(id: u32, name: &str, becomes: u32, before: State, after: State) -> Image {
    let usage = Usage::STORAGE | Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let state = |(stages, accesses, layout): State| vulkan::State { stages, accesses, layout };
    let initial = FirstContents::Value(FillValue::Color([0.0; 4]));
    let role = Role::Persistent { becomes, initial, before: state(before), after: state(after) };
    Image { role, ..output(id, name, Format::R16G16B16A16_SFLOAT, usage) }
}

pub(crate) fn plan() -> Plan {
    let read: State = (CS, Accesses::SHADER_SAMPLED_READ, Layout::ShaderReadOnlyOptimal);
    let written: State = (CS, Accesses::SHADER_STORAGE_WRITE, Layout::General);
    let trail = history(0, "trail", 1, read, SAMPLED);
    let before = history(1, "trail (1 frame ago)", 2, SAMPLED, read);
    let long_before = history(2, "trail (2 frames ago)", 0, read, read);
    let screen = output(3, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);

    let accesses =
        vec![sampled("one", &before, read), sampled("two", &long_before, read), storage("target", &trail, written)];
    let mut steps = vec![step(
        vec![
            barrier(&trail, (CS, Accesses::empty()), UNDEFINED, written, Hazard::FirstUse, None),
            // It was made visible to `tonemap` of the frame before; the frame after this one needs no more.
            barrier(&before, (SAMPLED.0, Accesses::empty()), SAMPLED.2, read, Hazard::ReadAfterWrite, None),
        ],
        Work::Dispatch(dispatch("accumulate", 10, accesses)),
    )];
    steps.extend(tone_map(&trail, written, &screen, 1));
    let mut plan = super::build::plan(vec![trail, before, long_before, screen], 4096, steps);
    plan.heaps.clear();
    super::recount(&mut plan);
    plan
}
