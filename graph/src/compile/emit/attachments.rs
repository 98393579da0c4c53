//! Rendering scopes of the Plan, and why their attachments are loaded and stored as they are.

use super::passes;
use super::stage_results::{StageResults, cause};
use crate::compile::model::{OpKind, Role};
use crate::compile::retain::{AttachmentOps, LaterUse};
use crate::compile::scope::{Scope, Target, op_name};
use crate::plan::{Attachment, AttachmentKind, AttachmentResolve, ImageId, NextUse, Pass, Reason, RenderScope};
use crate::vulkan::{Layout, LoadOp};
use std::sync::Arc;

pub(super) fn scope(results: &StageResults<'_>, scope: &Scope, step: u32) -> RenderScope {
    let (extent, layers, samples) = shape(results, scope);
    let attachments = results.load_store.of(step);
    let mut resolves = scope.resolves.iter().copied();
    let mut planned = |ops: &AttachmentOps| {
        let kind = ops.role.attachment()?;
        let resolve = match kind {
            AttachmentKind::Color => resolves.next().flatten(),
            AttachmentKind::Depth => scope.depth_resolve,
            AttachmentKind::Stencil => None,
        };
        Some(attachment(results, scope, (kind, ops), resolve))
    };
    RenderScope {
        extent,
        layers,
        samples,
        attachments: attachments.iter().filter_map(&mut planned).collect(),
        passes: if scope.local {
            local_passes(results, scope, attachments)
        } else {
            scope.ops.iter().map(|op| passes::pass(results, *op)).collect()
        },
    }
}

/// The passes of a scope with local reads. A local barrier stands before the first pass that reads a drawn or cleared target,
/// and before a pass that draws over a target that was read, unless a barrier stands between already.
fn local_passes(results: &StageResults<'_>, scope: &Scope, attachments: &[AttachmentOps]) -> Vec<Pass> {
    let begun = attachments.iter().filter(|ops| ops.role.is_color() && ops.load != LoadOp::Load);
    let mut fresh: Vec<Target> = begun.map(|ops| ops.target).collect();
    let mut read: Vec<Target> = Vec::new();
    let mut passes = Vec::with_capacity(scope.ops.len());
    for op in &scope.ops {
        let mut pass = passes::pass(results, *op);
        let uses = results.adapted.uses(*op);
        let of = |role: Role| {
            uses.iter().filter(move |used| used.role == role).map(|used| Target::of(results.adapted, used))
        };
        let draws_over = || of(Role::Color).any(|target| read.contains(&target));
        pass.local_barrier = of(Role::Input).any(|target| fresh.contains(&target)) || draws_over();
        if pass.local_barrier {
            fresh.clear();
            read.clear();
        }
        let own = std::mem::take(&mut pass.blend);
        let at = |target: &Target| of(Role::Color).position(|drawn| drawn == *target);
        let blend = |target: &Target| at(target).and_then(|at| own.get(at));
        pass.blend = scope.color.iter().map(|target| blend(target).copied().unwrap_or_default()).collect();
        if !pass.write_masks.is_empty() {
            let masks = std::mem::take(&mut pass.write_masks);
            let mask = |target: &Target| at(target).and_then(|at| masks.get(at)).copied().unwrap_or_default();
            pass.write_masks = scope.color.iter().map(mask).collect();
        }
        // A scope has few attachments, but may have many passes.
        for (known, role) in [(&mut fresh, Role::Color), (&mut read, Role::Input)] {
            for target in of(role) {
                if !known.contains(&target) {
                    known.push(target);
                }
            }
        }
        passes.push(pass);
    }
    passes
}

/// Width and height, layers and samples of a scope's attachments.
pub(super) fn shape(results: &StageResults<'_>, scope: &Scope) -> ([u32; 2], u32, u32) {
    let resources = &results.adapted.resources;
    let first = scope.targets().next();
    let shape = first.and_then(|target| Some((resources[target.resource as usize].image()?, target)));
    shape.map_or(([1, 1], 1, 1), |(image, target)| {
        let [width, height, _] = results.adapted.extent_at(target.resource, image, target.range.base_mip);
        ([width, height], target.range.layers, image.samples)
    })
}

fn attachment(
    results: &StageResults<'_>,
    scope: &Scope,
    (kind, ops): (AttachmentKind, &AttachmentOps),
    resolve: Option<u32>,
) -> Attachment {
    let mut uses = scope.ops.iter().flat_map(|op| results.adapted.uses(*op));
    let used = uses.find(|used| used.role == ops.role && Target::of(results.adapted, used) == ops.target);
    Attachment {
        kind,
        image: ImageId(results.adapted.resources[ops.target.resource as usize].id),
        range: ops.target.range,
        layout: used.map_or(Layout::General, |used| used.layout),
        load: ops.load,
        store: ops.store,
        clear: ops.clear,
        resolve: resolve.and_then(|op| attachment_resolve(results, op)),
        because: reason(results, ops),
    }
}

fn attachment_resolve(results: &StageResults<'_>, number: u32) -> Option<AttachmentResolve> {
    let op = &results.adapted.ops[number as usize];
    let OpKind::Resolve { mode, .. } = op.kind else { return None };
    let target = results.adapted.uses(number).get(1)?;
    let resource = &results.adapted.resources[target.resource as usize];
    let layout = match resource.image()?.format.is_depth() {
        true => Layout::DepthStencilAttachmentOptimal,
        false => Layout::ColorAttachmentOptimal,
    };
    Some(AttachmentResolve {
        image: ImageId(resource.id),
        range: resource.all(),
        layout,
        mode,
        cause: cause(results, op),
    })
}

/// Why the pass that uses a loaded attachment first may leave texels of it as they were, if it would set them all otherwise.
fn untouched(results: &StageResults<'_>, ops: &AttachmentOps) -> Option<Arc<str>> {
    let OpKind::Draw(number) = results.adapted.ops.get(ops.first as usize)?.kind else { return None };
    let frame = results.frame;
    let pass = &frame.passes[number as usize];
    let uses = results.adapted.uses(ops.first);
    let used = uses.iter().find(|used| used.role == ops.role && Target::of(results.adapted, used) == ops.target)?;
    let why = match ops.role.attachment()? {
        AttachmentKind::Color => {
            let target = pass.color.get(used.entry as usize)?;
            pass.untouched_color(target, &frame.images[target.image.0 as usize])
        }
        kind @ (AttachmentKind::Depth | AttachmentKind::Stencil) => {
            let target = pass.depth.as_ref()?;
            pass.untouched_plane(target, kind.plane(), &frame.images[target.image.0 as usize])
        }
    };
    why.cloned()
}

/// Why an attachment has these operations.
fn reason(results: &StageResults<'_>, ops: &AttachmentOps) -> Reason {
    let name = |op: u32| op_name(results.frame, results.adapted, op).cloned();
    Reason::LoadStore {
        load: ops.load,
        first: if ops.first == u32::MAX { None } else { name(ops.first) },
        untouched: if ops.load == LoadOp::Load { untouched(results, ops) } else { None },
        store: ops.store,
        next: match ops.next {
            LaterUse::Op(op) => name(op).map_or(NextUse::Transfer, NextUse::Pass),
            LaterUse::After => NextUse::AfterFrame,
            LaterUse::Replaced => NextUse::Replaced,
            LaterUse::Nobody => NextUse::Never,
        },
    }
}
