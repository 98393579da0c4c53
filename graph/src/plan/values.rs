//! Plans that differ in values alone: the memory and the shaders of one serve for the other.

use super::{Attachment, Cause, Fill, Pass, Plan, Reason, RenderScope, Side, Transfer, Work};
use crate::frame::{Groups, ParamValue};
use crate::vulkan::FillValue;

impl Plan {
    /// The first difference of `other` from this Plan beside values, in words; `None`: an executor of this Plan can go on with
    /// the other one, with the memory, images, buffers and shaders that it has.
    ///
    /// Values are settings, parameters, clear and fill values, counts of workgroups, how views are shifted, which part of an
    /// image is in use where that may change, and all that explains.
    #[must_use]
    pub fn differs_beyond_values(&self, other: &Plan) -> Option<String> {
        let [one, another] = [self, other].map(without_values);
        let step = one.steps.iter().zip(&another.steps).position(|(one, another)| one != another);
        let counts = [one.steps.len(), another.steps.len()];
        match () {
            () if one.device != another.device => Some("it is for another device".to_owned()),
            () if one.extent != another.extent => Some("its output has another size".to_owned()),
            () if one.stereo != another.stereo => Some("it is drawn for two eyes in another way".to_owned()),
            () if one.views != another.views => Some("its views are others".to_owned()),
            () if one.images != another.images => Some("its images are others".to_owned()),
            () if one.buffers != another.buffers => Some("its buffers are others".to_owned()),
            () if one.heaps != another.heaps => Some("its memory is cut in another way".to_owned()),
            () if counts[0] != counts[1] => Some(format!("it has {} steps, not {}", counts[1], counts[0])),
            () => match step {
                Some(step) => Some(format!("its step {step} does something else")),
                None => (one.outputs != another.outputs).then(|| "other outputs leave it".to_owned()),
            },
        }
    }
}

/// A Plan without the values in it.
fn without_values(plan: &Plan) -> Plan {
    let mut plan = plan.clone();
    plan.views.iter_mut().for_each(|view| view.jitter = None);
    for image in &mut plan.images {
        image.cause = Cause::Written(None);
        image.extent = crate::frame::allocated_extent(image.extent, image.allocated);
    }
    plan.buffers.iter_mut().for_each(|buffer| buffer.cause = Cause::Written(None));
    let Plan { images, steps, .. } = &mut plan;
    let changes =
        |side: &Side| matches!(side, Side::Image { image, .. } if images[image.0 as usize].allocated.is_some());
    for step in steps {
        match &mut step.work {
            Work::Render(scope) => {
                let first = scope.color.iter().chain(&scope.depth).chain(&scope.stencil).next();
                let changing = first.is_some_and(|first| images[first.image.0 as usize].allocated.is_some());
                of_scope(scope, changing);
            }
            Work::Dispatch(pass) | Work::Custom(pass) => of_pass(pass),
            Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => of_transfer(transfer, changes),
            Work::Fill(fill) => of_fill(fill, changes),
            Work::Export => {}
        }
    }
    plan
}

fn of_scope(scope: &mut RenderScope, changing: bool) {
    if changing {
        scope.extent = [0, 0];
    }
    let attachments = scope.color.iter_mut().chain(&mut scope.depth).chain(&mut scope.stencil);
    for Attachment { clear, resolve, because, .. } in attachments {
        *clear = clear.map(|_| [0.0; 4]);
        *because = Reason::from("");
        if let Some(resolve) = resolve {
            resolve.cause = Cause::Written(None);
        }
    }
    scope.passes.iter_mut().for_each(of_pass);
}

fn of_pass(pass: &mut Pass) {
    pass.cause = Cause::Written(None);
    pass.merged = pass.merged.take().map(|_| Box::new(Reason::from("")));
    pass.params.iter_mut().for_each(|param| param.value = ParamValue::Bool(false));
    pass.groups = pass.groups.map(|groups| match groups {
        Groups::Count(_) => Groups::Count([0; 3]),
        Groups::Invocations(_) => Groups::Invocations([0; 3]),
        Groups::Indirect { .. } => groups,
    });
}

fn of_transfer(transfer: &mut Transfer, changes: impl Fn(&Side) -> bool) {
    transfer.cause = Cause::Written(None);
    for side in [&mut transfer.source, &mut transfer.target] {
        forget_extent(side, &changes);
    }
}

fn of_fill(fill: &mut Fill, changes: impl Fn(&Side) -> bool) {
    fill.cause = Cause::Written(None);
    fill.value = FillValue::Bits([0; 4]);
    forget_extent(&mut fill.target, changes);
}

fn forget_extent(side: &mut Side, changes: impl Fn(&Side) -> bool) {
    if changes(side)
        && let Side::Image { extent, .. } = side
    {
        *extent = [0; 3];
    }
}
