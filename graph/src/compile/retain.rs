//! `retain`: load and store operations of attachments. Contents are kept only where a later use needs them.

use super::model::{AdaptedFrame, InitialContents, MemorySource, OpKind, Role, Use};
use super::scope::{Scope, ScopedSteps, Step, Target};
use crate::frame::Frame;
use crate::plan::AttachmentKind;
use crate::vulkan::{AccessKind, Accesses, LoadOp, Stages, StoreOp};

/// Load and store operations of one attachment of a scope.
#[derive(Debug, Clone, Copy)]
pub(super) struct AttachmentOps {
    pub(super) target: Target,
    pub(super) role: Role,
    pub(super) load: LoadOp,
    pub(super) store: StoreOp,
    pub(super) clear: Option<[f64; 4]>,
    /// The operation that uses it first.
    pub(super) first: u32,
    /// The next use of its contents.
    pub(super) next: LaterUse,
    /// Whether a pass of the scope writes it.
    written: bool,
    /// Whether its contents from before the scope are needed: it loads them, or the scope may be left out.
    needs_before: bool,
}

/// The next use of an attachment's contents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LaterUse {
    /// None.
    Nobody,
    /// They are overwritten.
    Replaced,
    /// An operation reads or keeps them.
    Op(u32),
    /// They outlive the frame.
    After,
}

/// Load and store operations of all attachments.
#[derive(Debug, Default)]
pub(super) struct LoadStoreOps {
    ops: Vec<AttachmentOps>,
    /// For each step where its attachments begin; empty if nothing is drawn.
    starts: Vec<u32>,
}

impl LoadStoreOps {
    /// The attachments of a step: colour by location, then depth, then stencil.
    pub(super) fn of(&self, step: u32) -> &[AttachmentOps] {
        match self.starts.get(step as usize..step as usize + 2) {
            Some([start, end]) => &self.ops[*start as usize..*end as usize],
            _ => &[],
        }
    }
}

impl AttachmentOps {
    /// Stages and accesses of its load operation.
    pub(super) fn load_access(&self) -> (Stages, Accesses) {
        let loads = self.load == LoadOp::Load;
        let accesses = |kind: AccessKind| kind.accesses(loads, !loads);
        if self.role.is_color() {
            return (Stages::COLOR_ATTACHMENT_OUTPUT, accesses(AccessKind::ColorAttachment));
        }
        (Stages::EARLY_FRAGMENT_TESTS, accesses(AccessKind::DepthAttachment))
    }

    /// Stages and accesses of its store operation; a store operation `NONE` is no access.
    pub(super) fn store_access(&self) -> Option<(Stages, Accesses)> {
        let (stages, kind) = match self.role.is_color() {
            true => (Stages::COLOR_ATTACHMENT_OUTPUT, AccessKind::ColorAttachment),
            false => (Stages::LATE_FRAGMENT_TESTS, AccessKind::DepthAttachment),
        };
        (self.store != StoreOp::None).then(|| (stages, kind.accesses(false, true)))
    }
}

pub(super) fn retain(frame: &Frame, adapted: &AdaptedFrame, scoped: &ScopedSteps) -> LoadStoreOps {
    if !scoped.steps.iter().any(|step| matches!(step, Step::Scope(_))) {
        return LoadStoreOps::default();
    }
    let mut walk = Walk { frame, adapted, ops: Vec::new(), last: vec![NONE; adapted.subresources as usize] };
    let mut starts = Vec::with_capacity(scoped.steps.len() + 1);
    for step in &scoped.steps {
        starts.push(walk.ops.len() as u32);
        match step {
            Step::Scope(scope) => walk.scope(scope),
            Step::Single(op) => adapted.uses(*op).iter().for_each(|used| walk.access(*op, used)),
            Step::BarriersOnly => {}
        }
    }
    starts.push(walk.ops.len() as u32);
    walk.after();
    let Walk { mut ops, .. } = walk;
    for attachment in &mut ops {
        attachment.store = match (attachment.written, attachment.next) {
            (false, _) => StoreOp::None,
            (true, LaterUse::Op(_) | LaterUse::After) => StoreOp::Store,
            (true, LaterUse::Nobody | LaterUse::Replaced) => StoreOp::DontCare,
        };
    }
    LoadStoreOps { ops, starts }
}

/// No attachment.
const NONE: u32 = u32::MAX;

struct Walk<'w> {
    frame: &'w Frame,
    adapted: &'w AdaptedFrame,
    ops: Vec<AttachmentOps>,
    /// For each subresource the attachment that holds its contents.
    last: Vec<u32>,
}

