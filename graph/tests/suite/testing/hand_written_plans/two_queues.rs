//! Two queues: `simulate` runs beside `scene`; `blur` takes what `scene` drew over to the compute queue, `tonemap` takes
//! the result back. Buffers are for both queues: semaphores alone serve them.

use super::build::*;
use framewright_graph::frame::{Blend, Draw, DrawList};
use framewright_graph::plan::*;
use framewright_graph::vulkan::{Accesses, BufferUsage, Format, Layout, LoadOp, Sharing, Stages, StoreOp, Usage};

const CS: Stages = Stages::COMPUTE_SHADER;
const FS: Stages = Stages::FRAGMENT_SHADER;
const NOTHING: (Stages, Accesses) = (Stages::empty(), Accesses::empty());
const TO_COMPUTE: [Queue; 2] = [Queue::Graphics, Queue::Compute];
const TO_GRAPHICS: [Queue; 2] = [Queue::Compute, Queue::Graphics];

pub(crate) fn plan() -> Plan {
    let hdr = Format::R16G16B16A16_SFLOAT;
    let color = transient(0, "color", hdr, 1, Usage::COLOR_ATTACHMENT | Usage::SAMPLED, [0, 16384], [1, 2]);
    let blurred = transient(1, "blurred", hdr, 1, Usage::STORAGE | Usage::SAMPLED, [16384, 16384], [2, 3]);
    let screen = output(2, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);
    let shared = |id, name, bytes, offset, steps| Buffer {
        sharing: Sharing::Concurrent,
        ..buffer(id, name, bytes, BufferUsage::STORAGE_BUFFER, place([offset, bytes], steps))
    };
    let particles = shared(0, "particles", 1024, 0, [0, 3]);
    let lights = shared(1, "lights", 512, 1024, [1, 2]);

    let simulate = Pass { buffers: vec![block(&particles, CS, false, true)], ..dispatch("simulate", 10, Vec::new()) };
    let cleared = attachment(&color, COLOR.2, LoadOp::Clear, StoreOp::Store, "`scene` clears it; `blur` reads it");
    let objects = Draw::Objects(DrawList::Opaque);
    let scene = Pass {
        buffers: vec![block(&lights, FS, false, true)],
        ..draw("scene", 20, objects, &[Blend::Replace], None, vec![access(&color, COLOR)])
    };
    let read: State = (CS, Accesses::SHADER_SAMPLED_READ, Layout::ShaderReadOnlyOptimal);
    let written: State = (CS, Accesses::SHADER_STORAGE_WRITE, Layout::General);
    let blur = Pass {
        buffers: vec![block(&lights, CS, true, false)],
        ..dispatch("blur", 30, vec![sampled("source", &color, read), storage("target", &blurred, written)])
    };

    let release = |image, from: State, to: State, queues| {
        let to = (Stages::empty(), Accesses::empty(), to.2);
        hand_over(queues, barrier(image, (from.0, from.1), from.2, to, Hazard::Ownership, None))
    };
    let acquire = |image, from: State, to: State, queues, after| {
        hand_over(queues, barrier(image, NOTHING, from.2, to, Hazard::Ownership, Some(after)))
    };
    let first = |image, to| barrier(image, NOTHING, UNDEFINED, to, Hazard::FirstUse, None);

    let [mut tonemap, export] = tone_map(&blurred, written, &screen, 3);
    tonemap.waits = vec![wait(2, 0, FS)];
    // Reads of `screen` before the frame came before `scene`, which `blur` has waited for.
    tonemap.image_barriers = vec![acquire(&blurred, written, SAMPLED, TO_GRAPHICS, 2), first(&screen, COLOR)];
    if let Work::Render(scope) = &mut tonemap.work {
        scope.passes[0].buffers = vec![block(&particles, FS, true, false)];
    }
    let steps = vec![
        // `tonemap` of the frame before still reads what this writes.
        Step { queue: Queue::Compute, waits: vec![wait(3, 1, CS)], ..step(Vec::new(), Work::Dispatch(simulate)) },
        // `blur` of the frame before has read `color`: the fragment shader of `tonemap` waited for it.
        Step {
            releases: vec![release(&color, COLOR, SAMPLED, TO_COMPUTE)],
            ..step(
                vec![barrier(&color, (FS, Accesses::empty()), UNDEFINED, COLOR, Hazard::FirstUse, None)],
                scope(1, vec![cleared], None, vec![scene]),
            )
        },
        Step {
            queue: Queue::Compute,
            waits: vec![wait(1, 0, CS)],
            releases: vec![release(&blurred, written, SAMPLED, TO_GRAPHICS)],
            ..step(vec![acquire(&color, COLOR, read, TO_COMPUTE, 1), first(&blurred, written)], Work::Dispatch(blur))
        },
        tonemap,
        export,
    ];
    let plan = super::build::plan(vec![color, blurred, screen], 32768, steps);
    with_buffers(plan, vec![particles, lights], 2048)
}
