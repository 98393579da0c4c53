//! The GPU time of each part of a frame.

use crate::quantiles::median;
use framewright_graph::dataflow::NodeKind;
use framewright_graph::plan::{ImageId, Plan, RenderScope, Resource};
use framewright_vulkan::{FrameReport, StepReport};
use serde::Serialize;

/// A pass, or work that the compiler inserted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The Plan's step that it belongs to.
    pub step: usize,
    /// The kind of work; a resolve at the end of a rendering scope is one, too.
    pub kind: NodeKind,
    /// The pass's name; of inserted work its source and target.
    pub name: String,
    /// The word for inserted work.
    #[serde(skip)]
    pub inserted: Option<&'static str>,
    /// Draw calls.
    pub draws: u32,
    /// Objects that were left out because nothing of them can be seen.
    pub culled: u32,
    /// Median of its GPU times over all frames. A resolve at the end of a rendering scope takes what its passes leave of
    /// the scope's time, stores included.
    pub gpu_milliseconds: f64,
}

/// Draw counts of the last frame, and medians of the times of all. The frames are of this Plan: steps and passes that reports lack have
/// no time.
#[must_use]
pub fn rows(plan: &Plan, frames: &[FrameReport]) -> Vec<Row> {
    let Some(last) = frames.last() else { return Vec::new() };
    let mut rows = Vec::new();
    for (step, planned) in plan.steps.iter().enumerate() {
        let over = |time: &dyn Fn(&StepReport) -> Option<f64>| {
            let times = frames.iter().filter_map(|frame| time(frame.steps.get(step)?));
            median(times.collect()).unwrap_or_default()
        };
        let gpu_milliseconds = over(&|step| Some(step.milliseconds));
        let pass = |kind, name: &str| Row {
            step,
            kind,
            name: name.to_owned(),
            inserted: None,
            draws: 0,
            culled: 0,
            gpu_milliseconds,
        };
        let work = &planned.work;
        match work.scope() {
            Some(scope) => {
                for (number, drawn) in last.steps.get(step).into_iter().flat_map(|step| &step.passes).enumerate() {
                    let gpu_milliseconds = over(&|step| Some(step.passes.get(number)?.milliseconds));
                    let (draws, culled) = (drawn.draws, drawn.culled);
                    rows.push(Row { draws, culled, gpu_milliseconds, ..pass(NodeKind::Draw, &drawn.name) });
                }
                if let Some(resolves) = resolves(plan, scope) {
                    let rest = over(&|step| {
                        Some(step.milliseconds - step.passes.iter().map(|pass| pass.milliseconds).sum::<f64>())
                    });
                    let (inserted, gpu_milliseconds) = (Some("resolve"), rest.max(0.0));
                    rows.push(Row { inserted, gpu_milliseconds, ..pass(NodeKind::Resolve, &resolves) });
                }
            }
            None => rows.extend(NodeKind::of(work).map(|kind| match work.name() {
                Some(name) => pass(kind, name),
                None => {
                    let sides: Vec<&str> = work.sides().map(|side| plan.resource_name(side.resource())).collect();
                    Row { inserted: Some(work.word()), ..pass(kind, &sides.join(" → ")) }
                }
            })),
        }
    }
    rows
}

/// The resolves that a rendering scope carries, in words; `None` if there are none.
fn resolves(plan: &Plan, scope: &RenderScope) -> Option<String> {
    let image = |image: ImageId| plan.resource_name(Resource::Image(image));
    let resolves: Vec<String> = scope
        .attachments
        .iter()
        .filter_map(|it| Some(format!("{} → {}", image(it.image), image(it.resolve.as_ref()?.image))))
        .collect();
    (!resolves.is_empty()).then(|| resolves.join(", "))
}
