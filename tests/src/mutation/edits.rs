//! The mistakes that a Plan offers room for.

use super::Kind;
use framewright_graph::plan::{
    Attachment, Cause, ImageBarrier, Placement, Plan, Queue, Resource, Role, Side, Step, StepId, Transfer, Work,
};
use framewright_graph::vocabulary::{Aspects, Layout, LoadOp, StoreOp};

/// One mistake.
pub(super) struct Edit {
    pub(super) kind: Kind,
    pub(super) change: String,
    pub(super) apply: Box<dyn Fn(&mut Plan)>,
}

impl Edit {
    fn new(kind: Kind, change: String, apply: impl Fn(&mut Plan) + 'static) -> Edit {
        Edit { kind, change, apply: Box::new(apply) }
    }
}

/// All of them.
pub(super) fn all(plan: &Plan) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (number, step) in plan.steps.iter().enumerate() {
        memory_barriers(number, step, &mut edits);
        image_barriers(plan, number, step, &mut edits);
        waits(number, step, &mut edits);
        if let Work::Render(scope) = &step.work {
            let count = scope.color.len() + usize::from(scope.depth.is_some()) + usize::from(scope.stencil.is_some());
            (0..count).for_each(|attachment| operations(plan, number, attachment, &mut edits));
            let local = scope.passes.iter().enumerate().filter(|(_, pass)| pass.local_barrier);
            edits.extend(local.map(|(pass, _)| {
                Edit::new(Kind::LocalBarrierDropped, format!("of pass {pass} in step {number}"), move |plan| {
                    if let Work::Render(scope) = &mut plan.steps[number].work {
                        scope.passes[pass].local_barrier = false;
                    }
                })
            }));
        }
        if let Work::Resolve(_) = &step.work {
            standalone_resolve(plan, number, &mut edits);
        }
    }
    allocations(plan, &mut edits);
    edits
}

fn memory_barriers(number: usize, step: &Step, edits: &mut Vec<Edit>) {
    for (at, barrier) in step.memory_barriers.iter().enumerate() {
        let place = format!("memory barrier {at} of step {number}");
        edits.push(Edit::new(Kind::MemoryBarrierDropped, place.clone(), move |plan| {
            plan.steps[number].memory_barriers.remove(at);
        }));
        for (side, stages) in [barrier.src_stages, barrier.dst_stages].into_iter().enumerate() {
            edits.extend(stages.iter().map(|stage| {
                Edit::new(Kind::StageDropped, format!("{stage:?} of {place}, side {side}"), move |plan| {
                    let barrier = &mut plan.steps[number].memory_barriers[at];
                    *[&mut barrier.src_stages, &mut barrier.dst_stages][side] -= stage;
                })
            }));
        }
        for (side, accesses) in [barrier.src_accesses, barrier.dst_accesses].into_iter().enumerate() {
            edits.extend(accesses.iter().map(|access| {
                Edit::new(Kind::AccessDropped, format!("{access:?} of {place}, side {side}"), move |plan| {
                    let barrier = &mut plan.steps[number].memory_barriers[at];
                    *[&mut barrier.src_accesses, &mut barrier.dst_accesses][side] -= access;
                })
            }));
        }
    }
}

/// The barriers before a step, then the releases after it.
fn barrier_of(plan: &mut Plan, number: usize, at: usize) -> &mut ImageBarrier {
    let step = &mut plan.steps[number];
    let before = step.image_barriers.len();
    if at < before { &mut step.image_barriers[at] } else { &mut step.releases[at - before] }
}

fn image_barriers(plan: &Plan, number: usize, step: &Step, edits: &mut Vec<Edit>) {
    let before = step.image_barriers.len();
    for (at, barrier) in step.image_barriers.iter().chain(&step.releases).enumerate() {
        let name = &plan.image(barrier.image).name;
        let place = format!("barrier {at} of step {number} on `{name}`");
        let kind = if at < before { Kind::ImageBarrierDropped } else { Kind::ReleaseDropped };
        edits.push(Edit::new(kind, place.clone(), move |plan| {
            let step = &mut plan.steps[number];
            if at < before {
                step.image_barriers.remove(at);
            } else {
                step.releases.remove(at - before);
            }
        }));
        for (side, stages) in [barrier.src_stages, barrier.dst_stages].into_iter().enumerate() {
            edits.extend(stages.iter().map(|stage| {
                Edit::new(Kind::StageDropped, format!("{stage:?} of {place}, side {side}"), move |plan| {
                    let barrier = barrier_of(plan, number, at);
                    *[&mut barrier.src_stages, &mut barrier.dst_stages][side] -= stage;
                })
            }));
        }
        for (side, accesses) in [barrier.src_accesses, barrier.dst_accesses].into_iter().enumerate() {
            edits.extend(accesses.iter().map(|access| {
                Edit::new(Kind::AccessDropped, format!("{access:?} of {place}, side {side}"), move |plan| {
                    let barrier = barrier_of(plan, number, at);
                    *[&mut barrier.src_accesses, &mut barrier.dst_accesses][side] -= access;
                })
            }));
        }
        for (side, layout) in [barrier.old_layout, barrier.new_layout].into_iter().enumerate() {
            let others =
                others(plan.image(barrier.image).format.aspects()).into_iter().filter(|other| *other != layout);
            // Nothing may become UNDEFINED.
            let others = others.filter(|other| side == 0 || *other != Layout::Undefined);
            edits.extend(others.map(|other| {
                let change = format!("{layout:?} → {other:?} of {place}, side {side}");
                Edit::new(Kind::LayoutChanged, change, move |plan| {
                    let barrier = barrier_of(plan, number, at);
                    *[&mut barrier.old_layout, &mut barrier.new_layout][side] = other;
                })
            }));
        }
    }
}

