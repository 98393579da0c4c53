//! The tree form of a Plan, for people: the steps in order, with inserted work at its place and why.

use super::changes;
use super::decided::Decisions;
use super::lists::{buffer, image, note, output, totals, view};
use super::outline::{About, Outline};
use super::words::{
    bytes, cause, fill_value, hazard, moved, needless_if, on_chip, samples, size, words_of, words_of_list,
};
use crate::frame::{Blend, BufferRole, Draw, DrawList, EyeForm, Groups, Property, StencilState, Stereo, Subject};
use crate::plan::names::Shown;
use crate::plan::{
    Access, Attachment, AttachmentKind, BindingKind, BufferAccess, Image, ImageBarrier, ImageId, MemoryBarrier, Pass,
    Plan, Queue, RenderScope, Resource, Side, Step, StepId, Transfer, Wait, Work,
};
use crate::vulkan::{Accesses, Stages, Subresources, name_of};
use std::fmt;
use std::sync::Arc;

/// How many objects of a scene are in a draw list.
type Objects<'p> = &'p dyn Fn(DrawList) -> usize;

impl Plan {
    /// The tree form for people.
    #[must_use]
    pub fn tree(&self) -> String {
        self.outline(Detail::default()).draw()
    }

    /// The lines of the tree form, which [`Outline::draw`] draws.
    #[must_use]
    pub fn outline(&self, detail: Detail<'_>) -> Outline {
        outline(self, detail)
    }
}

/// The detail of an outline.
#[derive(Clone, Copy, Default)]
pub struct Detail<'a> {
    /// How many objects of a scene are in a draw list: then passes say how many they draw at most.
    pub objects: Option<Objects<'a>>,
    /// Whether barriers say their stages and accesses, and steps the bytes that they move.
    pub verbose: bool,
}

impl fmt::Debug for Detail<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Detail { objects, verbose } = self;
        f.debug_struct("Detail").field("objects", &objects.is_some()).field("verbose", verbose).finish()
    }
}

fn outline(plan: &Plan, detail: Detail<'_>) -> Outline {
    let memory = if plan.device.exact_memory { "its own memory needs" } else { "estimated memory needs" };
    let mut parts = Vec::new();
    if !plan.settings.is_empty() {
        let settings = plan.settings.iter().map(|used| format!("{} = {}", Shown(&used.name), Shown(&used.value)));
        parts.push(Outline::leaf(format!("settings: {}", settings.collect::<Vec<_>>().join(", "))));
    }
    if !plan.changes.is_empty() {
        parts.push(Outline::new("changes", plan.changes.iter().map(|it| Outline::leaf(changes::words(it))).collect()));
    }
    if !plan.views.is_empty() {
        parts.push(Outline::new("views", plan.views.iter().map(view).collect()));
    }
    let decisions = &Decisions::of(plan);
    let step = |(id, step): (StepId, &Step)| Tree { plan, detail, decisions, id }.step(step);
    parts.extend((0..).map(StepId).zip(&plan.steps).map(step));
    let about = |it: &Image| decisions.about(&Subject::Image(it.name.clone()));
    parts.push(Outline::new("images", plan.images.iter().map(|it| image(plan, it, about(it))).collect()));
    if !plan.buffers.is_empty() {
        parts.push(Outline::new("buffers", plan.buffers.iter().map(|it| buffer(plan, it)).collect()));
    }
    parts.push(Outline::new("outputs", plan.outputs.iter().filter_map(|it| output(plan, it)).collect()));
    let notes: Vec<_> = plan.notes.iter().filter(|note| !note.is_of_shipped_fragment()).map(note).collect();
    if !notes.is_empty() {
        parts.push(Outline::new("notes", notes));
    }
    let mut totals = totals(&plan.totals);
    if detail.verbose {
        totals.parts.extend(moved(plan.moved()).map(Outline::leaf));
        totals.parts.extend(on_chip(plan, &plan.steps).map(Outline::leaf));
    }
    parts.push(totals);
    Outline::new(format!("Plan for {}, with {memory}", Shown(&plan.device.name)), parts)
}

/// One step of a Plan.
#[derive(Clone, Copy)]
struct Tree<'p> {
    plan: &'p Plan,
    detail: Detail<'p>,
    decisions: &'p Decisions<'p>,
    id: StepId,
}

