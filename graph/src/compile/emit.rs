//! Puts what the stages decided into a [`Plan`].

mod attachments;
mod barriers;
mod outputs;
mod passes;
mod revise;

pub(super) use revise::{barriers, sizes, values};

use super::batch::Batched;
use super::cull::Live;
use super::hand_over::MemoryScopes;
use super::model::{Adapted, Home, Kind, Op, Store};
use super::outlive::States;
use super::parts::Grids;
use super::place::Placed;
use super::queues::{self, Queues, Release};
use super::retain::Retained;
use super::scope::{Scoped, Step as Grouped, store_name};
use super::structure::{Settled, Structure};
use super::synchronise::Pending;
use crate::base::Place;
use crate::device::Profile;
use crate::frame::{Frame, Lifetime, Resource as Declared, Work as FrameWork};
use crate::plan::{
    Buffer, BufferId, Cause, Change, ChosenFormat, DeviceUsed, FORMAT_VERSION, Image, ImageId, Initial, Note,
    Placement, Plan, Queue, Resource, Role, SettingUsed, Stage, Step, Subresources, Totals, View, ViewEye, ViewId,
    Work,
};
use crate::vulkan::{FillValue, Rotation, State};
use std::sync::Arc;

/// What the stages decided.
pub(super) struct Parts<'a> {
    frame: &'a Frame,
    device: &'a Profile,
    grids: &'a Grids,
    live: &'a Live,
    /// Notes of the stages before `adapt`.
    notes: &'a [Note],
    adapted: &'a Adapted,
    scoped: &'a Scoped,
    retained: &'a Retained,
    placed: &'a Placed,
    pending: &'a [Pending],
    /// The queues, if there are several.
    queues: Option<&'a Queues>,
    batched: &'a [Batched],
    memory: &'a [(u32, MemoryScopes)],
    exact_memory: bool,
    /// What steps say of each store.
    subjects: Vec<Subject>,
    /// The name of what has none.
    nothing: Arc<str>,
}

impl<'a> Parts<'a> {
    pub(super) fn new(
        frame: &'a Frame,
        device: &'a Profile,
        structure: &'a Structure,
        settled: &'a Settled,
    ) -> Parts<'a> {
        let Structure { grids, live, notes, adapted, scoped, retained, walked, .. } = structure;
        Parts {
            frame,
            device,
            grids,
            live,
            notes,
            adapted,
            scoped,
            retained,
            placed: &settled.placed,
            pending: &walked.barriers,
            queues: walked.queues.as_deref(),
            batched: &settled.batched,
            memory: &settled.memory,
            exact_memory: settled.exact_memory,
            subjects: Subject::of(adapted, grids),
            nothing: Arc::default(),
        }
    }
}

/// What steps say of a store: in one place, since they say it often.
struct Subject {
    id: u32,
    is_image: bool,
    /// Whether parts of it are tracked by themselves.
    is_cut: bool,
    all: Subresources,
}

impl Subject {
    /// One for each store.
    fn of(adapted: &Adapted, grids: &Grids) -> Vec<Subject> {
        let subject = |store: &Store| Subject {
            id: store.id,
            is_image: store.image().is_some(),
            is_cut: store.grid(grids).is_some(),
            all: store.all(),
        };
        adapted.stores.iter().map(subject).collect()
    }
}

/// Images and buffers of the Plan.
pub(super) type Resources = (Vec<Image>, Vec<Buffer>);

/// Puts the steps to what [`resources`] made, which needs no places and states any more.
pub(super) fn emit(parts: &Parts<'_>, (images, buffers): Resources) -> Plan {
    let steps = steps(parts);
    Plan {
        format_version: FORMAT_VERSION,
        device: DeviceUsed { name: parts.device.name.clone(), exact_memory: parts.exact_memory },
        settings: settings(parts),
        changes: changes(parts),
        stereo: parts.frame.stereo,
        views: views(parts),
        images,
        buffers,
        outputs: outputs::outputs(parts),
        heaps: parts.placed.heaps.clone(),
        totals: with_bytes(parts, Totals::count(&steps)),
        steps,
        notes: notes(parts),
    }
}

fn settings(parts: &Parts<'_>) -> Vec<SettingUsed> {
    let settings = parts.frame.settings.iter();
    settings.map(|(name, value)| SettingUsed { name: name.clone(), value: value.clone() }).collect()
}

fn changes(parts: &Parts<'_>) -> Vec<Change> {
    let Frame { sources, changes, .. } = parts.frame;
    changes.iter().map(|change| Change { action: change.action.clone(), at: sources.place(change.span) }).collect()
}

/// Sums with the bytes that only `place` knows.
fn with_bytes(parts: &Parts<'_>, totals: Totals) -> Totals {
    Totals {
        transient_bytes: parts.placed.transient_bytes,
        placed_bytes: parts.placed.heaps.iter().map(|heap| heap.bytes).sum(),
        live_peak_bytes: parts.placed.live_peak_bytes,
        kept_bytes: parts.placed.kept_bytes,
        ..totals
    }
}

/// The name of a store in the Plan.
fn resource(store: &Store) -> Resource {
    match store.kind {
        Kind::Image(_) => Resource::Image(ImageId(store.id)),
        Kind::Buffer(_) => Resource::Buffer(BufferId(store.id)),
    }
}

