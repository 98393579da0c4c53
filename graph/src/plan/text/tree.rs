//! The entries of a Plan in words, and its tree form: the steps in order, with inserted work at its place and why.

use super::changes;
use super::decisions::Decisions;
use super::lists::{self, totals};
use super::outline::Outline;
use super::words;
use super::words::{
    bound, bytes, cause, fill_value, hazard, moved, needless_if, on_chip, samples, size, words_of_list,
};
use crate::frame::{
    Blend, BufferRole, Draw, DrawList, EyeForm, Groups, IndirectDraws, Property, StencilState, Stereo, Subject,
};
use crate::plan::names::ShownText;
use crate::plan::{
    About, Access, Attachment, AttachmentKind, AttachmentResolve, BufferAccess, Cause, Entry, EntryKind, Image,
    ImageBarrier, ImageId, Item, MemoryBarrier, MovedBytes, OutsideTransfer, OutsideWay, Pass, Plan, Queue,
    RenderScope, Resource, Side, Step, StepId, Transfer, Wait, Work,
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
        Text::of(self, detail).outline()
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

/// The entries of a Plan in words.
#[derive(Debug)]
pub struct Text<'p> {
    plan: &'p Plan,
    detail: Detail<'p>,
    decisions: Decisions<'p>,
}

impl<'p> Text<'p> {
    /// The words for entries of `plan`.
    #[must_use]
    pub fn of(plan: &'p Plan, detail: Detail<'p>) -> Text<'p> {
        Text { plan, detail, decisions: Decisions::of(plan) }
    }

    /// The line of each entry, in their order, under a line about the Plan.
    fn outline(&self) -> Outline {
        let plan = self.plan;
        let memory = if plan.device.exact_memory { "its own memory needs" } else { "estimated memory needs" };
        let mut parts = Vec::new();
        if !plan.settings.is_empty() {
            let settings: Vec<String> = self.lines(EntryKind::Setting).into_iter().map(|line| line.text).collect();
            parts.push(Outline::of(EntryKind::Setting, format!("settings: {}", settings.join(", ")), Vec::new()));
        }
        parts.extend([EntryKind::Change, EntryKind::View].into_iter().filter_map(|kind| self.list(kind)));
        parts.extend(self.lines(EntryKind::Step));
        let lists = [EntryKind::Image, EntryKind::Buffer, EntryKind::Output, EntryKind::Note];
        parts.extend(lists.into_iter().filter_map(|kind| self.list(kind)));
        let mut totals = totals(&plan.totals);
        if self.detail.verbose {
            totals.parts.extend(self.cost(&plan.steps, plan.moved()));
        }
        parts.push(totals);
        let text = format!("Plan for {}, with {memory}", ShownText(&plan.device.name));
        Outline::of(EntryKind::Plan, text, parts)
    }

    /// The line of each entry of a kind that is no part of a step.
    fn lines(&self, kind: EntryKind) -> Vec<Outline> {
        self.plan.entries().filter(|entry| entry.kind() == kind).map(|entry| self.line(entry)).collect()
    }

    /// The lines of a kind under its heading; `None` if there are none. Images and outputs have their heading all the same.
    fn list(&self, kind: EntryKind) -> Option<Outline> {
        let lines = self.lines(kind);
        let always = matches!(kind, EntryKind::Image | EntryKind::Output);
        (always || !lines.is_empty()).then(|| Outline::of(kind, kind.heading(), lines))
    }

    /// The line of an entry, with those under it.
    #[must_use]
    pub fn line(&self, entry: Entry<'_>) -> Outline {
        let leaf = |text| (text, Vec::new());
        let (text, parts) = match entry.item {
            Item::Setting(used) => leaf(format!("{} = {}", ShownText(&used.name), ShownText(&used.value))),
            Item::Change(change) => leaf(changes::words(change)),
            Item::View(view) => leaf(lists::view(view)),
            Item::Step(step) => self.step(entry, step),
            Item::Wait(wait) => leaf(self.wait(wait)),
            Item::MemoryBarrier(barrier) => self.memory_barrier(entry.step, barrier),
            Item::ImageBarrier(barrier) => self.image_barrier(entry.step, barrier),
            Item::Outside(transfer) => self.outside(transfer),
            Item::Attachment(used, attachment) => leaf(self.attachment(used, attachment)),
            Item::Pass(pass) => self.pass(pass),
            Item::Resolve(attachment, resolve) => self.resolve(attachment, resolve),
            Item::Image(image) => {
                let chosen = image.chosen.iter().map(lists::chosen);
                let decided = self.decisions.about(&Subject::Image(image.name.clone()));
                (lists::image(self.plan, image), chosen.chain(decided).collect())
            }
            Item::Buffer(buffer) => leaf(lists::buffer(self.plan, buffer)),
            Item::Output(output) => leaf(lists::output(self.plan, output)),
            Item::Note(note) => leaf(lists::note(note)),
        };
        let at = if let Item::Note(note) = entry.item { note.at.as_ref() } else { entry.cause().and_then(Cause::at) };
        Outline { about: entry.about(), at: at.cloned(), ..Outline::of(entry.kind(), text, parts) }
    }

    fn step(&self, entry: Entry<'_>, step: &Step) -> (String, Vec<Outline>) {
        let title = match &step.work {
            Work::Render(scope) => self.scope(scope),
            Work::Dispatch(_) | Work::Custom(_) => step.work.word().to_owned(),
            Work::Resolve(transfer) | Work::Copy(transfer) | Work::Blit(transfer) => {
                self.transfer(step.work.word(), transfer)
            }
            Work::Fill(fill) => {
                let name = fill.name.as_ref().map_or_else(String::new, |name| format!("`{}` ", ShownText(name)));
                let value = fill_value(self.plan, fill);
                format!("{name}fills {} with {value}{}", self.side(&fill.target), cause(&fill.cause))
            }
            Work::Export if entry.step.is_some_and(|StepId(id)| id as usize + 1 == self.plan.steps.len()) => {
                "images are left in their promised states".to_owned()
            }
            Work::Export => "images change their layouts before several queues read them".to_owned(),
        };
        let mut parts = self.about_transfer(&step.work);
        parts.extend(entry.parts().map(|part| self.line(part)));
        if self.detail.verbose {
            parts.extend(self.cost(std::slice::from_ref(step), self.plan.moved_by(step)));
        }
        let queue = match step.queue {
            Queue::Graphics => "",
            Queue::Compute => " on the compute queue",
            Queue::Transfer => " on the transfer queue",
        };
        let runs =
            if step.run.is_always() { String::new() } else { format!(", runs {}", ShownText(&step.run.to_string())) };
        let number = entry.step.map_or_else(String::new, |StepId(id)| format!(" {id}"));
        (format!("step{number}{queue}{runs}: {title}"), parts)
    }

    /// The bytes that steps move, and those that stay on the chip.
    fn cost(&self, steps: &[Step], sums: MovedBytes) -> impl Iterator<Item = Outline> {
        moved(sums).into_iter().chain(on_chip(self.plan, steps)).map(Outline::detail)
    }

    fn scope(&self, scope: &RenderScope) -> String {
        let [width, height] = scope.extent;
        let layers = if scope.layers == 1 { String::new() } else { format!(", {} layers", scope.layers) };
        let eyes = self.plan.eyes(scope).map_or_else(String::new, |form| self.both_eyes(form));
        format!("rendering scope, {width}×{height}{layers}, {}{eyes}", samples(scope.samples))
    }

    /// How a scope draws for both eyes.
    fn both_eyes(&self, form: EyeForm) -> String {
        let how = match (self.plan.stereo, form) {
            (Stereo::Instanced, EyeForm::Layers) => "twice the instances, each in the layer of its eye",
            (Stereo::Instanced, EyeForm::Halves) => "twice the instances, cut at the seam by a clip distance",
            (Stereo::DoubleWide, _) => "each draw twice, each to the viewport of its half",
            (Stereo::Off | Stereo::MultiPass | Stereo::Multiview, _) => "two views at once",
        };
        format!(", for both eyes: {how}")
    }

    fn wait(&self, wait: &Wait) -> String {
        let frame = match wait.frames_ago {
            0 => String::new(),
            1 => " of the frame before".to_owned(),
            ago => format!(" of {ago} frames ago"),
        };
        let who = self.plan.step_name(wait.step);
        format!("waits in {} for step {}{frame}: {who}", name_of(&wait.stages), wait.step.0)
    }

    fn resolve(&self, attachment: &Attachment, resolve: &AttachmentResolve) -> (String, Vec<Outline>) {
        let [from, to] = [(attachment.image, attachment.range), (resolve.image, resolve.range)];
        let [from, to] = [from, to].map(|(image, range)| self.part(image, range));
        let mode = name_of(&resolve.mode);
        let text = format!("resolve {from} → {to}, {mode}, folded{}", cause(&resolve.cause));
        (text, self.about_samples(attachment.image))
    }

    fn attachment(&self, location: usize, attachment: &Attachment) -> String {
        let used_as = attachment.kind.words(location);
        let clear = match (attachment.clear, attachment.kind) {
            (Some([red, green, blue, alpha]), AttachmentKind::Color) => format!(" ({red}, {green}, {blue}, {alpha})"),
            (Some([value, ..]), AttachmentKind::Depth | AttachmentKind::Stencil) => format!(" {value}"),
            (None, _) => String::new(),
        };
        let part = self.part(attachment.image, attachment.range);
        let [load, store] = [name_of(&attachment.load), name_of(&attachment.store)];
        let because = attachment.because.to_string();
        format!("{used_as}: {part}, load {load}{clear}, store {store}: {}", ShownText(&because))
    }

    fn pass(&self, pass: &Pass) -> (String, Vec<Outline>) {
        let work = match (pass.draw, pass.groups) {
            (Some(Draw::Objects(list)), _) => format!("draws {}", self.objects(list)),
            (Some(Draw::Casters(cascade)), _) => {
                format!("draws {} as the sun sees them, {}", self.objects(cascade.list), cascade.in_words())
            }
            (Some(Draw::Sky), _) => "draws the sky".to_owned(),
            (Some(Draw::FullScreen), _) => "draws the full screen".to_owned(),
            (Some(Draw::Vertices { count, instances }), _) => format!("draws {count} × {instances} vertices"),
            (Some(Draw::Indirect), _) => "draws as many vertices as a buffer says".to_owned(),
            (Some(Draw::Indirects(IndirectDraws { draws, count, .. })), _) => {
                let most = if count.is_some() { "as many draws as a buffer says, at most " } else { "" };
                let draws = if count.is_some() { draws.to_string() } else { format!("{draws} draws") };
                format!("makes {most}{draws}, of as many vertices as a buffer says")
            }
            (Some(Draw::Custom) | None, None) => "is recorded by the program".to_owned(),
            (Some(Draw::Custom) | None, Some(Groups::Count([x, y, z]))) => format!("dispatches {x}×{y}×{z} groups"),
            (Some(Draw::Custom) | None, Some(Groups::Invocations([x, y, z]))) => {
                format!("dispatches {x}×{y}×{z} invocations")
            }
            (Some(Draw::Custom) | None, Some(Groups::Indirect { .. })) => {
                "dispatches as many groups as a buffer says".to_owned()
            }
        };
        let mut text = format!("`{}` {work} with shader `{}`", ShownText(&pass.name), ShownText(&pass.shader));
        if let Some(redraws) = &pass.redraws {
            text += &format!(", again as `{}` does, depth only", ShownText(redraws));
        }
        if pass.both_eyes {
            text += ", for both eyes at once";
        }
        if pass.alpha_to_coverage {
            text += ", alpha to coverage";
        }
        for (color, blend) in pass.blend.iter().enumerate().filter(|(_, blend)| **blend != Blend::Replace) {
            text += &format!(", blends color {color} {blend}");
        }
        for (color, mask) in pass.write_masks.iter().enumerate().filter(|(_, mask)| !mask.is_all()) {
            text += &format!(", writes {} of color {color}", name_of(mask));
        }
        if !pass.raster.is_usual() {
            text += &format!(", {}", pass.raster);
        }
        if let Some(depth) = &pass.depth {
            text += &format!(", depth {}{}", name_of(&depth.test), if depth.write { " and written" } else { "" });
        }
        if let Some(StencilState { test, reference, pass, .. }) = &pass.stencil {
            text += &format!(", stencil {} {reference} then {}", name_of(test), name_of(pass));
        }
        if let Some(view) = pass.view.and_then(|view| self.plan.views.get(view.0 as usize)) {
            text += &format!(", for view `{}`", ShownText(&view.name));
        }
        text += &cause(&pass.cause);
        let mut parts = self.about_pass(&pass.name);
        parts.extend(pass.accesses.iter().filter_map(|access| self.binding(access)));
        parts.extend(pass.buffers.iter().map(|access| self.buffer(access)));
        for param in pass.params.iter().chain(&pass.constants) {
            parts.push(Outline::detail(format!("{} = {}", ShownText(&param.name), param.value)));
        }
        if let Some(merged) = &pass.merged {
            parts.push(Outline::detail(format!("in the scope of the pass before: {}", ShownText(&merged.to_string()))));
        }
        (text, parts)
    }

    /// The objects of a draw, at most. Objects outside of the picture aren't drawn, but no Plan knows those.
    fn objects(&self, list: DrawList) -> String {
        let most = self.detail.objects.map_or_else(String::new, |objects| format!("up to {} ", objects(list)));
        format!("{most}{} objects", words_of_list(list))
    }

    fn binding(&self, access: &Access) -> Option<Outline> {
        let binding = access.binding.as_ref()?;
        let eye = access.eye.map_or_else(String::new, |eye| format!(", the {} eye's", eye.name()));
        let part = self.part(access.image, access.range);
        let text = format!("{} = {part}{eye}, {}", ShownText(&binding.name), bound(binding));
        Some(Outline { about: Some(About::Image(access.image)), ..Outline::detail(text) })
    }

    fn buffer(&self, access: &BufferAccess) -> Outline {
        let kind = access.role.map_or(if access.declared { "as declared" } else { "transferred" }, BufferRole::words);
        let binding = access.binding.as_ref().map_or_else(String::new, |name| format!("{} = ", ShownText(name)));
        let text = format!("{binding}{}, {kind}", self.resource(Resource::Buffer(access.buffer)));
        Outline { about: Some(About::Buffer(access.buffer)), ..Outline::detail(text) }
    }

    /// The settings and facts that decided about a pass.
    fn about_pass(&self, name: &Arc<str>) -> Vec<Outline> {
        self.decisions.about(&Subject::Pass(name.clone()))
    }

    /// The settings and facts that decided how many samples an image has, and so whether it is resolved.
    fn about_samples(&self, image: ImageId) -> Vec<Outline> {
        let image = self.plan.images.get(image.0 as usize);
        let about = |image: &Image| self.decisions.about_one(&Subject::Image(image.name.clone()), Property::Samples);
        image.map(about).unwrap_or_default()
    }

    /// What decided about a transfer, and about the samples that it resolves.
    fn about_transfer(&self, work: &Work) -> Vec<Outline> {
        // Passes say it themselves.
        let name = work.name().filter(|_| work.passes().is_empty());
        let mut lines: Vec<Outline> = name.map(|name| self.about_pass(name)).unwrap_or_default();
        if let Work::Resolve(Transfer { source: Side::Image { image, .. }, .. }) = work {
            lines.extend(self.about_samples(*image));
        }
        lines
    }

    fn transfer(&self, word: &str, transfer: &Transfer) -> String {
        let name = transfer.name.as_ref().map_or_else(String::new, |name| format!("`{}`: ", ShownText(name)));
        let filter = transfer.filter.map_or_else(String::new, |filter| format!(", {}", name_of(&filter)));
        let [from, to] = [self.side(&transfer.source), self.side(&transfer.target)];
        format!("{name}{word} {from} → {to}{filter}{}", cause(&transfer.cause))
    }

    fn side(&self, side: &Side) -> String {
        match side {
            Side::Image { image, range, extent, .. } => format!("{} {}", self.part(*image, *range), size(*extent)),
            Side::Buffer { bytes: taken, .. } => format!("{} {}", self.resource(side.resource()), bytes(*taken)),
        }
    }

    /// The stages and accesses of a barrier, if the outline is to say them.
    fn scopes(&self, source: (Stages, Accesses), target: (Stages, Accesses)) -> Vec<Outline> {
        let scope = |(stages, accesses): (Stages, Accesses)| match (stages.is_empty(), accesses.is_empty()) {
            (true, _) => "nothing".to_owned(),
            (false, true) => name_of(&stages),
            (false, false) => format!("{} in {}", name_of(&accesses), name_of(&stages)),
        };
        let line = || format!("waits for {}, before {}", scope(source), scope(target));
        self.detail.verbose.then(|| Outline::detail(line())).into_iter().collect()
    }

    fn memory_barrier(&self, step: Option<StepId>, barrier: &MemoryBarrier) -> (String, Vec<Outline>) {
        let hands = barrier.hand_overs.iter().map(|[from, to]| [from, to].map(|it| self.resource(*it)).join(" → "));
        let hands: Vec<String> = hands.collect();
        let mut reasons = Vec::new();
        if !hands.is_empty() {
            reasons.push(format!("memory changes hands, {}", hands.join(", ")));
        }
        reasons.extend(barrier.buffers.iter().map(|buffer| {
            let resource = Resource::Buffer(buffer.buffer);
            let who = self.who(step, buffer.needed_by, resource);
            format!("{}: {}", self.resource(resource), hazard(&who, buffer.hazard, buffer.after))
        }));
        if reasons.is_empty() {
            reasons.push("all memory".to_owned());
        }
        let MemoryBarrier { src_stages, src_accesses, dst_stages, dst_accesses, .. } = *barrier;
        let scopes = self.scopes((src_stages, src_accesses), (dst_stages, dst_accesses));
        (format!("barrier: {}", reasons.join("; ")), scopes)
    }

    fn image_barrier(&self, step: Option<StepId>, barrier: &ImageBarrier) -> (String, Vec<Outline>) {
        let [old, new] = [name_of(&barrier.old_layout), name_of(&barrier.new_layout)];
        let layouts = if old == new { format!("stays {new}") } else { format!("{old} → {new}") };
        let part = self.part(barrier.image, barrier.range);
        let hands = match barrier.ownership {
            Some([from, to]) => format!(", from the {} queue to the {} queue", name_of(&from), name_of(&to)),
            None => String::new(),
        };
        let who = self.who(step, barrier.needed_by, Resource::Image(barrier.image));
        let ImageBarrier { src_stages, src_accesses, dst_stages, dst_accesses, .. } = *barrier;
        let mut scopes = self.scopes((src_stages, src_accesses), (dst_stages, dst_accesses));
        scopes.extend(self.detail.verbose.then(|| Outline::detail(needless_if(barrier.hazard))));
        (format!("barrier: {part}: {layouts}{hands}, {}", hazard(&who, barrier.hazard, barrier.after)), scopes)
    }

    fn outside(&self, transfer: &OutsideTransfer) -> (String, Vec<Outline>) {
        let OutsideTransfer { resource, owner, way, state } = transfer;
        let cause = match resource {
            Resource::Image(image) => self.plan.images.get(image.0 as usize).map(|image| &image.cause),
            Resource::Buffer(buffer) => self.plan.buffers.get(buffer.0 as usize).map(|buffer| &buffer.cause),
        };
        let own = (state.stages, state.accesses);
        let nothing = (Stages::empty(), Accesses::empty());
        let (goes, scopes) = match way {
            OutsideWay::Acquire => (format!("taken from {}", owner.words()), self.scopes(nothing, own)),
            OutsideWay::Release => (format!("given back to {}", owner.words()), self.scopes(own, nothing)),
        };
        let layout = match resource {
            Resource::Image(_) => format!(" in {}", name_of(&state.layout)),
            Resource::Buffer(_) => String::new(),
        };
        let at = cause.map(words::cause).unwrap_or_default();
        (format!("barrier: {}: {goes}{layout}{at}", self.resource(*resource)), scopes)
    }

    /// The user that needs a barrier of a step: a pass, with its step if that is a later one, or the step.
    fn who(&self, step: Option<StepId>, needed_by: Option<StepId>, resource: Resource) -> String {
        let of_plan = |id: StepId| Some((id, self.plan.steps.get(id.0 as usize)?));
        let Some((id, needing)) = needed_by.and_then(of_plan) else { return "this step".to_owned() };
        let here = step == needed_by;
        match self.plan.needing(needed_by, resource) {
            Some(pass) if here => format!("`{}`", ShownText(&pass.name)),
            Some(pass) => format!("`{}` in step {}", ShownText(&pass.name), id.0),
            None => match needing.work.scope() {
                Some(_) if here => "the end of the scope".to_owned(),
                Some(_) => format!("the end of the scope of step {}", id.0),
                None if here => "this step".to_owned(),
                None => format!("step {}", id.0),
            },
        }
    }

    fn resource(&self, resource: Resource) -> String {
        format!("`{}`", ShownText(self.plan.resource_name(resource)))
    }

    /// An image, with its part if that isn't all of it.
    fn part(&self, id: ImageId, range: Subresources) -> String {
        let whole = self.plan.images.get(id.0 as usize).is_some_and(|image| {
            range
                == Subresources { aspects: range.aspects, ..Subresources::all(image.format, image.mips, image.layers) }
        });
        let name = self.resource(Resource::Image(id));
        if whole { name } else { format!("{name} ({range})") }
    }
}