/// Layouts that an image with these planes may be in.
fn others(aspects: Aspects) -> Vec<Layout> {
    let any = [
        Layout::Undefined,
        Layout::General,
        Layout::ShaderReadOnlyOptimal,
        Layout::TransferSrcOptimal,
        Layout::TransferDstOptimal,
    ];
    let own: &[Layout] = if aspects.contains(Aspects::COLOR) {
        &[Layout::ColorAttachmentOptimal, Layout::RenderingLocalReadKhr]
    } else {
        &[Layout::DepthStencilAttachmentOptimal, Layout::DepthStencilReadOnlyOptimal, Layout::DepthReadOnlyOptimal]
    };
    any.iter().chain(own).copied().collect()
}

fn waits(number: usize, step: &Step, edits: &mut Vec<Edit>) {
    for (at, wait) in step.waits.iter().enumerate() {
        let place = format!("wait {at} of step {number}");
        edits.push(Edit::new(Kind::WaitDropped, place.clone(), move |plan| {
            plan.steps[number].waits.remove(at);
        }));
        edits.extend(wait.stages.iter().map(|stage| {
            Edit::new(Kind::WaitWeakened, format!("{stage:?} of {place}"), move |plan| {
                plan.steps[number].waits[at].stages -= stage;
            })
        }));
    }
}

fn attachment_of(plan: &mut Plan, number: usize, attachment: usize) -> Option<&mut Attachment> {
    let Work::Render(scope) = &mut plan.steps.get_mut(number)?.work else { return None };
    scope.color.iter_mut().chain(&mut scope.depth).chain(&mut scope.stencil).nth(attachment)
}

fn operations(plan: &Plan, number: usize, at: usize, edits: &mut Vec<Edit>) {
    let mut plan = plan.clone();
    let Some(attachment) = attachment_of(&mut plan, number, at).map(|attachment| attachment.clone()) else { return };
    let name = plan.image(attachment.image).name.clone();
    let place = format!("`{name}` in step {number}");
    let mut edit = |kind, change: &str, of: fn(&mut Attachment)| {
        edits.push(Edit::new(kind, format!("{change} of {place}"), move |plan| {
            if let Some(attachment) = attachment_of(plan, number, at) {
                of(attachment);
            }
        }));
    };
    if attachment.load != LoadOp::DontCare {
        edit(Kind::LoadLost, "load", |attachment| {
            attachment.load = LoadOp::DontCare;
            attachment.clear = None;
        });
    }
    if attachment.store == StoreOp::Store {
        edit(Kind::StoreLost, "store", |attachment| attachment.store = StoreOp::DontCare);
        edit(Kind::StoreLost, "store (none)", |attachment| attachment.store = StoreOp::None);
    }
    let Some(resolve) = attachment.resolve.clone() else { return };
    edit(Kind::ResolveDropped, "resolve", |attachment| attachment.resolve = None);
    let earlier = (0..number).rev().find_map(|step| {
        let count = match &plan.steps[step].work {
            Work::Render(scope) => scope.color.len() + 1,
            _ => 0,
        };
        (0..count).find_map(|other| {
            let found = attachment_of(&mut plan, step, other)?;
            (found.image == attachment.image && found.resolve.is_none()).then_some((step, other))
        })
    });
    if let Some((step, other)) = earlier {
        edits.push(Edit::new(Kind::ResolveMoved, format!("of {place} to step {step}"), move |plan| {
            let resolve = attachment_of(plan, number, at).and_then(|attachment| attachment.resolve.take());
            if let Some(earlier) = attachment_of(plan, step, other) {
                earlier.resolve = resolve;
            }
        }));
    }
    let extent = plan.image(attachment.image).extent;
    let side = |image, range, layout| Side::Image { image, range, extent, layout };
    let transfer = Transfer {
        name: None,
        cause: Cause::Written(None),
        source: side(attachment.image, attachment.range, attachment.layout),
        target: side(resolve.image, resolve.range, resolve.layout),
        filter: None,
    };
    edits.push(Edit::new(Kind::ResolveMoved, format!("of {place} to a step before"), move |plan| {
        if let Some(attachment) = attachment_of(plan, number, at) {
            attachment.resolve = None;
        }
        let step = &mut plan.steps[number];
        let before = Step {
            queue: Queue::Graphics,
            waits: std::mem::take(&mut step.waits),
            memory_barriers: std::mem::take(&mut step.memory_barriers),
            image_barriers: std::mem::take(&mut step.image_barriers),
            work: Work::Resolve(transfer.clone()),
            releases: Vec::new(),
        };
        insert(plan, number, before);
    }));
}