fn steps(parts: &Parts<'_>) -> Vec<Step> {
    let mut steps = Vec::with_capacity(parts.scoped.steps.len());
    let mut barriers = barriers::Barriers::new(parts);
    for (step, number) in parts.scoped.steps.iter().zip(0_u32..) {
        let (memory_barriers, image_barriers) = barriers.of(number);
        let work = match step {
            Grouped::Scope(scope) => Work::Render(Box::new(attachments::scope(parts, scope, number))),
            Grouped::Single(op) => passes::single(parts, *op),
            Grouped::Export => Work::Export,
        };
        let (waits, releases) = (Vec::new(), Vec::new());
        steps.push(Step { queue: Queue::Graphics, waits, memory_barriers, image_barriers, work, releases });
    }
    if let Some(queues) = parts.queues {
        spread(parts, queues, &mut steps);
    }
    steps
}

/// Gives each step its queue, its waits, and the halves of the transfers that it takes part in.
fn spread(parts: &Parts<'_>, queues: &Queues, steps: &mut [Step]) {
    for (step, number) in steps.iter_mut().zip(0..) {
        (step.queue, step.waits) = (queues.of(number), queues.waits(number));
    }
    for Release { from, release, to, acquire } in queues::releases(parts.grids, parts.adapted, queues, parts.pending) {
        steps[from as usize].releases.push(release);
        steps[to as usize].image_barriers.push(acquire);
    }
}

pub(super) fn resources(frame: &Frame, structure: &Structure, settled: &Settled) -> Resources {
    let Structure { adapted, states, .. } = structure;
    let (mut images, mut buffers) = (Vec::with_capacity(adapted.stores.len()), Vec::new());
    let mut chosen = settled.placed.chosen.iter().peekable();
    let stores = adapted.stores.iter().zip(0_u32..).zip(states).zip(&settled.placed.placements);
    for (((store, at), states), placement) in stores {
        let name = store_name(frame, adapted, at).clone();
        let (span, rotation, eyes) = match store.of {
            Declared::Image(image) => {
                let declared = &frame.images[image.0 as usize];
                (declared.span, declared.rotation, declared.eyes)
            }
            Declared::Buffer(buffer) => (frame.buffers[buffer.0 as usize].span, Rotation::Identity, None),
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
                room: adapted.room(at),
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

/// What the pipeline's choice of a format comes to.
fn chosen_format(frame: &Frame, store: &Store, more_bytes: i64) -> Option<ChosenFormat> {
    let Declared::Image(image) = store.of else { return None };
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
    let nothing = State {
        stages: crate::vulkan::Stages::empty(),
        accesses: crate::vulkan::Accesses::empty(),
        layout: crate::vulkan::Layout::Undefined,
    };
    let States { before, after } = states.unwrap_or(States { before: nothing, after: nothing });
    match (store.home, placement) {
        (Home::Persistent { becomes, initial }, _) => {
            let initial = initial.map_or_else(|| file(frame, store), Initial::Value);
            Role::Persistent { becomes: adapted.stores[becomes as usize].id, initial, before, after }
        }
        (Home::Transient, Some(placement)) => Role::Transient(placement.clone()),
        (Home::Transient | Home::Output | Home::Imported { .. }, _) => Role::External { before, after },
    }
}

/// The file of what has no initial value.
fn file(frame: &Frame, store: &Store) -> Initial {
    match store.of {
        Declared::Image(image) => match &frame.images[image.0 as usize].lifetime {
            Lifetime::File(file) => Initial::File(file.clone()),
            _ => Initial::Value(FillValue::Bits([0; 4])),
        },
        Declared::Buffer(_) => Initial::Value(FillValue::Bits([0; 4])),
    }
}

fn views(parts: &Parts<'_>) -> Vec<View> {
    let view = |view: &crate::frame::View| View {
        name: view.name.clone(),
        extent: view.extent,
        camera: view.camera.clone(),
        allows: view.allows,
        jitter: view.jitter.clone(),
        eye: view.eye.map(|crate::frame::ViewEye { eye, of }| ViewEye { eye, of: ViewId(of.0) }),
    };
    parts.frame.views.iter().map(view).collect()
}

/// Notes by stage.
fn notes(parts: &Parts<'_>) -> Vec<Note> {
    let frame = parts.frame;
    let off = frame.switched_off.iter().map(|off| Note {
        stage: Stage::Expand,
        subject: off.name.clone(),
        text: match &off.sampled {
            Some(name) => format!("is compiled without `{name}`: {}", off.because),
            None => format!("is off: {}", off.because),
        },
        at: frame.sources.place(off.span),
    });
    let culled = parts.live.culled.iter().map(|pass| &frame.passes[*pass as usize]).map(|pass| Note {
        stage: Stage::Cull,
        subject: pass.name.clone(),
        text: "does not run: no output needs what it writes".to_owned(),
        at: frame.sources.place(pass.span),
    });
    let remarks = frame.remarks.iter().map(|remark| Note {
        stage: if remark.instead { Stage::Fit } else { Stage::Expand },
        subject: remark.subject.clone(),
        text: remark.text.clone(),
        at: frame.sources.place(remark.span),
    });
    off.chain(remarks)
        .chain(culled)
        .chain(parts.notes.iter().cloned())
        .chain(parts.adapted.notes.iter().cloned())
        .collect()
}

/// Why an operation is there.
fn cause(parts: &Parts<'_>, op: &Op) -> Cause {
    let place = |pass: u32| -> Option<Place> { parts.frame.sources.place(parts.frame.passes[pass as usize].span) };
    match op.kind.inserted() {
        Some(why) => Cause::Inserted(Box::new(why.clone())),
        None => Cause::Written(op.kind.pass().and_then(place)),
    }
}

/// The work of the pass that an operation is or stands in for.
fn frame_work<'f>(parts: &Parts<'f>, op: &Op) -> Option<&'f FrameWork> {
    op.kind.pass().map(|pass| &parts.frame.passes[pass as usize].work)
}
