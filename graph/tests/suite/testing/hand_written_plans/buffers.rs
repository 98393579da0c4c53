//! Buffers alone: a count is filled, raised by `emit`, read by the indirect dispatch `simulate`, and copied to the program;
//! `simulate` makes vertices; `weave` makes indices in the memory of what `simulate` read.

use super::build::*;
use framewright_graph::frame::{Blend, BufferRole, Draw, Groups};
use framewright_graph::plan::*;
use framewright_graph::vulkan::{
    self, Accesses, BufferUsage, FillValue, Format, Layout, LoadOp, Stages, StoreOp, Usage,
};

const CS: Stages = Stages::COMPUTE_SHADER;
const READ: Accesses = Accesses::SHADER_STORAGE_READ;
const WRITE: Accesses = Accesses::SHADER_STORAGE_WRITE;

pub(crate) fn plan() -> Plan {
    let storage = BufferUsage::STORAGE_BUFFER;
    let copied = BufferUsage::TRANSFER_SRC | BufferUsage::TRANSFER_DST;
    let counts = buffer(0, "counts", 256, storage | copied | BufferUsage::INDIRECT_BUFFER, place([0, 256], [0, 5]));
    let seeds = buffer(1, "seeds", 4096, storage, place([256, 4096], [1, 2]));
    let vertices = buffer(2, "vertices", 4096, storage | BufferUsage::VERTEX_BUFFER, place([4352, 4096], [2, 4]));
    let indices = buffer(3, "indices", 2048, storage | BufferUsage::INDEX_BUFFER, place([256, 2048], [3, 4]));
    let state = |accesses| vulkan::State { stages: Stages::COPY, accesses, layout: Layout::Undefined };
    let [before, after] = [state(Accesses::TRANSFER_READ), state(Accesses::TRANSFER_WRITE)];
    let log = buffer(4, "log", 256, copied, Role::External { before, after, owner: None });
    let screen = output(0, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);

    let whole = |buffer: &Buffer| Side::Buffer { buffer: buffer.id, bytes: buffer.bytes };
    let reset = Work::Fill(Fill {
        name: Some("reset".into()),
        cause: at(10),
        target: whole(&counts),
        value: FillValue::Bits([0; 4]),
    });
    let of = |name: &str, line: u32, buffers: Vec<BufferAccess>| Pass { buffers, ..dispatch(name, line, Vec::new()) };
    let emit = of("emit", 20, vec![block(&counts, CS, true, true), block(&seeds, CS, false, true)]);
    let indirect = fetch(&counts, BufferRole::Indirect, Stages::DRAW_INDIRECT, Accesses::INDIRECT_COMMAND_READ);
    let simulate = Pass {
        groups: Some(Groups::Indirect { offset: 16 }),
        ..of("simulate", 30, vec![indirect, block(&seeds, CS, true, false), block(&vertices, CS, false, true)])
    };
    let weave = of("weave", 40, vec![block(&indices, CS, false, true)]);
    let fetched = [
        fetch(&vertices, BufferRole::Vertex, Stages::VERTEX_INPUT, Accesses::VERTEX_ATTRIBUTE_READ),
        fetch(&indices, BufferRole::Index, Stages::VERTEX_INPUT, Accesses::INDEX_READ),
    ];
    let show = Pass {
        buffers: fetched.to_vec(),
        ..draw(
            "show",
            50,
            Draw::Vertices { count: 512, instances: 1 },
            &[Blend::Replace],
            None,
            vec![access(&screen, COLOR)],
        )
    };
    let cleared = attachment(&screen, COLOR.2, LoadOp::Clear, StoreOp::Store, "`show` clears it; it is an output");
    let record = Work::Copy(Transfer {
        name: Some("record".into()),
        cause: at(55),
        source: whole(&counts),
        target: whole(&log),
        filter: None,
    });

    let after = |barrier: MemoryBarrier, work: Work| Step { memory_barriers: vec![barrier], ..step(Vec::new(), work) };
    let nothing = Accesses::empty();
    // Words from `emit` are read by the indirect dispatch, by its shader and, later, by the copy.
    let emitted =
        (Stages::DRAW_INDIRECT | CS | Stages::COPY, Accesses::INDIRECT_COMMAND_READ | READ | Accesses::TRANSFER_READ);
    let mut weaving = memory((CS, nothing), (CS, WRITE));
    weaving.hand_overs = vec![[Resource::Buffer(seeds.id), Resource::Buffer(indices.id)]];
    let mut showing = after(
        memory((CS, WRITE), (Stages::VERTEX_INPUT, Accesses::VERTEX_ATTRIBUTE_READ | Accesses::INDEX_READ)),
        scope(1, vec![cleared], None, vec![show]),
    );
    showing.image_barriers = vec![barrier(&screen, (Stages::COPY, nothing), UNDEFINED, COLOR, Hazard::FirstUse, None)];
    let steps = vec![
        // The frame before ended with a copy of what this fills, and with a barrier that let copies wait for the draw, and
        // so for all that reads vertices, indices and counts.
        after(memory((Stages::COPY, nothing), (Stages::CLEAR, Accesses::TRANSFER_WRITE)), reset),
        after(memory((Stages::CLEAR, Accesses::TRANSFER_WRITE), (CS, READ | WRITE)), Work::Dispatch(emit)),
        after(memory((CS, WRITE), emitted), Work::Dispatch(simulate)),
        after(weaving, Work::Dispatch(weave)),
        showing,
        step(Vec::new(), record),
        step(vec![between(&screen, COLOR, READ_BACK, Hazard::Export, 4)], Work::Export),
    ];
    let plan = super::build::plan(vec![screen], 4096, steps);
    with_buffers(plan, vec![counts, seeds, vertices, indices, log], 8448)
}
