//! A Plan as a list of entries that can be compared by their names.

use super::steps::EntryStep;
use super::{Change, Entry, Field, Kind};
use crate::base::Place;
use crate::base::amount::bytes;
use crate::frame::{Allowances, EyeForm, Stereo};
use crate::plan::names::ShownText;
use crate::plan::text::size;
use crate::plan::{self, Buffer, Cause, FirstContents, Image, Item, MovedBytes, Note, Output, Plan, Role, View};
use crate::vulkan::{Shape, Sharing, State, in_plan, name_of};

/// An entry of one Plan.
pub(super) struct Description {
    pub(super) kind: Kind,
    pub(super) name: String,
    /// The name to pair by when the step's other passes changed.
    pub(super) of_itself: Option<String>,
    pub(super) fields: Vec<(&'static str, String)>,
    pub(super) because: Option<String>,
    pub(super) at: Option<Place>,
}

impl Description {
    pub(super) fn new(kind: Kind, name: String, fields: Vec<(&'static str, String)>) -> Description {
        Description { kind, name, of_itself: None, fields, because: None, at: None }
    }

    /// A part of a step, whose name tells the step's passes too.
    pub(super) fn of_step(self, of_itself: String) -> Description {
        Description { of_itself: Some(of_itself), ..self }
    }

    fn caused(self, cause: &Cause) -> Description {
        let because = cause.because().map(|because| ShownText(because).to_string());
        Description { because, at: cause.at().cloned(), ..self }
    }

    pub(super) fn entry(self, change: impl FnOnce(Vec<(&'static str, String)>) -> Change) -> Entry {
        let Description { kind, name, fields, because, at, .. } = self;
        Entry { kind, name, change: change(fields), because, at }
    }
}

impl Field {
    /// The value that the entry has in either Plan: B's, if it has one there.
    pub(super) fn value(&self) -> &str {
        self.b.as_deref().or(self.a.as_deref()).unwrap_or_default()
    }
}

/// The sums of a Plan: name, whether it counts bytes, and value.
pub(super) fn figures(plan: &Plan) -> [(&'static str, bool, u64); 18] {
    let totals = &plan.totals;
    let MovedBytes { loaded, stored, resolved, copied } = plan.moved();
    let count = |name, count: u32| (name, false, u64::from(count));
    let amount = |name, bytes| (name, true, bytes);
    [
        count("passes", totals.passes),
        count("inserted passes", totals.inserted_passes),
        count("rendering scopes", totals.scopes),
        count("resolves", totals.resolves),
        count("folded resolves", totals.folded_resolves),
        count("copies", totals.copies),
        count("fills", totals.fills),
        count("image barriers", totals.image_barriers),
        count("memory barriers", totals.memory_barriers),
        count("barrier calls", totals.barrier_calls),
        count("waits between queues", totals.waits),
        amount("transient memory", totals.transient_bytes),
        amount("placed memory", totals.placed_bytes),
        amount("kept memory", totals.kept_bytes),
        amount("loaded", loaded),
        amount("stored", stored),
        amount("resolved", resolved),
        amount("copied", copied),
    ]
}

/// Everything in a Plan that has a name.
pub(super) fn describe(plan: &Plan) -> Vec<Description> {
    let entries = plan.entries().flat_map(|entry| std::iter::once(entry).chain(entry.parts()));
    let mut all: Vec<Description> = entries.flat_map(|entry| of_entry(plan, entry)).collect();
    let [width, height] = plan.extent;
    all.push(setting("size of the output", &format!("{width}×{height}")));
    if plan.stereo != Stereo::Off {
        all.push(setting("two eyes", plan.stereo.name()));
    }
    all
}

/// An entry, if it has a name. A memory barrier is one for each image and buffer.
fn of_entry(plan: &Plan, entry: plan::Entry<'_>) -> Vec<Description> {
    let of_step = EntryStep { plan, id: entry.step };
    let described = match entry.item {
        Item::Setting(used) => setting(&used.name, &used.value),
        Item::View(it) => view(it),
        Item::Step(step) => match of_step.transfer(&step.work) {
            Some(transfer) => transfer,
            None => return Vec::new(),
        },
        Item::Wait(wait) => of_step.wait(wait),
        Item::MemoryBarrier(barrier) => return of_step.memory_barrier(barrier),
        Item::ImageBarrier(barrier) => of_step.image_barrier(barrier),
        Item::Outside(transfer) => of_step.outside(transfer),
        Item::Attachment(location, attachment) => of_step.attachment(location, attachment),
        Item::Pass(pass) => of_step.pass(pass),
        Item::Resolve(attachment, resolve) => of_step.resolve(attachment, resolve),
        Item::Image(it) => image(plan, it),
        Item::Buffer(it) => buffer(plan, it),
        Item::Output(it) => output(plan, it),
        Item::Note(it) => note(it),
        Item::Change(_) => return Vec::new(),
    };
    vec![match entry.cause() {
        Some(cause) => described.caused(cause),
        None => described,
    }]
}

/// A name from a file.
pub(super) fn code(name: &str) -> String {
    format!("`{}`", ShownText(name))
}

fn setting(name: &str, value: &str) -> Description {
    Description::new(Kind::Setting, code(name), vec![("value", ShownText(value).to_string())])
}

fn image(plan: &Plan, image: &Image) -> Description {
    let mut fields = vec![
        ("format", image.format.to_string()),
        ("size", size(image.extent)),
        ("samples", image.samples.to_string()),
    ];
    if image.shape == Shape::Cube {
        fields.push(("shape", "cube".to_owned()));
    }
    if let Some([width, height]) = image.allocated {
        fields.push(("allocated size", format!("{width}×{height}")));
    }
    for (name, count) in [("mips", image.mips), ("layers", image.layers)] {
        if count > 1 {
            fields.push((name, count.to_string()));
        }
    }
    if let Some(form) = image.eyes {
        let form = match form {
            EyeForm::Layers => "layers",
            EyeForm::Halves => "side by side",
        };
        fields.push(("both eyes", form.to_owned()));
    }
    if image.rotation.turns() {
        fields.push(("rotated by", format!("{}°", image.rotation.degrees())));
    }
    fields.push(("memory", memory(plan, &image.role)));
    fields.push(("usage", name_of(&image.usage)));
    fields.extend(shared(image.sharing));
    fields.extend(states(&image.role));
    Description::new(Kind::Image, code(&image.name), fields)
}

fn buffer(plan: &Plan, buffer: &Buffer) -> Description {
    let mut fields = vec![("size", bytes(buffer.bytes)), ("memory", memory(plan, &buffer.role))];
    fields.push(("usage", name_of(&buffer.usage)));
    fields.extend(shared(buffer.sharing));
    fields.extend(states(&buffer.role));
    Description::new(Kind::Buffer, code(&buffer.name), fields)
}

fn memory(plan: &Plan, role: &Role) -> String {
    match role {
        Role::Transient(placement) => {
            let lazy = plan.heaps.get(placement.heap as usize).is_some_and(|heap| heap.lazily_allocated);
            format!("transient, {}{}", bytes(placement.bytes), if lazy { ", lazily allocated" } else { "" })
        }
        Role::Persistent { initial: FirstContents::Value(value), .. } => {
            format!("persistent, at first {}", in_plan(value))
        }
        Role::Persistent { initial: FirstContents::File(file), .. } => {
            format!("persistent, of the file {}", code(&file.path))
        }
        Role::External { owner: None, .. } => "external".to_owned(),
        Role::External { owner: Some(owner), .. } => format!("external, {} has it between frames", owner.words()),
    }
}

fn shared(sharing: Sharing) -> Option<(&'static str, String)> {
    (sharing == Sharing::Concurrent).then(|| ("sharing", name_of(&sharing)))
}

/// The states in which a frame finds and leaves what outlives it.
fn states(role: &Role) -> Vec<(&'static str, String)> {
    let words = |state: &State| {
        format!("{}, {} in {}", name_of(&state.layout), name_of(&state.accesses), name_of(&state.stages))
    };
    let named = |[before, after]: [&State; 2]| vec![("state before", words(before)), ("state after", words(after))];
    role.states().map(named).unwrap_or_default()
}

fn view(view: &View) -> Description {
    let [width, height] = view.extent;
    let mut fields = vec![("size", format!("{width}×{height}"))];
    fields.extend(view.camera.iter().map(|camera| ("camera", code(camera))));
    fields.extend(view.jitter.iter().map(|jitter| ("jitter", format!("{} shifts", jitter.offsets.len()))));
    fields.extend(view.eye.iter().map(|eye| ("eye", eye.eye.name().to_owned())));
    let Allowances { msaa, hdr, scale } = view.allows;
    let not = [(msaa, "MSAA"), (hdr, "HDR"), (scale, "scaling")].into_iter().filter(|(allowed, _)| !allowed);
    fields.extend(not.map(|(_, what)| ("does without", what.to_owned())));
    Description::new(Kind::View, code(&view.name), fields)
}

fn output(plan: &Plan, output: &Output) -> Description {
    let mut fields = vec![("is", code(plan.resource_name(output.resource)))];
    fields.extend(output.encoding.iter().map(|encoding| ("encoding", name_of(encoding))));
    fields.extend(output.encoded.iter().map(|place| ("encoded", ShownText(place).to_string())));
    fields.extend(output.eye.iter().map(|eye| ("eye", eye.name().to_owned())));
    Description::new(Kind::Output, code(&output.name), fields)
}

fn note(note: &Note) -> Description {
    let name = format!("{}: {}", code(&note.subject), ShownText(&note.text));
    Description { at: note.at.clone(), ..Description::new(Kind::Note, name, Vec::new()) }
}
