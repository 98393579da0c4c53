//! A depth prepass; then objects that test its depth and sample it at once; then glass on top, in a scope of its own.

use super::build::*;
use framewright_graph::frame::{Blend, Draw, DrawList};
use framewright_graph::plan::*;
use framewright_graph::vulkan::{Accesses, CompareOp, Format, Layout, LoadOp, Stages, StoreOp, Usage};

const READ: Accesses = Accesses::DEPTH_STENCIL_ATTACHMENT_READ;
const WRITE: Accesses = Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE;
const ATTACHED: Layout = Layout::DepthStencilAttachmentOptimal;
const READ_ONLY: Layout = Layout::DepthStencilReadOnlyOptimal;

pub(crate) fn plan() -> Plan {
    let usage = Usage::DEPTH_STENCIL_ATTACHMENT | Usage::SAMPLED;
    let depth = transient(0, "depth", Format::D32_SFLOAT, 1, usage, [0, 8192], [0, 2]);
    let usage = Usage::COLOR_ATTACHMENT | Usage::SAMPLED;
    let color = transient(1, "color", Format::R16G16B16A16_SFLOAT, 1, usage, [8192, 16384], [1, 3]);
    let screen = output(2, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);

    let objects = Draw::Objects(DrawList::Opaque);
    let nearer = DepthState { test: CompareOp::GreaterOrEqual, write: true };
    let prepass =
        draw("prepass", 10, objects, &[], Some(nearer), vec![access(&depth, (TESTS, READ | WRITE, ATTACHED))]);
    let filled = attachment(&depth, ATTACHED, LoadOp::Clear, StoreOp::Store, "`prepass` clears it; `soft` reads it");

    let only_tested = DepthState { test: CompareOp::GreaterOrEqual, write: false };
    let tested = access(&depth, (TESTS, READ, READ_ONLY));
    let kept = || attachment(&depth, READ_ONLY, LoadOp::Load, StoreOp::None, "it is only tested and sampled");
    let read: State = (SAMPLED.0, SAMPLED.1, READ_ONLY);
    let accesses = vec![access(&color, COLOR), tested.clone(), sampled("depth", &depth, read)];
    let soft = draw("soft", 20, objects, &[Blend::Replace], Some(only_tested), accesses);
    let cleared = attachment(&color, COLOR.2, LoadOp::Clear, StoreOp::Store, "`soft` clears it; `glass` reads it");

    let blended: State = (COLOR.0, Accesses::COLOR_ATTACHMENT_READ | Accesses::COLOR_ATTACHMENT_WRITE, COLOR.2);
    let glass = Draw::Objects(DrawList::Transparent);
    let accesses = vec![access(&color, blended), tested];
    let glass = draw("glass", 30, glass, &[Blend::Premultiplied], Some(only_tested), accesses);
    let loaded =
        attachment(&color, COLOR.2, LoadOp::Load, StoreOp::Store, "`glass` blends onto it; `tonemap` reads it");

    let shown: State = (TESTS | Stages::FRAGMENT_SHADER, READ | Accesses::SHADER_SAMPLED_READ, READ_ONLY);
    // Late tests come after early ones and after the fragment shader: to wait for them is to wait for all readers.
    let readers = (Stages::LATE_FRAGMENT_TESTS, Accesses::empty());
    let mut steps = vec![
        step(
            vec![barrier(
                &depth,
                readers,
                UNDEFINED,
                (Stages::EARLY_FRAGMENT_TESTS, WRITE, ATTACHED),
                Hazard::FirstUse,
                None,
            )],
            scope(1, Vec::new(), Some(filled), vec![prepass]),
        ),
        step(
            vec![
                between(&depth, (TESTS, WRITE, ATTACHED), shown, Hazard::ReadAfterWrite, 0),
                barrier(&color, (SAMPLED.0, Accesses::empty()), UNDEFINED, COLOR, Hazard::FirstUse, None),
            ],
            scope(1, vec![cleared], Some(kept()), vec![soft]),
        ),
        step(
            vec![between(&color, COLOR, blended, Hazard::ReadAfterWrite, 1)],
            scope(1, vec![loaded], Some(kept()), vec![glass]),
        ),
    ];
    steps.extend(tone_map(&color, COLOR, &screen, 3));
    super::build::plan(vec![depth, color, screen], 24576, steps)
}
