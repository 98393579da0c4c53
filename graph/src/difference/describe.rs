//! A Plan as a list of entries that can be compared by their names.

use super::{Change, Entry, Field, Kind};
use crate::base::Place;
use crate::frame::{Blend, Draw, EyeForm, Groups, ParamValue};
use crate::plan::names::Shown;
use crate::plan::{
    Attachment, Buffer, Cause, Fill, Hazard, Image, ImageBarrier, MemoryBarrier, Moved, Pass, Plan, Queue, RenderScope,
    Resource, Role, Side, Step, StepId, Transfer, Work,
};
use crate::vulkan::name_of;

/// An entry of one Plan.
pub(super) struct Description {
    pub(super) kind: Kind,
    pub(super) name: String,
    pub(super) fields: Vec<(&'static str, String)>,
    because: Option<String>,
    at: Option<Place>,
}

impl Description {
    fn new(kind: Kind, name: String, fields: Vec<(&'static str, String)>) -> Description {
        Description { kind, name, fields, because: None, at: None }
    }

    fn caused(self, cause: &Cause) -> Description {
        match cause {
            Cause::Written(at) => Description { at: at.clone(), ..self },
            Cause::Inserted(why) => {
                Description { because: Some(Shown(&why.because).to_string()), at: why.at.clone(), ..self }
            }
        }
    }

    pub(super) fn entry(self, change: impl FnOnce(Vec<(&'static str, String)>) -> Change) -> Entry {
        let Description { kind, name, fields, because, at } = self;
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
pub(super) fn figures(plan: &Plan) -> [(&'static str, bool, u64); 17] {
    let totals = &plan.totals;
    let Moved { loaded, stored, resolved, copied } = plan.moved();
    let count = |name, count: u32| (name, false, u64::from(count));
    let bytes = |name, bytes| (name, true, bytes);
    [
        count("passes", totals.passes),
        count("inserted passes", totals.inserted_passes),
        count("rendering scopes", totals.scopes),
        count("resolves", totals.resolves),
        count("folded resolves", totals.folded_resolves),
        count("copies", totals.copies),
        count("image barriers", totals.image_barriers),
        count("memory barriers", totals.memory_barriers),
        count("barrier calls", totals.barrier_calls),
        count("waits between queues", totals.waits),
        bytes("transient memory", totals.transient_bytes),
        bytes("placed memory", totals.placed_bytes),
        bytes("kept memory", totals.kept_bytes),
        bytes("loaded", loaded),
        bytes("stored", stored),
        bytes("resolved", resolved),
        bytes("copied", copied),
    ]
}

/// Everything in a Plan that has a name.
pub(super) fn describe(plan: &Plan) -> Vec<Description> {
    let setting = |name: &str, value: &str| {
        Description::new(Kind::Setting, code(name), vec![("value", Shown(value).to_string())])
    };
    let mut all: Vec<Description> = plan.settings.iter().map(|used| setting(&used.name, &used.value)).collect();
    all.extend(plan.images.iter().map(image));
    all.extend(plan.buffers.iter().map(buffer));
    for (id, step) in (0..).map(StepId).zip(&plan.steps) {
        Described { plan, id, step }.add(&mut all);
    }
    all.extend(plan.notes.iter().filter(|note| !note.is_of_shipped_fragment()).map(|note| Description {
        at: note.at.clone(),
        ..Description::new(Kind::Note, format!("{}: {}", code(&note.subject), Shown(&note.text)), Vec::new())
    }));
    all
}

/// A name from a file.
fn code(name: &str) -> String {
    format!("`{}`", Shown(name))
}

fn image(image: &Image) -> Description {
    let [width, height, depth] = image.extent;
    let deep = if depth == 1 { String::new() } else { format!("×{depth}") };
    let mut fields = vec![
        ("format", image.format.to_string()),
        ("size", format!("{width}×{height}{deep}")),
        ("samples", image.samples.to_string()),
    ];
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
    fields.push(("memory", memory(&image.role)));
    Description::new(Kind::Image, code(&image.name), fields).caused(&image.cause)
}

fn buffer(buffer: &Buffer) -> Description {
    let fields = vec![("size", crate::base::amount::bytes(buffer.bytes)), ("memory", memory(&buffer.role))];
    Description::new(Kind::Buffer, code(&buffer.name), fields).caused(&buffer.cause)
}

fn memory(role: &Role) -> String {
    match role {
        Role::Transient(placement) => format!("transient, {}", crate::base::amount::bytes(placement.bytes)),
        Role::Persistent { .. } => "persistent".to_owned(),
        Role::External { .. } => "external".to_owned(),
    }
}

/// A step that is described.
#[derive(Clone, Copy)]
struct Described<'p> {
    plan: &'p Plan,
    id: StepId,
    step: &'p Step,
}

impl Described<'_> {
    fn add(self, all: &mut Vec<Description>) {
        match &self.step.work {
            Work::Render(scope) => self.scope(scope, all),
            Work::Dispatch(pass) | Work::Custom(pass) => all.push(self.pass(pass, Vec::new())),
            Work::Resolve(transfer) => all.push(self.transfer(Kind::Resolve, "resolve", transfer)),
            Work::Copy(transfer) => all.push(self.transfer(Kind::Transfer, "copy", transfer)),
            Work::Blit(transfer) => all.push(self.transfer(Kind::Transfer, "blit", transfer)),
            Work::Fill(fill) => all.push(self.fill(fill)),
            Work::Export => {}
        }
        let barriers = self.step.image_barriers.iter().chain(&self.step.releases);
        all.extend(barriers.map(|barrier| self.image_barrier(barrier)));
        for barrier in &self.step.memory_barriers {
            self.memory_barrier(barrier, all);
        }
        for wait in &self.step.waits {
            let frame = if wait.frames_ago == 0 { "" } else { " of a frame before" };
            let name = format!("{} for {}{frame}", self.name(None), self.plan.step_name(wait.step));
            all.push(Description::new(Kind::Wait, name, vec![("stages", name_of(&wait.stages))]));
        }
    }

    /// The step that needs a barrier: a later one, or this one.
    fn name(self, needed_by: Option<StepId>) -> String {
        self.plan.step_name(needed_by.unwrap_or(self.id))
    }

    fn scope(self, scope: &RenderScope, all: &mut Vec<Description>) {
        let first = scope.passes.first().map_or_else(String::new, |pass| code(&pass.name));
        for (at, pass) in scope.passes.iter().enumerate() {
            let [width, height] = scope.extent;
            let shared = if at == 0 { "its own".to_owned() } else { format!("that of {first}") };
            let fields = vec![
                ("rendering scope", shared),
                ("size", format!("{width}×{height}")),
                ("samples", scope.samples.to_string()),
            ];
            all.push(self.pass(pass, fields));
        }
        for attachment in scope.color.iter().chain(&scope.depth).chain(&scope.stencil) {
            all.push(self.attachment(attachment, &first));
            if let Some(resolve) = &attachment.resolve {
                let [from, to] = [attachment.image, resolve.image].map(|id| self.resource(Resource::Image(id)));
                let fields = vec![("mode", name_of(&resolve.mode)), ("done", "at the end of a scope".to_owned())];
                all.push(Description::new(Kind::Resolve, format!("{from} → {to}"), fields).caused(&resolve.cause));
            }
        }
    }

    fn attachment(self, attachment: &Attachment, first: &str) -> Description {
        let image = self.resource(Resource::Image(attachment.image));
        let fields = vec![("load", name_of(&attachment.load)), ("store", name_of(&attachment.store))];
        let name = format!("{image}, {}, of the scope of {first}", name_of(&attachment.range.aspects));
        let because = Some(Shown(&attachment.because.to_string()).to_string());
        Description { because, ..Description::new(Kind::Attachment, name, fields) }
    }

    fn pass(self, pass: &Pass, mut fields: Vec<(&'static str, String)>) -> Description {
        fields.push(("shader", code(&pass.shader)));
        if self.step.queue != Queue::Graphics {
            fields.push(("queue", name_of(&self.step.queue)));
        }
        if let Some(Groups::Count([x, y, z])) = pass.groups {
            fields.push(("workgroups", format!("{x}×{y}×{z}")));
        }
        if let Some(Draw::Vertices { count, instances }) = pass.draw {
            fields.push(("vertices", format!("{count} × {instances}")));
        }
        if pass.blend.iter().any(|blend| *blend != Blend::Replace) {
            fields.push(("blend", pass.blend.iter().map(name_of).collect::<Vec<_>>().join(", ")));
        }
        if let Some(depth) = &pass.depth {
            fields.push((
                "depth test",
                format!("{}{}", name_of(&depth.test), if depth.write { ", written" } else { "" }),
            ));
        }
        let images = pass.accesses.iter().filter_map(|access| {
            let binding = access.binding.as_ref()?;
            Some(format!("{} = {}", Shown(&binding.name), self.resource(Resource::Image(access.image))))
        });
        let buffers = pass.buffers.iter().map(|access| {
            let name = access.binding.as_ref().map_or_else(String::new, |name| format!("{} = ", Shown(name)));
            format!("{name}{}", self.resource(Resource::Buffer(access.buffer)))
        });
        let bound: Vec<String> = images.chain(buffers).collect();
        if !bound.is_empty() {
            fields.push(("binds", bound.join(", ")));
        }
        let params = pass.params.iter().map(|param| {
            let value = match param.value {
                ParamValue::Bool(value) => value.to_string(),
                ParamValue::Integer(value) => value.to_string(),
                ParamValue::Number(value) => value.to_string(),
            };
            format!("{} = {value}", Shown(&param.name))
        });
        let params: Vec<String> = params.collect();
        if !params.is_empty() {
            fields.push(("parameters", params.join(", ")));
        }
        Description::new(Kind::Pass, code(&pass.name), fields).caused(&pass.cause)
    }

    fn transfer(self, kind: Kind, word: &str, transfer: &Transfer) -> Description {
        let [from, to] = [transfer.source, transfer.target].map(|side| self.side(side));
        let mut fields = match kind {
            Kind::Resolve => vec![("mode", "AVERAGE".to_owned()), ("done", "by a step of its own".to_owned())],
            _ => vec![("work", word.to_owned())],
        };
        if let Some(filter) = &transfer.filter {
            fields.push(("filter", name_of(filter)));
        }
        Description::new(kind, format!("{from} → {to}"), fields).caused(&transfer.cause)
    }

    fn fill(self, fill: &Fill) -> Description {
        let fields = vec![("work", "fill".to_owned())];
        Description::new(Kind::Transfer, self.side(fill.target), fields).caused(&fill.cause)
    }

    fn image_barrier(self, barrier: &ImageBarrier) -> Description {
        let image = self.resource(Resource::Image(barrier.image));
        let name = format!("{image} before {}: {}", self.name(barrier.needed_by), words(barrier.hazard));
        let [from, to] = [&barrier.old_layout, &barrier.new_layout].map(name_of);
        let mut fields = vec![("layouts", format!("{from} → {to}"))];
        fields.extend(scopes(
            [name_of(&barrier.src_stages), name_of(&barrier.dst_stages)],
            [name_of(&barrier.src_accesses), name_of(&barrier.dst_accesses)],
        ));
        Description::new(Kind::Barrier, name, fields)
    }

    fn memory_barrier(self, barrier: &MemoryBarrier, all: &mut Vec<Description>) {
        let fields = scopes(
            [name_of(&barrier.src_stages), name_of(&barrier.dst_stages)],
            [name_of(&barrier.src_accesses), name_of(&barrier.dst_accesses)],
        );
        let mut add = |name: String| all.push(Description::new(Kind::Barrier, name, fields.to_vec()));
        for [before, after] in &barrier.hand_overs {
            let [before, after] = [before, after].map(|resource| self.resource(*resource));
            add(format!("memory of {before} becomes that of {after}"));
        }
        for hazard in &barrier.buffers {
            let buffer = self.resource(Resource::Buffer(hazard.buffer));
            add(format!("{buffer} before {}: {}", self.name(hazard.needed_by), words(hazard.hazard)));
        }
    }

    fn resource(self, resource: Resource) -> String {
        code(self.plan.resource_name(resource))
    }

    fn side(self, side: Side) -> String {
        self.resource(side.resource())
    }
}

/// Stages and accesses of a barrier.
fn scopes([src, dst]: [String; 2], [before, after]: [String; 2]) -> [(&'static str, String); 2] {
    [("stages", format!("{src} → {dst}")), ("accesses", format!("{before} → {after}"))]
}

fn words(hazard: Hazard) -> &'static str {
    match hazard {
        Hazard::FirstUse => "first use",
        Hazard::ReadAfterWrite => "read after write",
        Hazard::WriteAfterRead => "write after read",
        Hazard::WriteAfterWrite => "write after write",
        Hazard::LayoutChange => "another layout",
        Hazard::Export => "promised state",
        Hazard::Ownership => "another queue",
    }
}
