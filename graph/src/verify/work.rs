//! Whether the work of each step is well formed: rendering scopes and their attachments.
//!
//! The render area of a scope is all of its attachments: otherwise a clear would be partial and nothing could be said
//! about contents. On the way the steps get their dense form: a Plan is too large to be read several times.

use super::accesses::ATTACHMENT;
use super::findings::{Finding, Findings};
use super::layouts::planes;
use super::lookup::Scopes;
use super::names::Names;
use super::part_in_use::mip_extent;
use super::parts::overlap;
use super::program::{Builder, Program};
use super::structure::clear_fits;
use super::violation::{Accessed, Rule, StepName};
use crate::frame::{Cadence, Draw};
use crate::plan::names::ShownText;
use crate::plan::{
    Access, Attachment, AttachmentResolve, Image, ImageId, Pass, Plan, Queue, RenderScope, Step, StepId, Work,
};
use crate::vulkan::{Accesses, Aspects, Layout, LoadOp, ResolveMode, Shape, Stages, StoreOp, Subresources, name_of};

/// No device has more colour attachments.
const MOST_COLORS: usize = 32;

/// Reports malformed steps; returns the steps in dense form, if they can be followed.
pub(super) fn check<'p>(plan: &'p Plan, found: &mut Findings<'p>) -> Option<Program> {
    let mut builder = Builder::new(plan, found);
    let mut names = Names::new(plan.steps.len());
    let mut calls = vec![0; plan.images.len()];
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        let Builder { found, scopes, .. } = &mut builder;
        let mut check = Check { plan, id, queue: step.queue, found, scopes, names: &mut names, calls: &mut calls };
        check.cadence(step);
        check.waits_and_barriers(step);
        check.step(step);
        builder.add(id, step);
    }
    builder.finish()
}

/// The check of one step.
pub(super) struct Check<'c, 'p> {
    pub(super) plan: &'p Plan,
    pub(super) id: StepId,
    pub(super) queue: Queue,
    pub(super) found: &'c mut Findings<'p>,
    pub(super) scopes: &'c mut Scopes,
    /// The passes up to here.
    names: &'c mut Names<'p>,
    /// For each image: the last call with a barrier of it. Each step numbers two calls, from 1 on.
    pub(super) calls: &'c mut [u32],
}

