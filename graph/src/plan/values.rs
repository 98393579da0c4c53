//! Plans that differ in values alone: the memory and the shaders of one serve for the other.

use super::{Attachment, Buffer, Cause, Image, ImageId, Pass, Plan, Reason, Side, Step, Totals, View, Work};
use crate::frame::{Groups, ParamValue, allocated_extent};
use crate::vulkan::FillValue;

impl Plan {
    /// The Plan without values and without explanations. If it is equal for two Plans, each can be executed with the memory, images,
    /// buffers and shaders of the other. This is the one rule of what a mere value is for
    /// an executor. What is compiled anew is a rule of the compiler: `compile/incremental/difference.rs`.
    ///
    /// Values are settings, parameters, clear and fill values, counts of workgroups, shifts of views, and the parts of images that
    /// are in use.
    #[must_use]
    pub fn without_values(&self) -> Plan {
        let mut plan = self.clone();
        (plan.settings, plan.changes, plan.notes) = Default::default();
        plan.decided = [].into();
        plan.totals = Totals::default();
        plan.views.iter_mut().for_each(forget_view);
        plan.images.iter_mut().for_each(forget_image);
        plan.buffers.iter_mut().for_each(forget_buffer);
        let Plan { images, steps, .. } = &mut plan;
        steps.iter_mut().for_each(|step| forget_step(step, images));
        plan
    }

    /// The first difference of `other` from this Plan beside values, in words; `None`: an executor of this Plan can go on with
    /// the other one, with the memory, images, buffers and shaders that it has, see [`Plan::without_values`].
    #[must_use]
    pub fn differs_beyond_values(&self, other: &Plan) -> Option<String> {
        let counts = [self.steps.len(), other.steps.len()];
        let has_step = |(one, another)| same(one, another, |step| forget_step(step, &self.images));
        match () {
            () if self.device != other.device => Some("it is for another device".to_owned()),
            () if self.extent != other.extent => Some("its output has another size".to_owned()),
            () if self.stereo != other.stereo => Some("it is drawn for two eyes in another way".to_owned()),
            () if !all_same(&self.views, &other.views, forget_view) => Some("its views are others".to_owned()),
            () if !all_same(&self.images, &other.images, forget_image) => Some("its images are others".to_owned()),
            () if !all_same(&self.buffers, &other.buffers, forget_buffer) => Some("its buffers are others".to_owned()),
            () if self.heaps != other.heaps => Some("its memory is cut in another way".to_owned()),
            () if counts[0] != counts[1] => Some(format!("it has {} steps, not {}", counts[1], counts[0])),
            () => match self.steps.iter().zip(&other.steps).position(|pair| !has_step(pair)) {
                Some(step) => Some(format!("its step {step} does something else")),
                None => (self.outputs != other.outputs).then(|| "other outputs leave it".to_owned()),
            },
        }
    }
}

/// Whether two parts of Plans are the same once `forget` took their values out. Most are equal with them, so nothing is copied.
fn same<T: Clone + PartialEq>(one: &T, another: &T, forget: impl Fn(&mut T)) -> bool {
    one == another || {
        let [mut one, mut another] = [one.clone(), another.clone()];
        forget(&mut one);
        forget(&mut another);
        one == another
    }
}

fn all_same<T: Clone + PartialEq>(one: &[T], another: &[T], forget: impl Fn(&mut T)) -> bool {
    one.len() == another.len() && one.iter().zip(another).all(|(one, another)| same(one, another, &forget))
}

fn forget_view(view: &mut View) {
    view.jitter = None;
}

fn forget_image(image: &mut Image) {
    image.cause = Cause::Written(None);
    image.extent = allocated_extent(image.extent, image.allocated);
}

fn forget_buffer(buffer: &mut Buffer) {
    buffer.cause = Cause::Written(None);
}

/// Takes its values out of a step of a Plan with these images.
fn forget_step(step: &mut Step, images: &[Image]) {
    let changes = |image: ImageId| images.get(image.0 as usize).is_some_and(|image| image.allocated.is_some());
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
