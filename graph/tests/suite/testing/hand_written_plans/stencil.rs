//! Depth is only tested, and sampled at once, while stencil is written; then stencil is only tested. Each plane goes from
//! layout to layout by itself.

use super::build::*;
use framewright_graph::frame::{Blend, Draw, DrawList, StencilState};
use framewright_graph::plan::*;
use framewright_graph::vulkan::{
    Accesses, Aspects, CompareOp, Format, Layout, LoadOp, Stages, StencilOp, StoreOp, Subresources, Usage,
};

const READ: Accesses = Accesses::DEPTH_STENCIL_ATTACHMENT_READ;
const WRITE: Accesses = Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE;
const FORMAT: Format = Format::D24_UNORM_S8_UINT;

fn plane(aspects: Aspects) -> Subresources {
    Subresources { aspects, ..range(FORMAT) }
}

fn on_plane(aspects: Aspects, access: Access) -> Access {
    Access { range: plane(aspects), ..access }
}

fn attach(image: &Image, aspects: Aspects, layout: Layout, load: LoadOp, store: StoreOp) -> Attachment {
    Attachment { range: plane(aspects), ..attachment(image, layout, load, store, "what passes need of it") }
}

pub(crate) fn plan() -> Plan {
    let usage = Usage::DEPTH_STENCIL_ATTACHMENT | Usage::SAMPLED;
    let depth = transient(0, "depth", FORMAT, 1, usage, [0, 8192], [0, 2]);
    let usage = Usage::COLOR_ATTACHMENT | Usage::SAMPLED;
    let color = transient(1, "color", Format::R16G16B16A16_SFLOAT, 1, usage, [8192, 16384], [1, 3]);
    let screen = output(2, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);

    let depth_written: State = (TESTS, READ | WRITE, Layout::DepthAttachmentOptimal);
    let depth_read: State = (TESTS, READ, Layout::DepthReadOnlyOptimal);
    let depth_shown: State = (SAMPLED.0, SAMPLED.1, Layout::DepthReadOnlyOptimal);
    let stencil_written: State = (TESTS, READ | WRITE, Layout::StencilAttachmentOptimal);
    let stencil_read: State = (TESTS, READ, Layout::StencilReadOnlyOptimal);
    let mark = StencilState { clear: None, test: CompareOp::Always, reference: 1, pass: StencilOp::Replace };
    let marked = StencilState { test: CompareOp::Equal, pass: StencilOp::Keep, ..mark };
    let nearer = DepthState { test: CompareOp::GreaterOrEqual, write: true };
    let tested = DepthState { write: false, ..nearer };

    let objects = Draw::Objects(DrawList::Opaque);
    let accesses = vec![
        on_plane(Aspects::DEPTH, access(&depth, depth_written)),
        on_plane(Aspects::STENCIL, access(&depth, stencil_written)),
    ];
    let prepass = Pass { stencil: Some(mark), ..draw("prepass", 10, objects, &[], Some(nearer), accesses) };

    let accesses = vec![
        access(&color, COLOR),
        on_plane(Aspects::DEPTH, access(&depth, depth_read)),
        on_plane(Aspects::DEPTH, sampled("depth", &depth, depth_shown)),
        on_plane(Aspects::STENCIL, access(&depth, stencil_written)),
    ];
    let soft = Pass { stencil: Some(mark), ..draw("soft", 20, objects, &[Blend::Replace], Some(tested), accesses) };

    let blended: State = (COLOR.0, Accesses::COLOR_ATTACHMENT_READ | Accesses::COLOR_ATTACHMENT_WRITE, COLOR.2);
    let accesses = vec![access(&color, blended), on_plane(Aspects::STENCIL, access(&depth, stencil_read))];
    let tint =
        Pass { stencil: Some(marked), ..draw("tint", 30, Draw::FullScreen, &[Blend::Premultiplied], None, accesses) };

    let with_stencil = |work: Work, attachment: Attachment| match work {
        Work::Render(mut scope) => {
            scope.attachments.push(Attachment { kind: AttachmentKind::Stencil, ..attachment });
            Work::Render(scope)
        }
        other => other,
    };
    let (clear, load, store) = (LoadOp::Clear, LoadOp::Load, StoreOp::Store);
    let first = scope(1, vec![], Some(attach(&depth, Aspects::DEPTH, depth_written.2, clear, store)), vec![prepass]);
    let first = with_stencil(first, attach(&depth, Aspects::STENCIL, stencil_written.2, clear, store));
    let cleared = attachment(&color, COLOR.2, clear, store, "`soft` clears it; `tint` reads it");
    let kept = attach(&depth, Aspects::DEPTH, depth_read.2, load, StoreOp::None);
    let second = scope(1, vec![cleared], Some(kept), vec![soft]);
    let second = with_stencil(second, attach(&depth, Aspects::STENCIL, stencil_written.2, load, store));
    let loaded = attachment(&color, COLOR.2, load, store, "`tint` blends onto it; `tonemap` reads it");
    let third = scope(1, vec![loaded], None, vec![tint]);
    let third = with_stencil(third, attach(&depth, Aspects::STENCIL, stencil_read.2, load, StoreOp::None));

    let early = Stages::EARLY_FRAGMENT_TESTS;
    let of = |aspects, barrier: ImageBarrier| ImageBarrier { range: plane(aspects), ..barrier };
    let shown: State = (TESTS | SAMPLED.0, READ | SAMPLED.1, depth_read.2);
    let late = (Stages::LATE_FRAGMENT_TESTS, Accesses::empty());
    let fresh = |aspects, layout, from| {
        of(aspects, barrier(&depth, from, UNDEFINED, (early, WRITE, layout), Hazard::FirstUse, None))
    };
    let mut steps = vec![
        step(
            vec![
                // Late tests come after the fragment shader, which samples depth in `soft`.
                fresh(Aspects::DEPTH, depth_written.2, late),
                fresh(Aspects::STENCIL, stencil_written.2, late),
            ],
            first,
        ),
        step(
            vec![
                of(Aspects::DEPTH, between(&depth, (TESTS, WRITE, depth_written.2), shown, Hazard::ReadAfterWrite, 0)),
                of(
                    Aspects::STENCIL,
                    between(&depth, (TESTS, WRITE, stencil_written.2), stencil_written, Hazard::WriteAfterWrite, 0),
                ),
                barrier(&color, (SAMPLED.0, Accesses::empty()), UNDEFINED, COLOR, Hazard::FirstUse, None),
            ],
            second,
        ),
        step(
            vec![
                of(
                    Aspects::STENCIL,
                    between(&depth, (TESTS, WRITE, stencil_written.2), stencil_read, Hazard::ReadAfterWrite, 1),
                ),
                between(&color, COLOR, blended, Hazard::ReadAfterWrite, 1),
            ],
            third,
        ),
    ];
    steps.extend(tone_map(&color, COLOR, &screen, 3));
    super::build::plan(vec![depth, color, screen], 24576, steps)
}
