//! The work of steps: what attachments load and store, resolves, layouts, barriers within scopes.

use super::Edit;
use super::barriers::others;
use crate::mutation::Kind;
use framewright_graph::frame::Cadence;
use framewright_graph::plan::{
    Access, Attachment, Cause, ImageId, Pass, Placement, Plan, Queue, Role, Side, Step, StepId, Transfer, Work,
};
use framewright_graph::vulkan::{Layout, LoadOp, StoreOp};

/// Everything about the work of a step.
pub(super) fn of_step(plan: &Plan, number: usize, step: &Step, edits: &mut Vec<Edit>) {
    if let Work::Render(scope) = &step.work {
        (0..scope.attachments.len()).for_each(|attachment| operations(plan, number, attachment, edits));
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
        standalone_resolve(plan, number, edits);
    }
    layouts(plan, number, step, edits);
}

/// Every image of a step's work in another layout, wherever the step names that image.
fn layouts(plan: &Plan, number: usize, step: &Step, edits: &mut Vec<Edit>) {
    let mut named: Vec<(ImageId, Layout)> = Vec::new();
    let mut work = step.work.clone();
    each_layout(&mut work, &mut |image, layout| {
        if !named.contains(&(image, *layout)) {
            named.push((image, *layout));
        }
    });
    for (image, layout) in named {
        let others = others(plan.image(image).format.aspects());
        edits.extend(others.into_iter().filter(|other| *other != layout).map(|other| {
            let name = &plan.image(image).name;
            let change = format!("{layout:?} → {other:?} of `{name}` in step {number}");
            Edit::new(Kind::UsedInOtherLayout, change, move |plan| {
                each_layout(&mut plan.steps[number].work, &mut |named, own| {
                    if (named, *own) == (image, layout) {
                        *own = other;
                    }
                });
            })
        }));
    }
}

fn each_layout(work: &mut Work, visit: &mut dyn FnMut(ImageId, &mut Layout)) {
    let pass_layouts = |pass: &mut Pass, visit: &mut dyn FnMut(ImageId, &mut Layout)| {
        pass.accesses.iter_mut().for_each(|Access { image, layout, .. }| visit(*image, layout));
    };
    match work {
        Work::Render(scope) => {
            for attachment in &mut scope.attachments {
                visit(attachment.image, &mut attachment.layout);
                attachment.resolve.iter_mut().for_each(|resolve| visit(resolve.image, &mut resolve.layout));
            }
            scope.passes.iter_mut().for_each(|pass| pass_layouts(pass, visit));
        }
        Work::Dispatch(pass) | Work::Custom(pass) => pass_layouts(pass, visit),
        Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
            [&mut transfer.source, &mut transfer.target].into_iter().for_each(|side| side_layout(side, visit));
        }
        Work::Fill(fill) => side_layout(&mut fill.target, visit),
        Work::Export => {}
    }
}

fn side_layout(side: &mut Side, visit: &mut dyn FnMut(ImageId, &mut Layout)) {
    if let Side::Image { image, layout, .. } = side {
        visit(*image, layout);
    }
}

fn attachment_of(plan: &mut Plan, number: usize, attachment: usize) -> Option<&mut Attachment> {
    let Work::Render(scope) = &mut plan.steps.get_mut(number)?.work else { return None };
    scope.attachments.get_mut(attachment)
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
            Work::Render(scope) => scope.color().len() + 1,
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
            run: Cadence::Always,
            waits: std::mem::take(&mut step.waits),
            memory_barriers: std::mem::take(&mut step.memory_barriers),
            image_barriers: std::mem::take(&mut step.image_barriers),
            work: Work::Resolve(transfer.clone()),
            releases: Vec::new(),
            outside: Vec::new(),
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
        for barrier in barriers {
            barrier.after.iter_mut().for_each(renumber);
            barrier.needed_by.iter_mut().for_each(renumber);
        }
        for hazard in buffers {
            hazard.after.iter_mut().for_each(renumber);
            hazard.needed_by.iter_mut().for_each(renumber);
        }
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
        Work::Render(scope) => scope.attachments.iter().any(|attachment| attachment.image == image),
        _ => false,
    };
    if let Some(step) = plan.steps[..number].iter().rposition(draws) {
        edits.push(Edit::new(Kind::ResolveMoved, format!("step {number} before step {step}"), move |plan| {
            let moved = std::mem::replace(&mut plan.steps[number].work, Work::Export);
            let before = Step {
                queue: Queue::Graphics,
                run: Cadence::Always,
                waits: Vec::new(),
                memory_barriers: Vec::new(),
                image_barriers: Vec::new(),
                work: moved,
                releases: Vec::new(),
                outside: Vec::new(),
            };
            insert(plan, step, before);
        }));
    }
}