impl<'p> Check<'_, 'p> {
    #[cold]
    pub(super) fn wrong(&mut self, image: ImageId, what: impl Into<String>) {
        self.found.structure(Some(self.id), Some(image.0), what);
    }

    pub(super) fn demand(&mut self, holds: bool, image: ImageId, what: &str) {
        if !holds {
            self.wrong(image, what);
        }
    }

    #[cold]
    pub(super) fn wrong_pass(&mut self, pass: &Pass, what: &str) {
        self.found.structure(Some(self.id), None, format!("pass `{}` {what}", ShownText(&pass.name)));
    }

    #[cold]
    pub(super) fn wrong_step(&mut self, what: impl Into<String>) {
        self.found.structure(Some(self.id), None, what);
    }

    /// Barriers alone stand in each frame, and a step that is left out in some runs in others.
    fn cadence(&mut self, step: &Step) {
        match &step.run {
            Cadence::Always => {}
            _ if step.work.is_export() => self.wrong_step("has no work, and doesn't run in each frame"),
            Cadence::Every { count: 0 | 1, .. } => self.wrong_step("runs in a round of fewer than two frames"),
            Cadence::Every { count, at } if at >= count => {
                self.wrong_step("runs in a frame behind the last of its round")
            }
            Cadence::WhenDirty(name) if name.is_empty() => {
                self.wrong_step("runs when something without a name is dirty")
            }
            Cadence::Once | Cadence::Every { .. } | Cadence::WhenDirty(_) => {}
        }
    }

    fn step(&mut self, step: &'p Step) {
        let (graphics, compute) = match step.work {
            Work::Render(_) | Work::Resolve(_) | Work::Blit(_) => (true, false),
            Work::Dispatch(_) => (false, true),
            Work::Custom(_) | Work::Copy(_) | Work::Fill(_) | Work::Export => (false, false),
        };
        if graphics && step.queue != Queue::Graphics || compute && step.queue == Queue::Transfer {
            self.wrong_step(format!("does what {} can't", name_of(&step.queue)));
        }
        match &step.work {
            Work::Render(scope) => self.scope(scope),
            Work::Dispatch(pass) => self.dispatch(pass),
            Work::Custom(pass) => self.custom(pass),
            Work::Resolve(transfer) => self.resolve(transfer),
            Work::Copy(transfer) => self.copy(transfer),
            Work::Blit(transfer) => self.blit(transfer),
            Work::Fill(fill) => self.fill(fill),
            Work::Export => {}
        }
    }

    /// No two passes have one name.
    pub(super) fn named(&mut self, name: &'p str) {
        if !self.names.insert(name) {
            self.wrong_step("a pass has the name of another pass");
        }
    }

    fn scope(&mut self, scope: &'p RenderScope) {
        if scope.attachments.is_empty() || scope.color().len() > MOST_COLORS {
            let count = scope.color().len();
            self.wrong_step(format!("has {count} colour attachments, or none at all, as no rendering scope can"));
        }
        if !scope.is_in_order() {
            self.wrong_step("lists attachments out of order (colour, depth, stencil), or has two of depth or stencil");
        }
        for attachment in &scope.attachments {
            self.attachment(scope, attachment, attachment.kind.plane());
        }
        if let (Some(depth), Some(stencil)) = (scope.depth(), scope.stencil()) {
            let part = |of: &Attachment| (of.image, Subresources { aspects: Aspects::empty(), ..of.range });
            let alike = part(depth) == part(stencil);
            self.demand(alike, stencil.image, "is the stencil attachment beside the depth of another part or image");
        }
        // These compare attachments with each other, however they are ordered.
        let few = scope.attachments.len() <= MOST_COLORS + 2;
        if few {
            self.exclusive(scope);
        }
        for pass in &scope.passes {
            self.draw(scope, pass);
        }
        if few {
            self.local_reads(scope);
        }
    }

    fn attachment(&mut self, scope: &RenderScope, attachment: &Attachment, plane: Aspects) {
        let Attachment { image: id, range, layout, .. } = *attachment;
        let image = self.plan.image(id);
        self.target(scope, image, range, plane);
        self.demand(image.samples == scope.samples, id, "has another sample count than its scope");
        let read_only = is_read_only(layout);
        let fits = read_only || layout == Layout::RenderingLocalReadKhr || is_written(layout);
        self.demand(
            fits && planes(layout, image.format.aspects()).contains(plane),
            id,
            "can't be an attachment in its layout",
        );
        let untouched = attachment.load == LoadOp::Load && attachment.store == StoreOp::None;
        self.demand(!read_only || untouched, id, "is attached read-only, which takes a LOAD load and a NONE store");
        let clears = attachment.load == LoadOp::Clear;
        self.demand(attachment.clear.is_some() == clears, id, "has a clear value exactly if its load is CLEAR");
        let held = attachment.clear.is_none_or(|clear| clear_fits(image.format, plane, clear));
        self.demand(held, id, "has a clear value that its format doesn't hold");
        if let Some(resolve) = &attachment.resolve {
            self.attachment_resolve(scope, image, resolve, plane);
        }
    }

    fn attachment_resolve(&mut self, scope: &RenderScope, source: &Image, resolve: &AttachmentResolve, plane: Aspects) {
        let target = self.plan.image(resolve.image);
        self.target(scope, target, resolve.range, plane);
        self.demand(source.samples > 1, source.id, "is resolved and has one sample");
        self.demand(target.samples == 1, target.id, "is the target of a resolve and multisampled");
        self.demand(target.format == source.format, target.id, "is the target of a resolve from another format");
        let (mode, format) = (resolve.mode, source.format);
        let fits = match (plane, format.is_integer()) {
            (Aspects::DEPTH, _) => true,
            (Aspects::STENCIL, _) => mode != ResolveMode::Average,
            (_, true) => mode == ResolveMode::SampleZero,
            (_, false) => mode == ResolveMode::Average,
        };
        self.demand(fits, source.id, "can't be resolved in that mode with its format");
        let fits = is_written(resolve.layout) && planes(resolve.layout, format.aspects()).contains(plane);
        self.demand(fits, target.id, "can't be the target of a resolve in its layout");
    }

    /// Checks that attachments and targets of resolves share.
    fn target(&mut self, scope: &RenderScope, image: &Image, range: Subresources, plane: Aspects) {
        self.demand(image.shape != Shape::D3, image.id, "is three-dimensional and can't be an attachment");
        self.demand(image.format.aspects().contains(plane), image.id, "has a format that doesn't fit its attachment");
        self.demand(range.mips == 1, image.id, "is attached with more than one mip level");
        self.demand(range.layers == scope.layers, image.id, "is attached with another number of layers than its scope");
        let [width, height, _] = mip_extent(image, range.base_mip);
        self.demand(scope.extent == [width, height], image.id, "has another size than its scope");
        self.demand(range.aspects == plane, image.id, "is attached with other planes than the one that is drawn to");
    }

    /// Nothing in a scope may access what another part of it writes, but for read-only depth and local reads.
    fn exclusive(&mut self, scope: &RenderScope) {
        let resolves = || scope.attachments.iter().filter_map(|attachment| attachment.resolve.as_ref());
        let targets = || {
            let attached = scope.attachments.iter().map(|attachment| (attachment.image, attachment.range));
            attached.chain(resolves().map(|resolve| (resolve.image, resolve.range)))
        };
        for (at, (image, range)) in targets().enumerate() {
            let twice = targets().take(at).any(|(other, part)| other == image && overlap(part, range));
            self.demand(!twice, image, "is attached twice");
        }
        let resolves_any = resolves().next().is_some();
        for access in scope.passes.iter().flat_map(|pass| &pass.accesses) {
            let same = |image: ImageId, range| image == access.image && overlap(range, access.range);
            if resolves_any && resolves().any(|resolve| same(resolve.image, resolve.range)) {
                self.wrong(access.image, "is the target of a resolve and used otherwise in the same scope");
            }
            if ATTACHMENT.contains(access.accesses) {
                continue;
            }
            let attachment = scope.attachments.iter().find(|attachment| same(attachment.image, attachment.range));
            let Some(attachment) = attachment else { continue };
            let read_only = is_read_only(attachment.layout)
                && access.layout == attachment.layout
                && access.accesses.writes().is_empty();
            let own = access.accesses == Accesses::INPUT_ATTACHMENT_READ
                && access.range == attachment.range
                && access.layout == attachment.layout
                && matches!(access.layout, Layout::RenderingLocalReadKhr | Layout::General);
            if !read_only && !own {
                self.wrong(access.image, "is an attachment and accessed by a shader in the same scope");
            }
        }
    }

    /// A local barrier must stand between passes of the scope that draw a colour and those that read it at their own position,
    /// and before passes that draw over a colour that was read. Such a barrier is about colour only: tests of depth come before
    /// fragment shaders.
    fn local_reads(&mut self, scope: &RenderScope) {
        let local = |access: &&Access| access.accesses.intersects(Accesses::INPUT_ATTACHMENT_READ);
        let reads = |pass: &Pass| pass.accesses.iter().any(|access| local(&access));
        if !scope.passes.iter().any(reads) {
            return;
        }
        let begun = scope.attachments.iter().filter(|attachment| attachment.load != LoadOp::Load);
        let mut drawn: Vec<_> = begun.map(|attachment| (attachment.image, attachment.range)).collect();
        let mut read: Vec<(ImageId, Subresources)> = Vec::new();
        for pass in &scope.passes {
            if pass.local_barrier {
                for known in [&mut drawn, &mut read] {
                    known.retain(|(_, range)| !range.aspects.contains(Aspects::COLOR));
                }
            }
            for access in pass.accesses.iter().filter(local) {
                let attached = scope.attachments.iter().any(|attachment| attachment.image == access.image);
                self.demand(attached, access.image, "is read at its own position and no attachment of the scope");
                if let Some((image, range)) =
                    drawn.iter().find(|(image, range)| *image == access.image && overlap(*range, access.range))
                {
                    self.apart(*image, *range, [written(*range), READ]);
                }
            }
            let writes =
                pass.accesses.iter().filter(|access| access.accesses.intersects(ATTACHMENT & Accesses::WRITES));
            for write in writes {
                let feedback = pass
                    .accesses
                    .iter()
                    .any(|access| local(&access) && access.image == write.image && overlap(access.range, write.range));
                self.demand(
                    !feedback || pass.draw.is_some_and(Draw::is_full_screen),
                    write.image,
                    "is read at its own position by a pass that may draw to it more than once",
                );
                let before = read.iter().find(|(image, range)| *image == write.image && overlap(*range, write.range));
                if before.is_some() {
                    self.apart(write.image, write.range, [READ, written(write.range)]);
                }
                if is_attached(scope, write) && !drawn.contains(&(write.image, write.range)) {
                    drawn.push((write.image, write.range));
                }
            }
            for own in pass.accesses.iter().filter(local).filter(|access| is_attached(scope, access)) {
                if !read.contains(&(own.image, own.range)) {
                    read.push((own.image, own.range));
                }
            }
        }
    }

    /// Two accesses of one scope that no local barrier keeps apart.
    fn apart(&mut self, image: ImageId, range: Subresources, [earlier, later]: [(Stages, Accesses); 2]) {
        self.found.push(Finding {
            rule: Rule::Execution {
                earlier: Accessed::By(earlier.0, earlier.1),
                later: Accessed::By(later.0, later.1),
            },
            step: self.id,
            other: Some(StepName::new(self.plan, self.id, 0)),
            resource: image.0,
            range: Some(range),
            bytes: None,
        });
    }
}

