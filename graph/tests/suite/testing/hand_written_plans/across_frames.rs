//! An image that stays from frame to frame and goes from queue to queue: each frame updates it on the compute queue and
//! shows it on the graphics queue, which hands it to the next frame.

use super::build::*;
use framewright_graph::plan::*;
use framewright_graph::vulkan::{self, Accesses, FillValue, Format, Layout, Stages, Usage};

const CS: Stages = Stages::COMPUTE_SHADER;
const TO_COMPUTE: [Queue; 2] = [Queue::Graphics, Queue::Compute];
const TO_GRAPHICS: [Queue; 2] = [Queue::Compute, Queue::Graphics];

pub(crate) fn plan() -> Plan {
    let usage = Usage::STORAGE | Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let shown: State = (Stages::FRAGMENT_SHADER, Accesses::SHADER_SAMPLED_READ, Layout::General);
    let state = vulkan::State { stages: shown.0, accesses: shown.1, layout: shown.2 };
    let initial = FirstContents::Value(FillValue::Color([0.0; 4]));
    let field = Image {
        role: Role::Persistent { becomes: 0, initial, before: state, after: state },
        ..output(0, "field", Format::R16G16B16A16_SFLOAT, usage)
    };
    let screen = output(1, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);

    let updated: State = (CS, Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE, Layout::General);
    let update = dispatch("update", 10, vec![storage("field", &field, updated)]);
    let nothing = (Stages::empty(), Accesses::empty(), Layout::General);
    let of = |from: State, to: State, queues| {
        hand_over(queues, barrier(&field, (from.0, from.1), Layout::General, to, Hazard::Ownership, None))
    };
    let [mut tonemap, export] = tone_map(&field, nothing, &screen, 1);
    tonemap.waits = vec![wait(0, 0, Stages::empty())];
    tonemap.image_barriers[0] = of(nothing, shown, TO_GRAPHICS);
    if let Work::Render(scope) = &mut tonemap.work {
        scope.passes[0].accesses[0].layout = Layout::General;
    }
    tonemap.releases = vec![of((shown.0, Accesses::empty(), shown.2), nothing, TO_COMPUTE)];
    let written = (CS, Accesses::SHADER_STORAGE_WRITE, Layout::General);
    let steps = vec![
        Step {
            queue: Queue::Compute,
            waits: vec![wait(1, 1, Stages::empty())],
            releases: vec![of(written, nothing, TO_GRAPHICS)],
            ..step(vec![of(nothing, updated, TO_COMPUTE)], Work::Dispatch(update))
        },
        tonemap,
        export,
    ];
    super::build::plan(vec![field, screen], 4096, steps)
}
