//! Plans that differ in values alone: the memory and the shaders of one serve for the other.

use super::{Attachment, Cause, ImageId, Pass, Plan, Reason, Side, Totals, Work};
use crate::frame::{Groups, ParamValue};
use crate::vulkan::FillValue;

impl Plan {
    /// The Plan without values and without explanations. If it is equal for two Plans, each can be executed with the memory, images,
    /// buffers and shaders of the other. This is the one rule of what a mere value is for
    /// an executor. What is compiled anew is a rule of the compiler.
    ///
    /// Values are settings, parameters, clear and fill values, counts of workgroups, shifts of views, and the parts of images that
    /// are in use.
    #[must_use]
    pub fn without_values(&self) -> Plan {
        let mut plan = self.clone();
        (plan.settings, plan.changes, plan.notes) = Default::default();
        plan.decided = [].into();
        plan.totals = Totals::default();
        plan.views.iter_mut().for_each(|view| view.jitter = None);
        for image in &mut plan.images {
            image.cause = Cause::Written(None);
            image.extent = crate::frame::allocated_extent(image.extent, image.allocated);
        }
        plan.buffers.iter_mut().for_each(|buffer| buffer.cause = Cause::Written(None));
        let Plan { images, steps, .. } = &mut plan;
        let changes = |image: ImageId| images[image.0 as usize].allocated.is_some();
        for step in steps {
            step.work.passes_mut().iter_mut().for_each(forget_pass);
            match &mut step.work {
                Work::Render(scope) => {
                    if scope.attachments.first().is_some_and(|first| changes(first.image)) {
                        scope.extent = [0, 0];
                    }
                    scope.attachments.iter_mut().for_each(forget_attachment);
                }
                Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
                    transfer.cause = Cause::Written(None);
                }
                Work::Fill(fill) => {
                    fill.cause = Cause::Written(None);
                    fill.value = FillValue::Bits([0; 4]);
                }
                Work::Dispatch(_) | Work::Custom(_) | Work::Export => {}
            }
            for side in step.work.sides_mut() {
                match side {
                    Side::Image { image, extent, .. } if changes(*image) => *extent = [0; 3],
                    Side::Image { .. } | Side::Buffer { .. } => {}
                }
            }
        }
        plan
    }

    /// The first difference of `other` from this Plan beside values, in words; `None`: an executor of this Plan can go on with
    /// the other one, with the memory, images, buffers and shaders that it has, see [`Plan::without_values`].
    #[must_use]
    pub fn differs_beyond_values(&self, other: &Plan) -> Option<String> {
        let [one, another] = [self, other].map(Plan::without_values);
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

/// Takes its values out of a pass.
fn forget_pass(pass: &mut Pass) {
    pass.cause = Cause::Written(None);
    pass.merged = pass.merged.take().map(|_| Box::new(Reason::from("")));
    pass.params.iter_mut().for_each(|param| param.value = ParamValue::Bool(false));
    if let Some(stencil) = &mut pass.stencil {
        stencil.clear = stencil.clear.map(|_| 0);
    }
    pass.groups = pass.groups.map(|groups| match groups {
        Groups::Count(_) => Groups::Count([0; 3]),
        Groups::Invocations(_) => Groups::Invocations([0; 3]),
        Groups::Indirect { .. } => groups,
    });
}

fn forget_attachment(attachment: &mut Attachment) {
    attachment.clear = attachment.clear.map(|_| [0.0; 4]);
    attachment.because = Reason::from("");
    if let Some(resolve) = &mut attachment.resolve {
        resolve.cause = Cause::Written(None);
    }
}
