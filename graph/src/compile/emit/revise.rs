//! Brings a Plan up to date where frames differ in values alone.

use super::header::{settings, views};
use super::stage_results::frame_work;
use crate::compile::model::OpKind;
use crate::compile::stages::Decisions;
use crate::frame::{Frame, Work as FrameWork};
use crate::plan::{Param, Pass, Plan, Work};
use std::sync::Arc;

/// Brings clear values, parameters, counts of workgroups and settings up to date.
pub(in crate::compile) fn put_in_values(frame: &Frame, decisions: &Decisions, plan: &mut Plan) {
    plan.settings = settings(frame);
    plan.decided = Arc::clone(&frame.decided);
    plan.views = views(frame);
    let Decisions { adapted, scoped, load_store, .. } = decisions;
    let kind = |op: u32| &adapted.ops[op as usize].kind;
    for ((step, grouped), number) in plan.steps.iter_mut().zip(&scoped.steps).zip(0_u32..) {
        match &mut step.work {
            Work::Render(scope) => {
                for (attachment, ops) in scope.attachments.iter_mut().zip(load_store.of(number)) {
                    attachment.clear = ops.clear;
                }
            }
            Work::Fill(fill) => {
                let op = grouped.ops().first().map(|op| &adapted.ops[*op as usize]);
                let work = op.and_then(|op| frame_work(frame, op));
                fill.value = work.and_then(FrameWork::filled).unwrap_or(fill.value);
            }
            Work::Dispatch(_) | Work::Custom(_) | Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Export => {}
        }
        for (pass, op) in step.work.passes_mut().iter_mut().zip(grouped.ops()) {
            pass_values(frame, kind(*op), pass);
        }
    }
}

fn pass_values(frame: &Frame, kind: &OpKind, planned: &mut Pass) {
    let (OpKind::Draw(pass) | OpKind::Pass(pass) | OpKind::DepthOnly { pass, .. }) = kind else { return };
    let declared = &frame.passes[*pass as usize];
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