impl Walk<'_> {
    fn scope(&mut self, scope: &Scope) {
        let first = self.ops.len();
        let roles = scope.color.iter().map(|target| (*target, Role::Color));
        let depth = scope.depth.map(|target| (target, Role::Depth));
        let stencil = scope.stencil.map(|target| (target, Role::Stencil));
        for (target, role) in roles.chain(depth).chain(stencil) {
            let made = self.attachment(scope, target, role);
            self.ops.push(made);
        }
        for at in first..self.ops.len() {
            if self.ops[at].needs_before {
                let AttachmentOps { target, first, .. } = self.ops[at];
                self.each(target, |walk, subresource| walk.needed(subresource, LaterUse::Op(first)));
            }
        }
        for op in &scope.ops {
            let from_memory = |used: &&Use| !used.role.is_attachment() && !used.role.is_input();
            for used in self.adapted.uses(*op).iter().filter(from_memory) {
                self.access(*op, used);
            }
        }
        for at in first..self.ops.len() {
            if self.ops[at].written {
                let target = self.ops[at].target;
                self.each(target, |walk, subresource| walk.replaced(subresource, at as u32));
            }
        }
        for op in scope.folded_resolves() {
            if let Some(target) = self.adapted.uses(op).get(1) {
                self.access(op, target);
            }
        }
    }

    /// An attachment: its first use says how it is loaded, and any use that writes it that it is written.
    fn attachment(&self, scope: &Scope, target: Target, role: Role) -> AttachmentOps {
        let Walk { frame, adapted, .. } = self;
        let is_it =
            |used: &&Use| used.role == role && used.resource == target.resource && adapted.range(used) == target.range;
        let mut made = AttachmentOps {
            target,
            role,
            load: LoadOp::Load,
            store: StoreOp::None,
            clear: None,
            first: NONE,
            next: LaterUse::Nobody,
            written: false,
            needs_before: false,
        };
        for op in &scope.ops {
            let Some(used) = adapted.uses(*op).iter().find(is_it) else { continue };
            made.written |= used.writes;
            // What it would overwrite must be there if it is left out. Of what is transient nothing is read in frames without it.
            let stays = used.writes && !adapted.resources[used.resource as usize].is_transient();
            made.needs_before |= stays && !adapted.cadence(*op).is_always();
            if made.first != NONE {
                continue;
            }
            made.first = *op;
            (made.load, made.clear) = match used.contents {
                InitialContents::Keep => (LoadOp::Load, None),
                InitialContents::Discard => (LoadOp::DontCare, None),
                InitialContents::Clear => (LoadOp::Clear, clear_value(frame, &adapted.ops[*op as usize].kind, used)),
            };
        }
        made.needs_before |= made.load == LoadOp::Load;
        made
    }

    fn each(&mut self, target: Target, mut visit: impl FnMut(&mut Self, u32)) {
        self.adapted.resources[target.resource as usize].for_each_in(target.range, |at| visit(self, at));
    }

    fn access(&mut self, op: u32, used: &Use) {
        let adapted = self.adapted;
        adapted.for_each_subresource(used, |subresource| {
            if used.reads {
                self.needed(subresource, LaterUse::Op(op));
            }
            if used.writes {
                self.replaced(subresource, NONE);
            }
        });
    }

    /// Notes that the contents of a subresource are needed.
    fn needed(&mut self, subresource: u32, by: LaterUse) {
        if let Some(attachment) = self.ops.get_mut(self.last[subresource as usize] as usize)
            && !matches!(attachment.next, LaterUse::Op(_))
        {
            attachment.next = by;
        }
    }

    /// Notes that a subresource is overwritten.
    fn replaced(&mut self, subresource: u32, by: u32) {
        let last = std::mem::replace(&mut self.last[subresource as usize], by);
        if let Some(attachment) = self.ops.get_mut(last as usize).filter(|_| last != by)
            && attachment.next == LaterUse::Nobody
        {
            attachment.next = LaterUse::Replaced;
        }
    }

    /// Notes that contents are needed that outlive the frame.
    fn after(&mut self) {
        for (resource, next) in
            self.adapted.resources.iter().zip(self.adapted.resources.iter().skip(1).map(Some).chain([None]))
        {
            if resource.memory != MemorySource::Transient {
                let end = next.map_or(self.adapted.subresources, |next| next.first_subresource);
                (resource.first_subresource..end).for_each(|subresource| self.needed(subresource, LaterUse::After));
            }
        }
    }
}

/// Takes over the clear values that the frame says now.
pub(super) fn renew_clear_values(frame: &Frame, adapted: &AdaptedFrame, load_store: &mut LoadStoreOps) {
    for attachment in load_store.ops.iter_mut().filter(|attachment| attachment.load == LoadOp::Clear) {
        let AttachmentOps { target, role, first, .. } = *attachment;
        let is_it =
            |used: &&Use| used.role == role && used.resource == target.resource && adapted.range(used) == target.range;
        if let Some(used) = adapted.uses(first).iter().find(is_it) {
            attachment.clear = clear_value(frame, &adapted.ops[first as usize].kind, used);
        }
    }
}

/// The clear value that a pass of the frame gives.
fn clear_value(frame: &Frame, kind: &OpKind, used: &Use) -> Option<[f64; 4]> {
    let pass = &frame.passes[kind.pass()? as usize];
    match used.role.attachment()? {
        AttachmentKind::Color => pass.color.get(used.entry as usize)?.clear,
        AttachmentKind::Depth => pass.depth.as_ref()?.clear.map(|value| [value, 0.0, 0.0, 0.0]),
        AttachmentKind::Stencil => pass.depth.as_ref()?.stencil?.clear.map(|value| [f64::from(value), 0.0, 0.0, 0.0]),
    }
}
