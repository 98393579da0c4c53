//! Whether the work of each step is well formed: scopes, attachments, passes, copies and resolves.
//!
//! The render area of a scope is all of its attachments: otherwise a clear would be partial and nothing could be said
//! about contents.

use super::Findings;
use super::structure::{check_scope, overlap};
use super::touches::ATTACHMENT;
use crate::frame::Blend;
use crate::plan::names::{Shown, vulkan};
use crate::plan::{
    Access, Attachment, AttachmentResolve, BindingKind, Image, ImageId, Pass, Plan, RenderScope, Side, Step, StepId,
    Subresources, Transfer, Work,
};
use crate::vocabulary::{Accesses, Aspects, CompareOp, Filter, Layout, LoadOp, ResolveMode, Stages, StoreOp};

const SHADER: Accesses =
    Accesses::SHADER_SAMPLED_READ.union(Accesses::SHADER_STORAGE_READ).union(Accesses::SHADER_STORAGE_WRITE);

/// The passes of a step.
pub(super) fn passes(work: &Work) -> &[Pass] {
    match work {
        Work::Render(scope) => &scope.passes,
        Work::Dispatch(pass) | Work::Custom(pass) => std::slice::from_ref(pass),
        Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Fill(_) | Work::Export => &[],
    }
}

/// Reports what is malformed in the work of the steps.
pub(super) fn check<'p>(plan: &'p Plan, found: &mut Findings<'p>) {
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        Check { plan, id, found }.step(step);
    }
}

struct Check<'c, 'p> {
    plan: &'p Plan,
    id: StepId,
    found: &'c mut Findings<'p>,
}

