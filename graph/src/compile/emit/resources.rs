//! Images and buffers of the Plan.

use super::stage_results::StageResults;
use crate::compile::model::{AdaptedFrame, Kind, MemorySource, PhysicalResource};
use crate::compile::scope::resource_name;
use crate::compile::sync::States;
use crate::frame::{Frame, Lifetime, Resource};
use crate::plan::{Buffer, BufferId, Cause, ChosenFormat, FirstContents, Image, ImageId, Placement, Role};
use crate::vulkan::{Accesses, FillValue, Layout, OutsideOwner, Rotation, Stages, State};

/// Images and buffers of the Plan.
pub(super) fn resources(results: &StageResults<'_>) -> (Vec<Image>, Vec<Buffer>) {
    let StageResults { frame, adapted, placed, decisions, .. } = results;
    let (mut images, mut buffers) = (Vec::with_capacity(adapted.resources.len()), Vec::new());
    let mut chosen = placed.chosen.iter().peekable();
    let resources = adapted.resources.iter().zip(0_u32..).zip(&decisions.states).zip(&placed.placements);
    for (((resource, at), states), placement) in resources {
        let name = resource_name(frame, adapted, at).clone();
        let (span, rotation, eyes) = match resource.of {
            Resource::Image(image) => {
                let declared = &frame.images[image.0 as usize];
                (declared.span, declared.rotation, declared.eyes)
            }
            Resource::Buffer(buffer) => (frame.buffers[buffer.0 as usize].span, Rotation::Identity, None),
        };
        let cause = match &resource.inserted {
            Some(why) => Cause::Inserted(why.clone()),
            None => Cause::Written(frame.sources.place(span)),
        };
        let role = role(frame, adapted, resource, *states, placement.as_ref());
        match &resource.kind {
            Kind::Image(image) => images.push(Image {
                id: ImageId(resource.id),
                name,
                cause,
                format: image.format,
                chosen: chosen.next_if(|(of, _)| *of == at).and_then(|(_, more)| chosen_format(frame, resource, *more)),
                shape: image.shape,
                extent: image.extent,
                allocated: adapted.allocated(at),
                rotation,
                eyes,
                mips: image.mips,
                layers: image.layers,
                samples: image.samples,
                usage: image.usage,
                sharing: image.sharing,
                role,
            }),
            Kind::Buffer(buffer) => buffers.push(Buffer {
                id: BufferId(resource.id),
                name,
                cause,
                bytes: buffer.bytes,
                usage: buffer.usage,
                sharing: buffer.sharing,
                role,
            }),
        }
    }
    (images, buffers)
}

/// The format that the pipeline chose, with its cost.
fn chosen_format(frame: &Frame, resource: &PhysicalResource, more_bytes: i64) -> Option<ChosenFormat> {
    let Resource::Image(image) = resource.of else { return None };
    let chosen = frame.images[image.0 as usize].chosen.as_ref()?;
    Some(ChosenFormat { because: chosen.because.clone(), usual: chosen.usual, more_bytes })
}

fn role(
    frame: &Frame,
    adapted: &AdaptedFrame,
    resource: &PhysicalResource,
    states: Option<States>,
    placement: Option<&Placement>,
) -> Role {
    let nothing = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::Undefined };
    let States { before, after } = states.unwrap_or(States { before: nothing, after: nothing });
    match (resource.memory, placement) {
        (MemorySource::Persistent { becomes, initial }, _) => {
            let initial = initial.map_or_else(|| file(frame, resource), FirstContents::Value);
            Role::Persistent { becomes: adapted.resources[becomes as usize].id, initial, before, after }
        }
        (MemorySource::Transient, Some(placement)) => Role::Transient(placement.clone()),
        (MemorySource::Transient | MemorySource::Output | MemorySource::Imported { .. }, _) => {
            Role::External { before, after, owner: owner(frame, resource) }
        }
    }
}

/// Who outside of the device has what is imported for it.
fn owner(frame: &Frame, resource: &PhysicalResource) -> Option<OutsideOwner> {
    let lifetime = match resource.of {
        Resource::Image(image) => &frame.images[image.0 as usize].lifetime,
        Resource::Buffer(buffer) => &frame.buffers[buffer.0 as usize].lifetime,
    };
    lifetime.owner()
}

/// The initial contents of a resource without an initial value: its file.
fn file(frame: &Frame, resource: &PhysicalResource) -> FirstContents {
    match resource.of {
        Resource::Image(image) => match &frame.images[image.0 as usize].lifetime {
            Lifetime::File(file) => FirstContents::File(file.clone()),
            _ => FirstContents::Value(FillValue::Bits([0; 4])),
        },
        Resource::Buffer(_) => FirstContents::Value(FillValue::Bits([0; 4])),
    }
}
