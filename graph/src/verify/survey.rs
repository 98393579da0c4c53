//! What the steps make of each image, before they are walked: first and last use, ranges, uses.

use super::touches::{self, Touch};
use super::violation::{Rule, StepName};
use super::{Finding, Findings};
use crate::plan::{Image, ImageId, Plan, Role, Step, StepId, Subresources, Work};
use crate::vocabulary::Usage;

/// What the steps make of each image.
pub(super) struct Survey {
    /// For each image: the first and the last step that touch it.
    pub(super) touched: Vec<Option<[u32; 2]>>,
    /// Every range that is less than its whole image.
    pub(super) ranges: Vec<(ImageId, Subresources)>,
}

/// Looks through the steps of `plan`; reports uses and lifetimes that the Plan doesn't state.
pub(super) fn survey(plan: &Plan, found: &mut Findings) -> Survey {
    let mut survey = Survey { touched: vec![None; plan.images.len()], ranges: Vec::new() };
    let mut touches = Vec::new();
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        for barrier in &step.image_barriers {
            survey.touch(plan, found, id, barrier.image, barrier.range);
        }
        touches::list(step, &mut touches);
        for touch in &touches {
            survey.touch(plan, found, id, touch.image, touch.range);
            check_usage(plan, found, id, step, touch);
        }
    }
    survey
}

impl Survey {
    fn touch(&mut self, plan: &Plan, found: &mut Findings, id: StepId, image: ImageId, range: Subresources) {
        let described = plan.image(image);
        if range != Subresources::all(described.format, described.mips, described.layers) {
            self.ranges.push((image, range));
        }
        let touched = &mut self.touched[image.0 as usize];
        let first = touched.map_or(id.0, |[first, _]| first);
        if touched.replace([first, id.0]) != Some([first, id.0]) {
            check_lifetime(found, id, described, range);
        }
    }
}

fn check_lifetime(found: &mut Findings, id: StepId, image: &Image, range: Subresources) {
    if let Role::Transient(placement) = &image.role
        && !(placement.lifetime[0]..=placement.lifetime[1]).contains(&id)
    {
        let nearest = placement.lifetime[usize::from(id > placement.lifetime[1])];
        found.push(Finding {
            rule: Rule::Lifetime { stated: placement.lifetime },
            step: id,
            other: Some(StepName::new(found.plan, nearest, false)),
            image: image.id,
            range: Some(range),
            bytes: Some([placement.offset, placement.offset.saturating_add(placement.bytes)]),
        });
    }
}

fn check_usage(plan: &Plan, found: &mut Findings, id: StepId, step: &Step, touch: &Touch) {
    let image = plan.image(touch.image);
    let missing = usage(step, touch, image).difference(image.usage);
    if !missing.is_empty() {
        let what = format!("is used as {}, which its usage leaves out", crate::plan::names::vulkan(&missing));
        found.structure(Some(id), Some(touch.image), what);
    }
}

/// What an image must be made for to be touched so.
fn usage(step: &Step, touch: &Touch, image: &Image) -> Usage {
    match (&step.work, touch.attachment) {
        (Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Fill(_), _) if touch.pairs.writes().is_empty() => {
            Usage::TRANSFER_SRC
        }
        (Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Fill(_), _) => Usage::TRANSFER_DST,
        (_, true) if image.format.is_depth() => Usage::DEPTH_STENCIL_ATTACHMENT,
        (_, true) => Usage::COLOR_ATTACHMENT,
        (_, false) if touch.pairs.is_sampling() => Usage::SAMPLED,
        (_, false) => Usage::STORAGE,
    }
}
