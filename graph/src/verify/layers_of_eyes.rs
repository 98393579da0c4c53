//! Whether each eye's layer was written before it is read, where compute passes write one layer at a time.
//!
//! Elsewhere an image that has a layer for each eye counts as one part. A pass that stores for one eye would so stand for both.

use super::findings::Findings;
use crate::frame::{Eye, EyeForm};
use crate::plan::{Access, ImageId, Plan, Role, Side, Step, StepId};
use crate::vulkan::{Accesses, Layout, LoadOp, Subresources};
use std::collections::BTreeMap;

/// Whether a pass stores into one eye's layer, or reads it as storage.
pub(super) fn stored(plan: &Plan, access: &Access) -> bool {
    let storage = Accesses::SHADER_STORAGE_READ | Accesses::SHADER_STORAGE_WRITE;
    let layered = plan.image(access.image).eyes == Some(EyeForm::Layers);
    layered && access.eye.is_some() && access.accesses.intersects(storage)
}

/// By image and mip level, whether the layer of each eye is defined. Images that nothing stores into by layer aren't among them.
struct Layers<'p> {
    plan: &'p Plan,
    defined: BTreeMap<(u32, u32), [bool; 2]>,
}

pub(super) fn check(plan: &Plan, found: &mut Findings<'_>) {
    let dispatches = plan.steps.iter().filter(|step| step.work.is_dispatch()).flat_map(|step| step.work.passes());
    let mut layers = Layers { plan, defined: BTreeMap::new() };
    for access in dispatches.flat_map(|pass| &pass.accesses).filter(|access| writes_layer(plan, access)) {
        let image = plan.image(access.image);
        let holds = match image.role {
            Role::Transient(_) => false,
            Role::Persistent { .. } | Role::External { .. } => true,
        };
        layers.defined.extend((0..image.mips).map(|mip| ((access.image.0, mip), [holds; 2])));
    }
    if layers.defined.is_empty() {
        return;
    }
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        layers.step(id, step, found);
    }
    // What the next frame, or somebody else, finds.
    let last = StepId(u32::try_from(plan.steps.len()).map_or(0, |steps| steps.saturating_sub(1)));
    for image in plan.images.iter().filter(|image| image.role.placement().is_none()) {
        layers.read(last, image.id, Subresources::all(image.format, image.mips, image.layers), None, found);
    }
}

fn writes_layer(plan: &Plan, access: &Access) -> bool {
    stored(plan, access) && access.accesses.intersects(Accesses::SHADER_STORAGE_WRITE)
}

impl Layers<'_> {
    fn step(&mut self, id: StepId, step: &Step, found: &mut Findings<'_>) {
        for barrier in step.image_barriers.iter().filter(|barrier| barrier.old_layout == Layout::Undefined) {
            self.set(barrier.image, barrier.range, None, false);
        }
        let shader_reads = Accesses::SHADER_SAMPLED_READ
            | Accesses::SHADER_STORAGE_READ
            | Accesses::SHADER_READ
            | Accesses::INPUT_ATTACHMENT_READ;
        let scope = step.work.scope();
        for attachment in scope.iter().flat_map(|scope| &scope.attachments) {
            if attachment.load == LoadOp::Load {
                self.read(id, attachment.image, attachment.range, None, found);
            }
            self.set(attachment.image, attachment.range, None, true);
            if let Some(resolve) = &attachment.resolve {
                self.set(resolve.image, resolve.range, None, true);
            }
        }
        for access in step.work.passes().iter().flat_map(|pass| &pass.accesses) {
            // What a pass stores it may keep, whatever that is.
            if writes_layer(self.plan, access) {
                self.set(access.image, access.range, access.eye, true);
                continue;
            }
            // Within a scope its attachments are among them.
            let writes = scope.is_none() && !access.accesses.writes().is_empty();
            let only_reads = scope.is_none() && !writes && !access.accesses.is_empty();
            if only_reads || access.accesses.intersects(shader_reads) {
                self.read(id, access.image, access.range, access.eye, found);
            }
            if writes {
                self.set(access.image, access.range, access.eye, true);
            }
        }
        // A fill has only a target.
        let sides: Vec<&Side> = step.work.sides().collect();
        for (at, side) in sides.iter().enumerate() {
            if let Side::Image { image, range, .. } = **side {
                match at + 1 == sides.len() {
                    true => self.set(image, range, None, true),
                    false => self.read(id, image, range, None, found),
                }
            }
        }
    }

    fn set(&mut self, image: ImageId, range: Subresources, eye: Option<Eye>, defined: bool) {
        for (_, layers) in self.defined.range_mut(levels(image, range)) {
            match eye {
                Some(eye) => layers[eye as usize] = defined,
                None => *layers = [defined; 2],
            }
        }
    }

    fn read(&mut self, id: StepId, image: ImageId, range: Subresources, eye: Option<Eye>, found: &mut Findings<'_>) {
        for (_, layers) in self.defined.range_mut(levels(image, range)) {
            let missing = Eye::BOTH.into_iter().find(|of| eye.is_none_or(|eye| eye == *of) && !layers[*of as usize]);
            if let Some(missing) = missing {
                let what = format!("is read, and nothing has written the layer of the {} eye", missing.name());
                found.structure(Some(id), Some(image.0), what);
                // Said once.
                *layers = [true; 2];
            }
        }
    }
}

/// The keys of the mip levels of a range.
fn levels(image: ImageId, range: Subresources) -> std::ops::Range<(u32, u32)> {
    (image.0, range.base_mip)..(image.0, range.base_mip.saturating_add(range.mips))
}
