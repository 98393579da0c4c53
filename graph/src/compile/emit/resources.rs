//! Images and buffers of the Plan.

use crate::compile::model::{Adapted, Kind, MemorySource, Store};
use crate::compile::scope::store_name;
use crate::compile::structure::{Settled, Structure};
use crate::compile::sync::States;
use crate::frame::{Frame, Lifetime, Resource};
use crate::plan::{Buffer, BufferId, Cause, ChosenFormat, Image, ImageId, Initial, Placement, Role};
use crate::vulkan::{Accesses, FillValue, Layout, Rotation, Stages, State};

/// Images and buffers of the Plan.
pub(in crate::compile) type Resources = (Vec<Image>, Vec<Buffer>);

pub(in crate::compile) fn resources(frame: &Frame, structure: &Structure, settled: &Settled) -> Resources {
    let Structure { adapted, timeline, .. } = structure;
    let (mut images, mut buffers) = (Vec::with_capacity(adapted.stores.len()), Vec::new());
    let mut chosen = settled.placed.chosen.iter().peekable();
    let stores = adapted.stores.iter().zip(0_u32..).zip(&timeline.states).zip(&settled.placed.placements);
    for (((store, at), states), placement) in stores {
        let name = store_name(frame, adapted, at).clone();
        let (span, rotation, eyes) = match store.of {
            Resource::Image(image) => {
                let declared = &frame.images[image.0 as usize];
                (declared.span, declared.rotation, declared.eyes)
            }
            Resource::Buffer(buffer) => (frame.buffers[buffer.0 as usize].span, Rotation::Identity, None),
        };
        let cause = match &store.inserted {
            Some(why) => Cause::Inserted(why.clone()),
            None => Cause::Written(frame.sources.place(span)),
        };
        let role = role(frame, adapted, store, *states, placement.as_ref());
        match &store.kind {
            Kind::Image(image) => images.push(Image {
                id: ImageId(store.id),
                name,
                cause,
                format: image.format,
                chosen: chosen.next_if(|(of, _)| *of == at).and_then(|(_, more)| chosen_format(frame, store, *more)),
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
                id: BufferId(store.id),
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
fn chosen_format(frame: &Frame, store: &Store, more_bytes: i64) -> Option<ChosenFormat> {
    let Resource::Image(image) = store.of else { return None };
    let chosen = frame.images[image.0 as usize].chosen.as_ref()?;
    Some(ChosenFormat { because: chosen.because.clone(), usual: chosen.usual, more_bytes })
}

fn role(
    frame: &Frame,
    adapted: &Adapted,
    store: &Store,
    states: Option<States>,
    placement: Option<&Placement>,
) -> Role {
    let nothing = State { stages: Stages::empty(), accesses: Accesses::empty(), layout: Layout::Undefined };
    let States { before, after } = states.unwrap_or(States { before: nothing, after: nothing });
    match (store.memory, placement) {
        (MemorySource::Persistent { becomes, initial }, _) => {
            let initial = initial.map_or_else(|| file(frame, store), Initial::Value);
            Role::Persistent { becomes: adapted.stores[becomes as usize].id, initial, before, after }
        }
        (MemorySource::Transient, Some(placement)) => Role::Transient(placement.clone()),
        (MemorySource::Transient | MemorySource::Output | MemorySource::Imported { .. }, _) => {
            Role::External { before, after }
        }
    }
}

/// The initial contents of a resource without an initial value: its file.
fn file(frame: &Frame, store: &Store) -> Initial {
    match store.of {
        Resource::Image(image) => match &frame.images[image.0 as usize].lifetime {
            Lifetime::File(file) => Initial::File(file.clone()),
            _ => Initial::Value(FillValue::Bits([0; 4])),
        },
        Resource::Buffer(_) => Initial::Value(FillValue::Bits([0; 4])),
    }
}