impl Tree<'_> {
    fn step(self, step: &Step) -> Outline {
        let mut parts: Vec<Outline> = step.waits.iter().map(|wait| self.wait(wait)).collect();
        parts.extend(step.memory_barriers.iter().map(|barrier| self.memory_barrier(barrier)));
        parts.extend(step.image_barriers.iter().map(|barrier| self.image_barrier(barrier)));
        let title = match &step.work {
            Work::Render(scope) => {
                self.scope(scope, &mut parts);
                let [width, height] = scope.extent;
                let layers = if scope.layers == 1 { String::new() } else { format!(", {} layers", scope.layers) };
                let eyes = self.plan.eyes(scope).map_or_else(String::new, |form| self.both_eyes(form));
                format!("rendering scope, {width}×{height}{layers}, {}{eyes}", samples(scope.samples))
            }
            Work::Dispatch(pass) => {
                parts.push(self.pass(pass));
                "dispatch".to_owned()
            }
            Work::Custom(pass) => {
                parts.push(self.pass(pass));
                "custom".to_owned()
            }
            Work::Resolve(transfer) => self.transfer("resolve", transfer, &mut parts),
            Work::Copy(transfer) => self.transfer("copy", transfer, &mut parts),
            Work::Blit(transfer) => self.transfer("blit", transfer, &mut parts),
            Work::Fill(fill) => {
                parts.extend(fill.name.iter().flat_map(|name| self.about_pass(name)));
                let name = fill.name.as_ref().map_or_else(String::new, |name| format!("`{}` ", Shown(name)));
                let value = fill_value(self.plan, fill);
                format!("{name}fills {} with {value}{}", self.side(&fill.target), cause(&fill.cause))
            }
            Work::Export if self.id.0 as usize + 1 == self.plan.steps.len() => {
                "images are left in their promised states".to_owned()
            }
            Work::Export => "images change their layouts before several queues read them".to_owned(),
        };
        parts.extend(step.releases.iter().map(|barrier| self.image_barrier(barrier)));
        if self.detail.verbose {
            parts.extend(moved(self.plan.moved_by(step)).map(Outline::leaf));
            parts.extend(on_chip(self.plan, std::slice::from_ref(step)).map(Outline::leaf));
        }
        let queue = match step.queue {
            Queue::Graphics => "",
            Queue::Compute => " on the compute queue",
            Queue::Transfer => " on the transfer queue",
        };
        let step_line = Outline::new(format!("step {}{queue}: {title}", self.id.0), parts).about(About::Step(self.id));
        match &step.work {
            Work::Resolve(it) | Work::Copy(it) | Work::Blit(it) => step_line.caused(&it.cause),
            Work::Fill(fill) => step_line.caused(&fill.cause),
            Work::Render(_) | Work::Dispatch(_) | Work::Custom(_) | Work::Export => step_line,
        }
    }

    /// How a scope draws for both eyes.
    fn both_eyes(self, form: EyeForm) -> String {
        let how = match (self.plan.stereo, form) {
            (Stereo::Instanced, EyeForm::Layers) => "twice the instances, each in the layer of its eye",
            (Stereo::Instanced, EyeForm::Halves) => "twice the instances, cut at the seam by a clip distance",
            (Stereo::DoubleWide, _) => "each draw twice, each to the viewport of its half",
            (Stereo::Off | Stereo::MultiPass | Stereo::Multiview, _) => "two views at once",
        };
        format!(", for both eyes: {how}")
    }

    fn wait(self, wait: &Wait) -> Outline {
        let frame = match wait.frames_ago {
            0 => String::new(),
            1 => " of the frame before".to_owned(),
            ago => format!(" of {ago} frames ago"),
        };
        let who = self.plan.step_name(wait.step);
        Outline::leaf(format!("waits in {} for step {}{frame}: {who}", name_of(&wait.stages), wait.step.0))
            .about(About::Step(wait.step))
    }

    fn scope(self, scope: &RenderScope, parts: &mut Vec<Outline>) {
        let attachments = || scope.attachments.iter();
        parts.extend(attachments().enumerate().map(|(location, attachment)| self.attachment(location, attachment)));
        parts.extend(scope.passes.iter().map(|pass| self.pass(pass)));
        for attachment in attachments() {
            if let Some(resolve) = &attachment.resolve {
                let [from, to] = [(attachment.image, attachment.range), (resolve.image, resolve.range)];
                let [from, to] = [from, to].map(|(image, range)| self.part(image, range));
                let mode = name_of(&resolve.mode);
                let text = format!("resolve {from} → {to}, {mode}, folded{}", cause(&resolve.cause));
                let resolved = Outline::new(text, self.about_samples(attachment.image));
                parts.push(resolved.about(About::Image(resolve.image)).caused(&resolve.cause));
            }
        }
    }

    fn attachment(self, location: usize, attachment: &Attachment) -> Outline {
        let place = match attachment.kind {
            AttachmentKind::Color => format!("color {location}"),
            AttachmentKind::Depth => "depth".to_owned(),
            AttachmentKind::Stencil => "stencil".to_owned(),
        };
        let clear = match (attachment.clear, attachment.kind) {
            (Some([red, green, blue, alpha]), AttachmentKind::Color) => format!(" ({red}, {green}, {blue}, {alpha})"),
            (Some([value, ..]), AttachmentKind::Depth | AttachmentKind::Stencil) => format!(" {value}"),
            (None, _) => String::new(),
        };
        let part = self.part(attachment.image, attachment.range);
        let [load, store] = [name_of(&attachment.load), name_of(&attachment.store)];
        Outline::leaf(format!(
            "{place}: {part}, load {load}{clear}, store {store}: {}",
            Shown(&attachment.because.to_string())
        ))
        .about(About::Image(attachment.image))
    }

    fn pass(self, pass: &Pass) -> Outline {
        let work = match (pass.draw, pass.groups) {
            (Some(Draw::Objects(list)), _) => format!("draws {}", self.objects(list)),
            (Some(Draw::Casters(cascade)), _) => {
                format!("draws {} as the sun sees them, {}", self.objects(cascade.list), cascade.in_words())
            }
            (Some(Draw::Sky), _) => "draws the sky".to_owned(),
            (Some(Draw::FullScreen), _) => "draws the full screen".to_owned(),
            (Some(Draw::Vertices { count, instances }), _) => format!("draws {count} × {instances} vertices"),
            (Some(Draw::Indirect), _) => "draws as many vertices as a buffer says".to_owned(),
            (Some(Draw::Custom) | None, None) => "is recorded by the program".to_owned(),
            (Some(Draw::Custom) | None, Some(Groups::Count([x, y, z]))) => format!("dispatches {x}×{y}×{z} groups"),
            (Some(Draw::Custom) | None, Some(Groups::Invocations([x, y, z]))) => {
                format!("dispatches {x}×{y}×{z} invocations")
            }
            (Some(Draw::Custom) | None, Some(Groups::Indirect { .. })) => {
                "dispatches as many groups as a buffer says".to_owned()
            }
        };
        let mut text = format!("`{}` {work} with shader `{}`", Shown(&pass.name), Shown(&pass.shader));
        if let Some(redraws) = &pass.redraws {
            text += &format!(", again as `{}` does, depth only", Shown(redraws));
        }
        if pass.alpha_to_coverage {
            text += ", alpha to coverage";
        }
        for (color, blend) in pass.blend.iter().enumerate() {
            let words = match blend {
                Blend::Replace => continue,
                Blend::Alpha => "alpha",
                Blend::Premultiplied => "premultiplied",
                Blend::Additive => "additive",
            };
            text += &format!(", blends color {color} {words}");
        }
        if let Some(depth) = &pass.depth {
            text += &format!(", depth {}{}", name_of(&depth.test), if depth.write { " and written" } else { "" });
        }
        if let Some(StencilState { test, reference, pass, .. }) = &pass.stencil {
            text += &format!(", stencil {} {reference} then {}", name_of(test), name_of(pass));
        }
        if let Some(view) = pass.view.and_then(|view| self.plan.views.get(view.0 as usize)) {
            text += &format!(", for view `{}`", Shown(&view.name));
        }
        text += &cause(&pass.cause);
        let mut parts = self.about_pass(&pass.name);
        parts.extend(pass.accesses.iter().filter_map(|access| self.binding(access)));
        parts.extend(pass.buffers.iter().map(|access| self.buffer(access)));
        for param in &pass.params {
            parts.push(Outline::leaf(format!("{} = {}", Shown(&param.name), param.value)));
        }
        if let Some(merged) = &pass.merged {
            parts.push(Outline::leaf(format!("in the scope of the pass before: {}", Shown(&merged.to_string()))));
        }
        Outline::new(text, parts).about(About::Pass(pass.name.clone())).caused(&pass.cause)
    }

    /// The objects of a draw, at most. Objects outside of the picture aren't drawn, but no Plan knows those.
    fn objects(self, list: DrawList) -> String {
        let most = self.detail.objects.map_or_else(String::new, |objects| format!("up to {} ", objects(list)));
        format!("{most}{} objects", words_of_list(list))
    }

    fn binding(self, access: &Access) -> Option<Outline> {
        let binding = access.binding.as_ref()?;
        let kind = match binding.kind {
            BindingKind::Sampled(sampler) => {
                let declared = binding.texture.map_or_else(String::new, |texture| format!(" as {texture}"));
                format!("sampled{declared}, {}", words_of(&sampler))
            }
            BindingKind::Storage => "storage".to_owned(),
            BindingKind::InputAttachment => "read at its own position".to_owned(),
        };
        let eye = access.eye.map_or_else(String::new, |eye| format!(", the {} eye's", eye.name()));
        let part = self.part(access.image, access.range);
        let text = format!("{} = {part}{eye}, {kind}", Shown(&binding.name));
        Some(Outline::leaf(text).about(About::Image(access.image)))
    }

    fn buffer(self, access: &BufferAccess) -> Outline {
        let kind = match access.role {
            Some(BufferRole::Uniform) => "uniform",
            Some(BufferRole::Storage { write: false, .. }) => "storage, read",
            Some(BufferRole::Storage { read: false, .. }) => "storage, written",
            Some(BufferRole::Storage { .. }) => "storage, read and written",
            Some(BufferRole::Vertex) => "vertices",
            Some(BufferRole::Index) => "indices",
            Some(BufferRole::Indirect) => "counts",
            None => "transferred",
        };
        let binding = access.binding.as_ref().map_or_else(String::new, |name| format!("{} = ", Shown(name)));
        let text = format!("{binding}{}, {kind}", self.resource(Resource::Buffer(access.buffer)));
        Outline::leaf(text).about(About::Buffer(access.buffer))
    }

    /// The settings and facts that decided about a pass.
    fn about_pass(self, name: &Arc<str>) -> Vec<Outline> {
        self.decisions.about(&Subject::Pass(name.clone()))
    }

    /// The settings and facts that decided how many samples an image has, and so whether it is resolved.
    fn about_samples(self, image: ImageId) -> Vec<Outline> {
        let image = self.plan.images.get(image.0 as usize);
        let about = |image: &Image| self.decisions.about_one(&Subject::Image(image.name.clone()), Property::Samples);
        image.map(about).unwrap_or_default()
    }

    fn transfer(self, word: &str, transfer: &Transfer, parts: &mut Vec<Outline>) -> String {
        parts.extend(transfer.name.iter().flat_map(|name| self.about_pass(name)));
        if let ("resolve", Side::Image { image, .. }) = (word, transfer.source) {
            parts.extend(self.about_samples(image));
        }
        let name = transfer.name.as_ref().map_or_else(String::new, |name| format!("`{}`: ", Shown(name)));
        let filter = transfer.filter.map_or_else(String::new, |filter| format!(", {}", name_of(&filter)));
        let [from, to] = [self.side(&transfer.source), self.side(&transfer.target)];
        format!("{name}{word} {from} → {to}{filter}{}", cause(&transfer.cause))
    }

    fn side(self, side: &Side) -> String {
        match side {
            Side::Image { image, range, extent, .. } => format!("{} {}", self.part(*image, *range), size(*extent)),
            Side::Buffer { bytes: taken, .. } => format!("{} {}", self.resource(side.resource()), bytes(*taken)),
        }
    }

    /// The stages and accesses of a barrier, if the outline is to say them.
    fn scopes(self, source: (Stages, Accesses), target: (Stages, Accesses)) -> Vec<Outline> {
        let scope = |(stages, accesses): (Stages, Accesses)| match (stages.is_empty(), accesses.is_empty()) {
            (true, _) => "nothing".to_owned(),
            (false, true) => name_of(&stages),
            (false, false) => format!("{} in {}", name_of(&accesses), name_of(&stages)),
        };
        let line = || format!("waits for {}, before {}", scope(source), scope(target));
        self.detail.verbose.then(|| Outline::leaf(line())).into_iter().collect()
    }

    fn memory_barrier(self, barrier: &MemoryBarrier) -> Outline {
        let hands = barrier.hand_overs.iter().map(|[from, to]| [from, to].map(|it| self.resource(*it)).join(" → "));
        let hands: Vec<String> = hands.collect();
        let mut reasons = Vec::new();
        if !hands.is_empty() {
            reasons.push(format!("memory changes hands, {}", hands.join(", ")));
        }
        reasons.extend(barrier.buffers.iter().map(|buffer| {
            let of_it = |pass: &Pass| pass.buffers.iter().any(|access| access.buffer == buffer.buffer);
            let who = self.who(buffer.needed_by, of_it);
            let reason = hazard(&who, buffer.hazard, buffer.after);
            format!("{}: {reason}", self.resource(Resource::Buffer(buffer.buffer)))
        }));
        if reasons.is_empty() {
            reasons.push("all memory".to_owned());
        }
        let MemoryBarrier { src_stages, src_accesses, dst_stages, dst_accesses, .. } = *barrier;
        let scopes = self.scopes((src_stages, src_accesses), (dst_stages, dst_accesses));
        Outline::new(format!("barrier: {}", reasons.join("; ")), scopes)
    }

    fn image_barrier(self, barrier: &ImageBarrier) -> Outline {
        let [old, new] = [name_of(&barrier.old_layout), name_of(&barrier.new_layout)];
        let layouts = if old == new { format!("stays {new}") } else { format!("{old} → {new}") };
        let part = self.part(barrier.image, barrier.range);
        let hands = match barrier.ownership {
            Some([from, to]) => format!(", from the {} queue to the {} queue", name_of(&from), name_of(&to)),
            None => String::new(),
        };
        let who = self.who(barrier.needed_by, |pass| pass.accesses.iter().any(|access| access.image == barrier.image));
        let ImageBarrier { src_stages, src_accesses, dst_stages, dst_accesses, .. } = *barrier;
        let mut scopes = self.scopes((src_stages, src_accesses), (dst_stages, dst_accesses));
        scopes.extend(self.detail.verbose.then(|| Outline::leaf(needless_if(barrier.hazard))));
        let text = format!("barrier: {part}: {layouts}{hands}, {}", hazard(&who, barrier.hazard, barrier.after));
        Outline::new(text, scopes).about(About::Image(barrier.image))
    }

    /// The user that needs a barrier: a pass of step `needed_by` that `accesses` picks, with the step if that is a later one.
    fn who(self, needed_by: Option<StepId>, accesses: impl Fn(&Pass) -> bool) -> String {
        let step_of = |id: StepId| Some((id, self.plan.steps.get(id.0 as usize)?));
        let Some((needed_by, step)) = needed_by.and_then(step_of) else { return "this step".to_owned() };
        let here = needed_by == self.id;
        match (step.work.passes().iter().find(|pass| accesses(pass)), &step.work) {
            (Some(pass), _) if here => format!("`{}`", Shown(&pass.name)),
            (Some(pass), _) => format!("`{}` in step {}", Shown(&pass.name), needed_by.0),
            (None, Work::Render(_)) if here => "the end of the scope".to_owned(),
            (None, Work::Render(_)) => format!("the end of the scope of step {}", needed_by.0),
            (None, _) if here => "this step".to_owned(),
            (None, _) => format!("step {}", needed_by.0),
        }
    }

    fn resource(self, resource: Resource) -> String {
        format!("`{}`", Shown(self.plan.resource_name(resource)))
    }

    /// An image, with its part if that isn't all of it.
    fn part(self, id: ImageId, range: Subresources) -> String {
        let whole = self.plan.images.get(id.0 as usize).is_some_and(|image| {
            range
                == Subresources { aspects: range.aspects, ..Subresources::all(image.format, image.mips, image.layers) }
        });
        let name = self.resource(Resource::Image(id));
        if whole { name } else { format!("{name} ({range})") }
    }
}
