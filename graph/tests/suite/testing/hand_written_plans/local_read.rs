//! Geometry, lighting and marks in one rendering scope: lighting reads what geometry drew at its own position, then marks are
//! drawn over it, and nothing of it ever leaves the scope.

use super::build::*;
use framewright_graph::frame::{Blend, Draw, DrawList};
use framewright_graph::plan::*;
use framewright_graph::vulkan::{Accesses, Format, Layout, LoadOp, Stages, StoreOp, Usage};

const LOCAL: Layout = Layout::RenderingLocalReadKhr;

pub(crate) fn plan() -> Plan {
    let usage = Usage::COLOR_ATTACHMENT | Usage::INPUT_ATTACHMENT | Usage::TRANSIENT_ATTACHMENT;
    let albedo = transient(0, "albedo", Format::R8G8B8A8_UNORM, 1, usage, [0, 8192], [0, 0]);
    let usage = Usage::COLOR_ATTACHMENT | Usage::SAMPLED;
    let lit = transient(1, "lit", Format::R16G16B16A16_SFLOAT, 1, usage, [8192, 16384], [0, 1]);
    let screen = output(2, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);

    let drawn: State = (COLOR.0, COLOR.1, LOCAL);
    let own: State = (Stages::FRAGMENT_SHADER, Accesses::INPUT_ATTACHMENT_READ, LOCAL);
    let objects = Draw::Objects(DrawList::Opaque);
    let blend = [Blend::Replace, Blend::Replace];
    let geometry = draw("geometry", 10, objects, &blend, None, vec![access(&albedo, drawn)]);
    let kind = BindingKind::InputAttachment;
    let input =
        Access { binding: Some(Binding { name: "albedo".into(), kind, texture: None }), ..access(&albedo, own) };
    let lighting = Pass {
        local_barrier: true,
        merged: Some(Box::new("it reads `albedo` at its own position".into())),
        ..draw("lighting", 20, Draw::FullScreen, &blend, None, vec![input, access(&lit, drawn)])
    };
    let marks = Pass {
        local_barrier: true,
        merged: Some(Box::new("it draws into `albedo` like `geometry`".into())),
        ..draw("marks", 30, objects, &blend, None, vec![access(&albedo, drawn)])
    };
    let attachments = vec![
        attachment(&albedo, LOCAL, LoadOp::Clear, StoreOp::DontCare, "`geometry` clears it; nothing reads it later"),
        attachment(&lit, LOCAL, LoadOp::DontCare, StoreOp::Store, "`lighting` covers it; `tonemap` reads it"),
    ];
    // Colour output comes after the fragment shader, which reads `albedo` in `lighting`.
    let color = (COLOR.0, COLOR.1);
    let mut steps = vec![step(
        vec![
            barrier(&albedo, color, UNDEFINED, drawn, Hazard::FirstUse, None),
            barrier(&lit, (SAMPLED.0, Accesses::empty()), UNDEFINED, drawn, Hazard::FirstUse, None),
        ],
        scope(1, attachments, None, vec![geometry, lighting, marks]),
    )];
    steps.extend(tone_map(&lit, drawn, &screen, 1));
    let mut lit = lit;
    lit.usage |= Usage::INPUT_ATTACHMENT;
    super::build::plan(vec![albedo, lit, screen], 24576, steps)
}
