//! The nodes of a Plan's dataflow, and what each uses.

use super::{Node, NodeKind, Use, UseRole};
use crate::plan::{
    Access, Attachment, BindingKind, BufferAccess, Cause, ImageId, Pass, Plan, RenderScope, Resource, Side, StepId,
    Work,
};
use crate::vulkan::{AccessKind, Accesses, LoadOp, Subresources};

/// All nodes, in the order of execution.
pub(super) fn nodes(plan: &Plan) -> Vec<Node> {
    let mut nodes = Vec::with_capacity(plan.steps.len());
    for (step, work) in (0..).map(StepId).zip(plan.steps.iter().map(|step| &step.work)) {
        let Some(kind) = NodeKind::of(work) else { continue };
        match work.scope() {
            Some(scope) => of_scope(plan, step, scope, &mut nodes),
            None => {
                nodes.extend(work.passes().iter().map(|pass| of_pass(step, kind, pass, of_accesses(pass))));
                nodes.extend(of_transfer(plan, step, kind, work));
            }
        }
    }
    nodes
}

fn node(step: StepId, kind: NodeKind, name: String, cause: &Cause, uses: Vec<Use>) -> Node {
    Node { step, kind, name, because: cause.because().map(str::to_owned), at: cause.at().cloned(), uses }
}

fn of_pass(step: StepId, kind: NodeKind, pass: &Pass, uses: Vec<Use>) -> Node {
    node(step, kind, pass.name.to_string(), &pass.cause, uses)
}

fn of_transfer(plan: &Plan, step: StepId, kind: NodeKind, work: &Work) -> Option<Node> {
    let sides: Vec<&Side> = work.sides().collect();
    let (target, source) = sides.split_last()?;
    let unnamed = || format!("{} {}", work.word(), plan.resource_name(sides[0].resource()));
    let name = work.name().map_or_else(unnamed, ToString::to_string);
    let uses = source.iter().map(|side| of_side(side, UseRole::Source)).chain([of_side(target, UseRole::Target)]);
    Some(node(step, kind, name, work.cause()?, uses.collect()))
}

fn of_scope(plan: &Plan, step: StepId, scope: &RenderScope, nodes: &mut Vec<Node>) {
    // An attachment whose load op drops what was there has contents from its first use on.
    let mut fresh: Vec<(ImageId, Subresources)> = scope
        .attachments
        .iter()
        .filter(|attachment| attachment.load != LoadOp::Load)
        .map(|attachment| (attachment.image, attachment.range))
        .collect();
    for pass in &scope.passes {
        let mut uses = of_accesses(pass);
        for used in &mut uses {
            let (Resource::Image(image), Some(range)) = (used.resource, used.range) else { continue };
            if matches!(used.role, UseRole::Color | UseRole::Depth) {
                let before = fresh.len();
                fresh.retain(|(other, part)| *other != image || !part.overlaps(range));
                used.reads = fresh.len() == before;
            }
        }
        nodes.push(of_pass(step, NodeKind::Draw, pass, uses));
    }
    for Attachment { image, range, resolve, .. } in &scope.attachments {
        let Some(resolve) = resolve else { continue };
        let part = |image, range, role| Use {
            resource: Resource::Image(image),
            range: Some(range),
            role,
            reads: role == UseRole::Source,
            writes: role == UseRole::Target,
        };
        let name = format!("resolve {}", plan.resource_name(Resource::Image(*image)));
        let uses = vec![part(*image, *range, UseRole::Source), part(resolve.image, resolve.range, UseRole::Target)];
        nodes.push(node(step, NodeKind::FoldedResolve, name, &resolve.cause, uses));
    }
}

fn of_side(side: &Side, role: UseRole) -> Use {
    let reads = role == UseRole::Source;
    Use { resource: side.resource(), range: side.range(), role, reads, writes: !reads }
}

fn of_accesses(pass: &Pass) -> Vec<Use> {
    let images = pass.accesses.iter().map(of_access);
    images.chain(pass.buffers.iter().map(of_buffer)).collect()
}

fn of_access(access: &Access) -> Use {
    const COLOR: Accesses = AccessKind::ColorAttachment.accesses(true, true);
    const DEPTH: Accesses = AccessKind::DepthAttachment.accesses(true, true);
    let role = match access.binding.as_ref().map(|binding| binding.kind) {
        Some(BindingKind::Sampled(_)) => UseRole::Sampled,
        Some(BindingKind::Storage) => UseRole::StorageImage,
        Some(BindingKind::InputAttachment) => UseRole::InputAttachment,
        None if access.accesses.intersects(COLOR) => UseRole::Color,
        None if access.accesses.intersects(DEPTH) => UseRole::Depth,
        None => UseRole::Other,
    };
    let writes = access.accesses.intersects(Accesses::WRITES);
    let reads = !(access.accesses - Accesses::WRITES).is_empty();
    Use { resource: Resource::Image(access.image), range: Some(access.range), role, reads, writes }
}

fn of_buffer(access: &BufferAccess) -> Use {
    let writes = access.accesses.intersects(Accesses::WRITES);
    let reads = !(access.accesses - Accesses::WRITES).is_empty();
    Use { resource: Resource::Buffer(access.buffer), range: None, role: UseRole::Buffer, reads, writes }
}