/// Whether an access is to all of an attachment.
pub(super) fn is_attached(scope: &RenderScope, access: &Access) -> bool {
    scope.attachments.iter().any(|attachment| (attachment.image, attachment.range) == (access.image, access.range))
}

/// A read at a fragment's own position.
const READ: (Stages, Accesses) = (Stages::FRAGMENT_SHADER, Accesses::INPUT_ATTACHMENT_READ);

/// How draws write a plane.
fn written(range: Subresources) -> (Stages, Accesses) {
    match range.aspects {
        Aspects::COLOR => (Stages::COLOR_ATTACHMENT_OUTPUT, Accesses::COLOR_ATTACHMENT_WRITE),
        _ => (Stages::LATE_FRAGMENT_TESTS, Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE),
    }
}

/// Whether a layout is one of attachments that are written.
pub(super) const fn is_written(layout: Layout) -> bool {
    matches!(
        layout,
        Layout::ColorAttachmentOptimal
            | Layout::DepthStencilAttachmentOptimal
            | Layout::DepthAttachmentOptimal
            | Layout::StencilAttachmentOptimal
            | Layout::General
    )
}

/// Whether a layout is one of depth or stencil that is only read.
pub(super) const fn is_read_only(layout: Layout) -> bool {
    matches!(
        layout,
        Layout::DepthStencilReadOnlyOptimal | Layout::DepthReadOnlyOptimal | Layout::StencilReadOnlyOptimal
    )
}
