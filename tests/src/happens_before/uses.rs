//! The uses that the work of a step makes of images and buffers, as the Plan's module documentation says.

use framewright_graph::frame::Draw;
use framewright_graph::plan::{Attachment, AttachmentKind, BindingKind, Pass, RenderScope, Resource, Side, Work};
use framewright_graph::vulkan::{Accesses, Layout, LoadOp, Stages, StoreOp, Subresources};

/// One use.
#[derive(Debug, Clone, Copy)]
pub(super) struct Use {
    pub(super) resource: Resource,
    pub(super) range: Subresources,
    /// `None` for buffers.
    pub(super) layout: Option<Layout>,
    pub(super) stages: Stages,
    pub(super) accesses: Accesses,
    pub(super) kind: Kind,
    /// The pass of a rendering scope that makes it.
    pub(super) pass: usize,
}

/// The barriers and scopes that keep uses of one step apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A shader's, a transfer's, a fixed function's outside of attachments: nothing.
    Plain,
    /// By what an embedding program records: its own matter.
    Custom,
    /// A draw's, as attachment: rasterisation order among them.
    Attachment {
        /// The first pass behind the last by-region barrier. Earlier passes' reads at their own position stand before it.
        shown: usize,
    },
    /// An input attachment.
    Input {
        /// The first pass behind the last by-region barrier. Earlier passes' draws stand before it.
        shown: usize,
        /// Whether its pass draws each texel once.
        once: bool,
    },
    /// A load operation: before all draws.
    Load,
    /// A store operation: after all draws.
    Store,
    /// The target of a resolve at the end of a scope.
    ResolveTarget,
}

const ATTACHMENT: Accesses = Accesses::COLOR_ATTACHMENT_READ
    .union(Accesses::COLOR_ATTACHMENT_WRITE)
    .union(Accesses::DEPTH_STENCIL_ATTACHMENT_READ)
    .union(Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE);

/// Everything that `work` touches.
pub(super) fn of(work: &Work) -> Vec<Use> {
    match work {
        Work::Render(scope) => of_scope(scope),
        Work::Dispatch(pass) => of_pass(pass, [0; 2], Kind::Plain),
        Work::Custom(pass) => of_pass(pass, [0; 2], Kind::Custom),
        Work::Resolve(transfer) => of_transfer(&transfer.source, &transfer.target, Stages::RESOLVE),
        Work::Copy(transfer) => of_transfer(&transfer.source, &transfer.target, Stages::COPY),
        Work::Blit(transfer) => of_transfer(&transfer.source, &transfer.target, Stages::BLIT),
        Work::Fill(fill) => vec![of_side(&fill.target, Stages::CLEAR, Accesses::TRANSFER_WRITE)],
        Work::Export => Vec::new(),
    }
}

fn of_transfer(source: &Side, target: &Side, stages: Stages) -> Vec<Use> {
    vec![of_side(source, stages, Accesses::TRANSFER_READ), of_side(target, stages, Accesses::TRANSFER_WRITE)]
}

fn of_side(side: &Side, stages: Stages, accesses: Accesses) -> Use {
    let (range, layout) = match side {
        Side::Image { range, layout, .. } => (*range, Some(*layout)),
        Side::Buffer { .. } => (Subresources::WHOLE, None),
    };
    Use { resource: side.resource(), range, layout, stages, accesses, kind: Kind::Plain, pass: 0 }
}

/// The accesses of a pass: its number in its scope, and that of the last pass up to it with a by-region barrier.
pub(super) fn of_pass(pass: &Pass, [number, shown]: [usize; 2], plain: Kind) -> Vec<Use> {
    let images = pass.accesses.iter().map(|access| {
        let input = access.binding.as_ref().is_some_and(|binding| binding.kind == BindingKind::InputAttachment);
        Use {
            resource: Resource::Image(access.image),
            range: access.range,
            layout: Some(access.layout),
            stages: access.stages,
            accesses: access.accesses,
            kind: match () {
                () if input => Kind::Input { shown, once: pass.draw == Some(Draw::FullScreen) },
                () if ATTACHMENT.contains(access.accesses) => Kind::Attachment { shown },
                () => plain,
            },
            pass: number,
        }
    });
    let buffers = pass.buffers.iter().map(|access| Use {
        resource: Resource::Buffer(access.buffer),
        range: Subresources::WHOLE,
        layout: None,
        stages: access.stages,
        accesses: access.accesses,
        kind: plain,
        pass: number,
    });
    images.chain(buffers).collect()
}

