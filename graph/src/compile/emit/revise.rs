//! Brings a Plan up to date where the structure is the same: new values, or new sizes too.

use super::barriers::StepBarriers;
use super::stage_results::{StageResults, frame_work};
use super::values::{settings, views, with_bytes};
use super::{attachments, notes, passes};
use crate::compile::model::{Kind, OpKind};
use crate::compile::scope::Step as Grouped;
use crate::frame::Work as FrameWork;
use crate::plan::{Param, Pass, Plan, Role, Totals, Work};
use std::sync::Arc;

/// Brings clear values, parameters, counts of workgroups and settings up to date.
pub(in crate::compile) fn values(results: &StageResults<'_>, plan: &mut Plan) {
    plan.settings = settings(results);
    plan.decided = Arc::clone(&results.frame.decided);
    plan.views = views(results);
    for ((step, grouped), number) in plan.steps.iter_mut().zip(&results.scoped.steps).zip(0_u32..) {
        match (&mut step.work, grouped) {
            (Work::Render(planned), Grouped::Scope(scope)) => {
                for (attachment, ops) in planned.attachments_mut().zip(results.load_store.of(number)) {
                    attachment.clear = ops.clear;
                }
                for (pass, op) in planned.passes.iter_mut().zip(&scope.ops) {
                    pass_values(results, *op, pass);
                }
            }
            (Work::Dispatch(pass) | Work::Custom(pass), Grouped::Single(op)) => pass_values(results, *op, pass),
            (Work::Fill(fill), Grouped::Single(op)) => {
                let work = frame_work(results, &results.adapted.ops[*op as usize]);
                fill.value = work.and_then(FrameWork::filled).unwrap_or(fill.value);
            }
            _ => {}
        }
    }
}

fn pass_values(results: &StageResults<'_>, op: u32, planned: &mut Pass) {
    let kind = &results.adapted.ops[op as usize].kind;
    let (OpKind::Draw(pass) | OpKind::Pass(pass) | OpKind::DepthOnly { pass, .. }) = kind else { return };
    let declared = &results.frame.passes[*pass as usize];
    if let Some(groups) = declared.work.groups() {
        planned.groups = Some(groups);
    }
    if let Some(stencil) = &mut planned.stencil {
        stencil.clear = declared.depth.as_ref().and_then(|depth| depth.stencil).and_then(|stencil| stencil.clear);
    }
    if !declared.params.is_empty() || !planned.params.is_empty() {
        planned.params.clear();
        let params = declared.params.iter();
        planned.params.extend(params.map(|(name, value)| Param { name: name.clone(), value: value.clone() }));
    }
}

/// Brings sizes and values up to date. Steps and barriers are the same.
pub(in crate::compile) fn sizes(results: &StageResults<'_>, plan: &mut Plan) {
    values(results, plan);
    plan.extent = results.frame.extent;
    let Plan { images, buffers, .. } = plan;
    for ((resource, placement), index) in results.adapted.resources.iter().zip(&results.placed.placements).zip(0..) {
        let role = match &resource.kind {
            Kind::Image(image) => {
                let planned = &mut images[resource.id as usize];
                (planned.extent, planned.allocated) = (image.extent, results.adapted.allocated(index));
                &mut planned.role
            }
            Kind::Buffer(buffer) => {
                let planned = &mut buffers[resource.id as usize];
                planned.bytes = buffer.bytes;
                &mut planned.role
            }
        };
        if let (Role::Transient(planned), Some(placement)) = (role, placement) {
            planned.clone_from(placement);
        }
    }
    for (resource, more_bytes) in &results.placed.chosen {
        let image = images.get_mut(results.adapted.resources[*resource as usize].id as usize);
        if let Some(chosen) = image.and_then(|image| image.chosen.as_mut()) {
            chosen.more_bytes = *more_bytes;
        }
    }
    plan.heaps.clone_from(&results.placed.heaps);
    for (step, grouped) in plan.steps.iter_mut().zip(&results.scoped.steps) {
        match (&mut step.work, grouped) {
            (Work::Render(planned), Grouped::Scope(scope)) => {
                (planned.extent, ..) = attachments::shape(results, scope);
                for (pass, op) in planned.passes.iter_mut().zip(&scope.ops) {
                    pass.merged = results.scoped.merged(results.frame, results.adapted, *op);
                }
            }
            (Work::Copy(transfer) | Work::Blit(transfer) | Work::Resolve(transfer), Grouped::Single(op)) => {
                [transfer.source, transfer.target] = passes::sides(results, *op);
            }
            (Work::Fill(fill), Grouped::Single(op)) => fill.target = passes::filled(results, *op),
            _ => {}
        }
    }
    notes::renew_sizes(results, &mut plan.notes);
    plan.totals = with_bytes(results, plan.totals);
}

/// Brings barriers up to date. Steps are the same, but memory is aliased in another way.
pub(in crate::compile) fn barriers(results: &StageResults<'_>, plan: &mut Plan) {
    let mut barriers = StepBarriers::new(results);
    for (step, number) in plan.steps.iter_mut().zip(0..) {
        (step.memory_barriers, step.image_barriers) = barriers.of(number);
    }
    plan.totals = Totals::count(&plan.steps);
}