impl<'p> Check<'_, 'p> {
    fn wrong(&mut self, image: ImageId, what: impl Into<String>) {
        self.found.structure(Some(self.id), Some(image), what);
    }

    fn demand(&mut self, holds: bool, image: ImageId, what: &str) {
        if !holds {
            self.wrong(image, what);
        }
    }

    fn wrong_pass(&mut self, pass: &Pass, what: &str) {
        self.found.structure(Some(self.id), None, format!("pass `{}` {what}", Shown(&pass.name)));
    }

    fn step(&mut self, step: &Step) {
        match &step.work {
            Work::Render(scope) => self.scope(scope),
            Work::Dispatch(pass) => self.dispatch(pass),
            Work::Resolve(transfer) => self.resolve(transfer),
            Work::Copy(transfer) => self.copy(transfer),
            Work::Custom(_) | Work::Blit(_) | Work::Fill(_) | Work::Export => {}
        }
    }

    fn scope(&mut self, scope: &RenderScope) {
        for attachment in &scope.color {
            self.attachment(scope, attachment, false);
        }
        for attachment in scope.depth.iter().chain(&scope.stencil) {
            self.attachment(scope, attachment, true);
        }
        self.exclusive(scope);
        for pass in &scope.passes {
            self.draw(scope, pass);
        }
    }

    fn attachment(&mut self, scope: &RenderScope, attachment: &Attachment, depth: bool) {
        let Attachment { image: id, range, .. } = *attachment;
        let image = self.plan.image(id);
        self.target(scope, image, range);
        self.demand(image.format.is_depth() == depth, id, "has a format that doesn't fit its attachment");
        self.demand(image.samples == scope.samples, id, "has another sample count than its scope");
        let optimal = if depth { Layout::DepthStencilAttachmentOptimal } else { Layout::ColorAttachmentOptimal };
        let read_only = depth && attachment.layout == Layout::DepthStencilReadOnlyOptimal;
        let fits = read_only || [optimal, Layout::General].contains(&attachment.layout);
        self.demand(fits, id, "can't be an attachment in its layout");
        let untouched = attachment.load == LoadOp::Load && attachment.store == StoreOp::None;
        self.demand(!read_only || untouched, id, "is attached read-only, which takes a LOAD load and a NONE store");
        let clears = attachment.load == LoadOp::Clear;
        self.demand(attachment.clear.is_some() == clears, id, "has a clear value exactly if its load is CLEAR");
        let finite = attachment.clear.iter().flatten().all(|value| value.is_finite());
        self.demand(finite, id, "has a clear value that is not finite");
        if let Some(resolve) = &attachment.resolve {
            self.attachment_resolve(scope, image, resolve);
        }
    }

    fn attachment_resolve(&mut self, scope: &RenderScope, source: &Image, resolve: &AttachmentResolve) {
        let target = self.plan.image(resolve.image);
        self.target(scope, target, resolve.range);
        self.demand(source.samples > 1, source.id, "is resolved and has one sample");
        self.demand(target.samples == 1, target.id, "is the target of a resolve and multisampled");
        self.demand(target.format == source.format, target.id, "is the target of a resolve from another format");
        let (mode, format) = (resolve.mode, source.format);
        let fits = match (format.is_depth(), format.is_integer()) {
            (true, _) => true,
            (false, true) => mode == ResolveMode::SampleZero,
            (false, false) => mode == ResolveMode::Average,
        };
        self.demand(fits, source.id, "can't be resolved in that mode with its format");
        let optimal =
            if format.is_depth() { Layout::DepthStencilAttachmentOptimal } else { Layout::ColorAttachmentOptimal };
        let fits = [optimal, Layout::General].contains(&resolve.layout);
        self.demand(fits, target.id, "can't be the target of a resolve in its layout");
    }

    /// What attachments and targets of resolves have in common.
    fn target(&mut self, scope: &RenderScope, image: &Image, range: Subresources) {
        self.demand(range.mips == 1, image.id, "is attached with more than one mip level");
        self.demand(range.layers == scope.layers, image.id, "is attached with another number of layers than its scope");
        let [width, height, _] = mip_extent(image, range.base_mip);
        self.demand(scope.extent == [width, height], image.id, "has another size than its scope");
        let part = if image.format.is_depth() { Aspects::DEPTH } else { Aspects::COLOR };
        self.demand(range.aspects.contains(part), image.id, "is attached without the plane that is drawn to");
    }

    /// Nothing in a scope may touch what another part of it writes, but for read-only depth.
    fn exclusive(&mut self, scope: &RenderScope) {
        let attachments: Vec<&Attachment> = scope.color.iter().chain(&scope.depth).chain(&scope.stencil).collect();
        let resolves: Vec<_> = attachments.iter().filter_map(|attachment| attachment.resolve.as_ref()).collect();
        let targets = attachments.iter().map(|attachment| (attachment.image, attachment.range));
        let targets: Vec<_> = targets.chain(resolves.iter().map(|resolve| (resolve.image, resolve.range))).collect();
        for (at, (image, range)) in targets.iter().enumerate() {
            let twice = targets[..at].iter().any(|(other, part)| other == image && overlap(*part, *range));
            self.demand(!twice, *image, "is attached twice");
        }
        for access in scope.passes.iter().flat_map(|pass| &pass.accesses) {
            let same = |image: ImageId, range| image == access.image && overlap(range, access.range);
            if resolves.iter().any(|resolve| same(resolve.image, resolve.range)) {
                self.wrong(access.image, "is the target of a resolve and used otherwise in the same scope");
            }
            let Some(attachment) = attachments.iter().find(|attachment| same(attachment.image, attachment.range))
            else {
                continue;
            };
            let read_only = attachment.layout == Layout::DepthStencilReadOnlyOptimal
                && access.layout == attachment.layout
                && access.accesses.writes().is_empty();
            if access.accesses.intersects(SHADER) && !read_only {
                self.wrong(access.image, "is an attachment and accessed by a shader in the same scope");
            }
        }
    }

    fn draw(&mut self, scope: &RenderScope, pass: &Pass) {
        if pass.draw.is_none() {
            self.wrong_pass(pass, "is in a rendering scope and draws nothing");
        }
        if pass.blend.len() != scope.color.len() {
            self.wrong_pass(pass, "doesn't say how each colour attachment is blended");
        }
        for (attachment, blend) in scope.color.iter().zip(&pass.blend) {
            let reads = *blend != Blend::Replace;
            let integer = self.plan.image(attachment.image).format.is_integer();
            self.demand(!(reads && integer), attachment.image, "has integers, which can't be blended");
            let read = if reads { Accesses::COLOR_ATTACHMENT_READ } else { Accesses::empty() };
            self.attached(pass, attachment, Accesses::COLOR_ATTACHMENT_WRITE | read);
        }
        match (&pass.depth, &scope.depth) {
            (Some(_), None) => self.wrong_pass(pass, "tests depth without a depth attachment"),
            (Some(state), Some(attachment)) => {
                let tests = !matches!(state.test, CompareOp::Always | CompareOp::Never);
                let read = if tests { Accesses::DEPTH_STENCIL_ATTACHMENT_READ } else { Accesses::empty() };
                let write = if state.write { Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE } else { Accesses::empty() };
                self.attached(pass, attachment, read | write);
                self.tested(pass, attachment);
                let written = state.write && attachment.layout == Layout::DepthStencilReadOnlyOptimal;
                self.demand(!written, attachment.image, "is attached read-only and written");
            }
            (None, _) => {}
        }
        let graphics = Stages::VERTEX_SHADER
            | Stages::FRAGMENT_SHADER
            | Stages::EARLY_FRAGMENT_TESTS
            | Stages::LATE_FRAGMENT_TESTS
            | Stages::COLOR_ATTACHMENT_OUTPUT;
        for access in &pass.accesses {
            self.access(access, graphics);
            let attached = scope.color.iter().chain(&scope.depth).chain(&scope.stencil).any(|attachment| {
                (attachment.image, attachment.range, attachment.layout) == (access.image, access.range, access.layout)
            });
            let stray = access.accesses.intersects(ATTACHMENT) && !attached;
            self.demand(!stray, access.image, "is accessed as an attachment that its scope doesn't have");
        }
        self.bindings(pass);
    }

    /// Whether `pass` says that it makes these accesses to an attachment.
    fn attached(&mut self, pass: &Pass, attachment: &Attachment, wanted: Accesses) {
        let listed = pass
            .accesses
            .iter()
            .filter(|access| access.image == attachment.image && access.range == attachment.range)
            .fold(Accesses::empty(), |all, access| all | access.accesses);
        if !listed.contains(wanted) {
            let what = format!("pass `{}` doesn't list its {}", Shown(&pass.name), vulkan(&(wanted - listed)));
            self.wrong(attachment.image, what);
        }
    }

    /// Depth may be tested and written before the fragment shader and after it: an access in one of both isn't the whole.
    fn tested(&mut self, pass: &Pass, attachment: &Attachment) {
        let tests = Stages::EARLY_FRAGMENT_TESTS | Stages::LATE_FRAGMENT_TESTS;
        let mut accesses = pass.accesses.iter().filter(|access| access.image == attachment.image);
        let partial = accesses.any(|access| access.accesses.intersects(ATTACHMENT) && !access.stages.contains(tests));
        self.demand(!partial, attachment.image, "is tested in EARLY_FRAGMENT_TESTS and LATE_FRAGMENT_TESTS alike");
    }

    fn dispatch(&mut self, pass: &Pass) {
        if pass.draw.is_some() || !pass.blend.is_empty() || pass.depth.is_some() {
            self.wrong_pass(pass, "is a dispatch with the state of a draw");
        }
        for access in &pass.accesses {
            self.access(access, Stages::COMPUTE_SHADER);
            let attachment = access.accesses.intersects(ATTACHMENT);
            self.demand(!attachment, access.image, "is accessed as an attachment by a dispatch");
        }
        self.bindings(pass);
    }

    fn access(&mut self, access: &Access, possible: Stages) {
        check_scope(self.id, Some(access.image), access.stages, access.accesses, self.found);
        if access.stages.is_empty() || access.accesses.is_empty() || !possible.contains(access.stages) {
            self.wrong(access.image, format!("is accessed in {}", vulkan(&access.stages)));
        }
        self.demand((ATTACHMENT | SHADER).contains(access.accesses), access.image, "is accessed as a pass can't");
        let read_only = access.accesses.writes().is_empty();
        let fits = match access.layout {
            Layout::General => true,
            Layout::ColorAttachmentOptimal => {
                (Accesses::COLOR_ATTACHMENT_READ | Accesses::COLOR_ATTACHMENT_WRITE).contains(access.accesses)
            }
            Layout::DepthStencilAttachmentOptimal => (Accesses::DEPTH_STENCIL_ATTACHMENT_READ
                | Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE)
                .contains(access.accesses),
            Layout::DepthStencilReadOnlyOptimal => {
                (Accesses::DEPTH_STENCIL_ATTACHMENT_READ | Accesses::SHADER_SAMPLED_READ).contains(access.accesses)
                    && self.plan.image(access.image).format.is_depth()
            }
            Layout::ShaderReadOnlyOptimal => access.accesses == Accesses::SHADER_SAMPLED_READ,
            _ => false,
        };
        let what = if read_only { "can't be read so in its layout" } else { "can't be written so in its layout" };
        self.demand(fits, access.image, what);
    }

    /// Each shader access is bound as what it is.
    fn bindings(&mut self, pass: &Pass) {
        let storage = Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE;
        for access in &pass.accesses {
            let fits = match access.binding.as_ref().map(|binding| binding.kind) {
                None => !access.accesses.intersects(SHADER),
                Some(BindingKind::Sampled(_)) => access.accesses.intersects(Accesses::SHADER_SAMPLED_READ),
                Some(BindingKind::Storage) => access.accesses.intersects(storage),
                Some(BindingKind::InputAttachment) => access.accesses.intersects(Accesses::INPUT_ATTACHMENT_READ),
            };
            self.demand(fits, access.image, "is accessed by a shader without such a binding");
            let linear =
                access.binding.as_ref().map(|binding| binding.kind) == Some(BindingKind::Sampled(Filter::Linear));
            let integer = self.plan.image(access.image).format.is_integer();
            self.demand(!(linear && integer), access.image, "has integers, which can't be filtered");
        }
    }

    fn resolve(&mut self, transfer: &Transfer) {
        let Some((source, target)) = self.transfer(transfer) else { return };
        self.demand(source.samples > 1, source.id, "is resolved and has one sample");
        self.demand(target.samples == 1, target.id, "is the target of a resolve and multisampled");
        self.demand(target.format == source.format, target.id, "is the target of a resolve from another format");
        self.demand(!source.format.is_depth(), source.id, "holds depth, which only a rendering scope can resolve");
    }

    fn copy(&mut self, transfer: &Transfer) {
        let Some((source, target)) = self.transfer(transfer) else { return };
        self.demand(target.samples == source.samples, target.id, "is copied to from another sample count");
        let colors = !source.format.is_depth() && !target.format.is_depth();
        let alike = colors && source.format.texel_bytes() == target.format.texel_bytes();
        self.demand(alike || source.format == target.format, target.id, "is copied to from a format of another kind");
    }

    fn transfer(&mut self, transfer: &Transfer) -> Option<(&'p Image, &'p Image)> {
        let plan = self.plan;
        let (
            Side::Image { image: source, range: from, extent: read, .. },
            Side::Image { image: target, range: to, extent: written, .. },
        ) = (transfer.source, transfer.target)
        else {
            return None;
        };
        let (source, target) = (plan.image(source), plan.image(target));
        self.demand(from.mips == 1 && to.mips == 1, target.id, "is transferred with more than one mip level");
        self.demand(from.layers == to.layers, target.id, "is transferred from another number of layers");
        self.demand(from.aspects == to.aspects, target.id, "is transferred from another plane");
        self.demand(source.id != target.id || !overlap(from, to), target.id, "is transferred onto itself");
        for (image, range, extent) in [(source, from, read), (target, to, written)] {
            let within = mip_extent(image, range.base_mip).iter().zip(&extent).all(|(all, part)| part <= all);
            self.demand(within && !extent.contains(&0), image.id, "is transferred beyond its size");
        }
        Some((source, target))
    }
}

/// Width, height and depth of a mip level.
fn mip_extent(image: &Image, mip: u32) -> [u32; 3] {
    image.extent.map(|texels| texels.checked_shr(mip).unwrap_or(0).max(1))
}
