//! Objects and sky at 4 samples; the resolve is folded into their scope; tone mapping into the output.

use super::build::*;
use framewright_graph::base::Place;
use framewright_graph::frame::{Blend, Draw, DrawList};
use framewright_graph::plan::*;
use framewright_graph::vulkan::{Accesses, CompareOp, Format, Layout, LoadOp, ResolveMode, Stages, StoreOp, Usage};

pub(crate) fn plan() -> Plan {
    let hdr = Format::R16G16B16A16_SFLOAT;
    let color = transient(0, "color", hdr, 4, Usage::COLOR_ATTACHMENT, [0, 65536], [0, 0]);
    let depth_usage = Usage::DEPTH_STENCIL_ATTACHMENT;
    let depth = transient(1, "depth", Format::D32_SFLOAT, 4, depth_usage, [65536, 32768], [0, 0]);
    let usage = Usage::COLOR_ATTACHMENT | Usage::SAMPLED;
    let mut resolved = transient(2, "color.resolved", hdr, 1, usage, [98304, 16384], [0, 1]);
    let cause = Cause::Inserted(Box::new(InsertionCause {
        because: "pass `tonemap` samples `color` and it has 4 samples".to_owned(),
        at: Some(Place { file: "pipeline.ron".into(), line: 40, column: 9 }),
    }));
    resolved.cause = cause.clone();
    let screen = output(3, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);

    let write = (COLOR.0, COLOR.1);
    let tested: State = (
        TESTS,
        Accesses::DEPTH_STENCIL_ATTACHMENT_READ | Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE,
        Layout::DepthStencilAttachmentOptimal,
    );
    let cleared: State = (Stages::EARLY_FRAGMENT_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE, tested.2);
    let barriers = vec![
        barrier(&color, write, UNDEFINED, COLOR, Hazard::FirstUse, None),
        barrier(&depth, (TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE), UNDEFINED, cleared, Hazard::FirstUse, None),
        barrier(&resolved, (SAMPLED.0, Accesses::empty()), UNDEFINED, COLOR, Hazard::FirstUse, None),
    ];
    let mut color_attachment = attachment(
        &color,
        COLOR.2,
        LoadOp::Clear,
        StoreOp::DontCare,
        "`opaque` clears it; later passes read it resolved",
    );
    color_attachment.resolve = Some(AttachmentResolve {
        image: resolved.id,
        range: range(hdr),
        layout: COLOR.2,
        mode: ResolveMode::Average,
        cause,
    });
    let depth_attachment =
        attachment(&depth, tested.2, LoadOp::Clear, StoreOp::DontCare, "`opaque` clears it; nothing reads it later");
    let nearer = DepthState { test: CompareOp::GreaterOrEqual, write: true };
    let accesses = || vec![access(&color, COLOR), access(&depth, tested)];
    let objects = Draw::Objects(DrawList::Opaque);
    let opaque = draw("opaque", 20, objects, &[Blend::Replace], Some(nearer), accesses());
    let mut sky = draw("sky", 30, Draw::Sky, &[Blend::Replace], Some(nearer), accesses());
    sky.merged = Some(Box::new("it draws into the attachments of `opaque`".into()));

    let scene = scope(4, vec![color_attachment], Some(depth_attachment), vec![opaque, sky]);
    let mut steps = vec![step(barriers, scene)];
    steps.extend(tone_map(&resolved, COLOR, &screen, 1));
    super::build::plan(vec![color, depth, resolved, screen], 114_688, steps)
}
