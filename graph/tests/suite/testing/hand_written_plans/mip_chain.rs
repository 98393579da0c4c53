//! A mip chain: level 0 is drawn, level 1 is drawn from it, level 2 is blitted from level 1; then all are sampled.

use super::build::*;
use framewright_graph::frame::{Blend, Draw, DrawList};
use framewright_graph::plan::*;
use framewright_graph::vulkan::{Accesses, Filter, Format, Layout, LoadOp, Stages, StoreOp, Subresources, Usage};

const FORMAT: Format = Format::R16G16B16A16_SFLOAT;

fn level(base_mip: u32) -> Subresources {
    Subresources { base_mip, ..range(FORMAT) }
}

pub(crate) fn plan() -> Plan {
    let usage = Usage::COLOR_ATTACHMENT | Usage::SAMPLED | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
    let bloom = Image { mips: 3, ..transient(0, "bloom", FORMAT, 1, usage, [0, 32768], [0, 3]) };
    let screen = output(1, "screen", Format::R8G8B8A8_SRGB, Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC);

    let on = |mip: u32, access: Access| Access { range: level(mip), ..access };
    let attach = |mip: u32, load: LoadOp| Attachment {
        range: level(mip),
        ..attachment(&bloom, COLOR.2, load, StoreOp::Store, "a later level is made from it")
    };
    let objects = Draw::Objects(DrawList::Opaque);
    let bright = draw("bright", 10, objects, &[Blend::Replace], None, vec![on(0, access(&bloom, COLOR))]);
    let accesses = vec![on(0, sampled("source", &bloom, SAMPLED)), on(1, access(&bloom, COLOR))];
    let down = draw("down", 20, Draw::FullScreen, &[Blend::Replace], None, accesses);
    let below = match scope(1, vec![attach(1, LoadOp::DontCare)], None, vec![down]) {
        Work::Render(scope) => Work::Render(Box::new(RenderScope { extent: [SIZE[0] / 2, SIZE[1] / 2], ..*scope })),
        other => other,
    };
    let side = |mip: u32, layout: Layout| Side::Image {
        image: bloom.id,
        range: level(mip),
        extent: [SIZE[0] >> mip, SIZE[1] >> mip, 1],
        layout,
    };
    let blit = Work::Blit(Transfer {
        name: Some("last level".into()),
        cause: at(30),
        source: side(1, Layout::TransferSrcOptimal),
        target: side(2, Layout::TransferDstOptimal),
        filter: Some(Filter::Linear),
    });

    let of = |mip: u32, barrier: ImageBarrier| ImageBarrier { range: level(mip), ..barrier };
    let blit_read: State = (Stages::BLIT, Accesses::TRANSFER_READ, Layout::TransferSrcOptimal);
    let blit_written: State = (Stages::BLIT, Accesses::TRANSFER_WRITE, Layout::TransferDstOptimal);
    let sampled_before = (SAMPLED.0, Accesses::empty());
    let fresh = |mip, to| of(mip, barrier(&bloom, sampled_before, UNDEFINED, to, Hazard::FirstUse, None));
    let [mut tonemap, export] = tone_map(&bloom, COLOR, &screen, 3);
    if let Work::Render(scope) = &mut tonemap.work {
        scope.passes[0].accesses[0].range.mips = 3;
    }
    let read = (blit_read.0, Accesses::empty());
    let level_1 = of(1, barrier(&bloom, read, blit_read.2, SAMPLED, Hazard::LayoutChange, Some(2)));
    tonemap.image_barriers[0] = level_1;
    tonemap.image_barriers.push(of(2, between(&bloom, blit_written, SAMPLED, Hazard::ReadAfterWrite, 2)));
    let steps = vec![
        step(vec![fresh(0, COLOR)], scope(1, vec![attach(0, LoadOp::Clear)], None, vec![bright])),
        step(vec![of(0, between(&bloom, COLOR, SAMPLED, Hazard::ReadAfterWrite, 0)), fresh(1, COLOR)], below),
        step(vec![of(1, between(&bloom, COLOR, blit_read, Hazard::ReadAfterWrite, 1)), fresh(2, blit_written)], blit),
        tonemap,
        export,
    ];
    super::build::plan(vec![bloom, screen], 32768, steps)
}