/// The attachments of a scope: colour, then depth and stencil; whether each is colour.
pub(super) fn attachments(scope: &RenderScope) -> impl Iterator<Item = (&Attachment, bool)> {
    scope.attachments.iter().map(|attachment| (attachment, attachment.kind == AttachmentKind::Color))
}

fn of_scope(scope: &RenderScope) -> Vec<Use> {
    let mut uses = Vec::new();
    let last = scope.passes.len();
    for (attachment, color) in attachments(scope) {
        let (stages, read, write) = if color {
            (Stages::COLOR_ATTACHMENT_OUTPUT, Accesses::COLOR_ATTACHMENT_READ, Accesses::COLOR_ATTACHMENT_WRITE)
        } else {
            let [read, write] = [Accesses::DEPTH_STENCIL_ATTACHMENT_READ, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE];
            (Stages::EARLY_FRAGMENT_TESTS, read, write)
        };
        let own = Use {
            resource: Resource::Image(attachment.image),
            range: attachment.range,
            layout: Some(attachment.layout),
            stages,
            accesses: if attachment.load == LoadOp::Load { read } else { write },
            kind: Kind::Load,
            pass: 0,
        };
        uses.push(own);
        let store = Use { kind: Kind::Store, pass: last, ..own };
        if let Some(resolve) = &attachment.resolve {
            let stages = Stages::COLOR_ATTACHMENT_OUTPUT;
            uses.push(Use { stages, accesses: Accesses::COLOR_ATTACHMENT_READ, ..store });
            uses.push(Use {
                resource: Resource::Image(resolve.image),
                range: resolve.range,
                layout: Some(resolve.layout),
                stages,
                accesses: Accesses::COLOR_ATTACHMENT_WRITE,
                kind: Kind::ResolveTarget,
                pass: last,
            });
        }
        if attachment.store != StoreOp::None {
            let stages = if color { stages } else { Stages::LATE_FRAGMENT_TESTS };
            uses.push(Use { stages, accesses: write, ..store });
        }
    }
    let mut shown = 0;
    for (number, pass) in scope.passes.iter().enumerate() {
        shown = if pass.local_barrier { number } else { shown };
        uses.extend(of_pass(pass, [number, shown], Kind::Plain));
    }
    uses
}

/// Whether two uses of one image by one step are kept in order without a barrier.
pub(super) fn ordered_within_a_step(one: &Use, other: &Use) -> bool {
    let attached = |of: &Use| matches!(of.kind, Kind::Attachment { .. } | Kind::Load | Kind::Store);
    let reads = |of: &Use| of.accesses.writes().is_empty();
    let ends = |of: &Use| matches!(of.kind, Kind::Load | Kind::Store);
    let local = |input: &Use, attachment: &Use| match input.kind {
        // Rasterisation order is that of attachments: it says nothing of what shaders read. The barrier is about colour.
        Kind::Input { shown, once } => {
            let own = attachment.pass == input.pass && once;
            let color = attachment.stages == Stages::COLOR_ATTACHMENT_OUTPUT;
            match attachment.kind {
                Kind::Attachment { shown: over } => attachment.pass < shown || own || (color && over > input.pass),
                Kind::Load => shown > 0 || reads(attachment),
                Kind::Store => true,
                _ => reads(attachment),
            }
        }
        _ => false,
    };
    if matches!(one.kind, Kind::Input { .. }) || matches!(other.kind, Kind::Input { .. }) {
        return local(one, other) || local(other, one);
    }
    (one.kind == Kind::Custom && other.kind == Kind::Custom)
        || (attached(one) && attached(other))
        || (ends(one) && reads(other))
        || (ends(other) && reads(one))
}