/// Puts a step before the step `at`; everything that names steps follows.
fn insert(plan: &mut Plan, at: usize, step: Step) {
    plan.steps.insert(at, step);
    let renumber = |step: &mut StepId| step.0 += u32::from(step.0 as usize >= at);
    let images = plan.images.iter_mut().map(|image| &mut image.role);
    for role in images.chain(plan.buffers.iter_mut().map(|buffer| &mut buffer.role)) {
        if let Role::Transient(Placement { lifetime: [first, last], .. }) = role {
            // Who begins with the old step begins with its barriers, which stand before the new one.
            first.0 += u32::from(first.0 as usize > at);
            renumber(last);
        }
    }
    for step in &mut plan.steps {
        step.waits.iter_mut().for_each(|wait| renumber(&mut wait.step));
        let barriers = step.image_barriers.iter_mut().chain(&mut step.releases);
        let buffers = step.memory_barriers.iter_mut().flat_map(|barrier| &mut barrier.buffers);
        barriers.filter_map(|barrier| barrier.after.as_mut()).for_each(renumber);
        buffers.filter_map(|hazard| hazard.after.as_mut()).for_each(renumber);
    }
}

fn standalone_resolve(plan: &Plan, number: usize, edits: &mut Vec<Edit>) {
    edits.push(Edit::new(Kind::ResolveDropped, format!("step {number}"), move |plan| {
        plan.steps[number].work = Work::Export;
    }));
    let Work::Resolve(Transfer { source: Side::Image { image, .. }, .. }) = plan.steps[number].work.clone() else {
        return;
    };
    let draws = |step: &Step| match &step.work {
        Work::Render(scope) => scope.color.iter().chain(&scope.depth).any(|attachment| attachment.image == image),
        _ => false,
    };
    if let Some(step) = plan.steps[..number].iter().rposition(draws) {
        edits.push(Edit::new(Kind::ResolveMoved, format!("step {number} before step {step}"), move |plan| {
            let moved = std::mem::replace(&mut plan.steps[number].work, Work::Export);
            let before = Step {
                queue: Queue::Graphics,
                waits: Vec::new(),
                memory_barriers: Vec::new(),
                image_barriers: Vec::new(),
                work: moved,
                releases: Vec::new(),
            };
            insert(plan, step, before);
        }));
    }
}

fn placement(plan: &Plan, resource: Resource) -> Option<&Placement> {
    let role = match resource {
        Resource::Image(image) => &plan.image(image).role,
        Resource::Buffer(buffer) => &plan.buffers[buffer.0 as usize].role,
    };
    if let Role::Transient(placement) = role { Some(placement) } else { None }
}

fn allocations(plan: &Plan, edits: &mut Vec<Edit>) {
    let images = plan.images.iter().map(|image| (Resource::Image(image.id), image.name.clone()));
    let buffers = plan.buffers.iter().map(|buffer| (Resource::Buffer(buffer.id), buffer.name.clone()));
    let all: Vec<_> = images.chain(buffers).collect();
    for (moved, name) in &all {
        for (neighbour, other) in &all {
            let (Some(own), Some(there)) = (placement(plan, *moved), placement(plan, *neighbour)) else { continue };
            let together = own.lifetime[0] <= there.lifetime[1] && there.lifetime[0] <= own.lifetime[1];
            if moved == neighbour || !together || own.heap != there.heap || own.offset == there.offset {
                continue;
            }
            let (moved, offset, heap, end) = (*moved, there.offset, own.heap as usize, there.offset + own.bytes);
            let change = format!("`{name}` onto `{other}`");
            edits.push(Edit::new(Kind::AllocationShifted, change, move |plan| {
                let role = match moved {
                    Resource::Image(image) => &mut plan.images[image.0 as usize].role,
                    Resource::Buffer(buffer) => &mut plan.buffers[buffer.0 as usize].role,
                };
                if let Role::Transient(placement) = role {
                    placement.offset = offset;
                }
                plan.heaps[heap].bytes = plan.heaps[heap].bytes.max(end);
            }));
        }
    }
}
