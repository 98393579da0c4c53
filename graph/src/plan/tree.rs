//! The tree form of a Plan, for people: what runs, in order, with what was inserted at its place and why.

use super::changes;
use super::names::{Shown, vulkan};
use super::outline::Node;
use super::{
    Access, Attachment, BindingKind, Buffer, BufferAccess, Cause, ChosenFormat, Hazard, Image, ImageBarrier, ImageId,
    Initial, MemoryBarrier, Note, Output, Pass, Plan, Queue, RenderScope, Resource, Role, Side, Step, StepId,
    Subresources, Totals, Transfer, View, Wait, Work,
};
use crate::encoding::Encoding;
use crate::frame::{Blend, BufferRole, Cascade, Draw, DrawList, Groups, ParamValue, StencilState};
use crate::jitter::Jitter;
use crate::source::Place;
use crate::texture::ColorSpace;
use crate::view::Allowances;
use crate::vocabulary::{AddressMode, FillValue, Filter, Sampler};

/// The tree form.
pub(super) fn tree(plan: &Plan) -> String {
    let memory = if plan.device.exact_memory { "its own memory needs" } else { "estimated memory needs" };
    let mut parts = Vec::new();
    if !plan.settings.is_empty() {
        let settings = plan.settings.iter().map(|used| format!("{} = {}", Shown(&used.name), Shown(&used.value)));
        parts.push(Node::leaf(format!("settings: {}", settings.collect::<Vec<_>>().join(", "))));
    }
    if !plan.changes.is_empty() {
        parts.push(Node::new("changes", plan.changes.iter().map(|it| Node::leaf(changes::words(it))).collect()));
    }
    if !plan.views.is_empty() {
        parts.push(Node::new("views", plan.views.iter().map(view).collect()));
    }
    parts.extend((0..).map(StepId).zip(&plan.steps).map(|(id, step)| Tree { plan, id }.step(step)));
    parts.push(Node::new("images", plan.images.iter().map(|it| image(plan, it)).collect()));
    if !plan.buffers.is_empty() {
        parts.push(Node::new("buffers", plan.buffers.iter().map(|it| buffer(plan, it)).collect()));
    }
    parts.push(Node::new("outputs", plan.outputs.iter().filter_map(|it| output(plan, it)).collect()));
    let notes: Vec<Node> = plan.notes.iter().filter(|note| !note.is_of_shipped_fragment()).map(note).collect();
    if !notes.is_empty() {
        parts.push(Node::new("notes", notes));
    }
    parts.push(totals(&plan.totals));
    Node::new(format!("Plan for {}, with {memory}", Shown(&plan.device.name)), parts).draw()
}

/// One step of a Plan.
#[derive(Clone, Copy)]
struct Tree<'p> {
    plan: &'p Plan,
    id: StepId,
}

impl Tree<'_> {
    fn step(self, step: &Step) -> Node {
        let mut parts: Vec<Node> = step.waits.iter().map(|wait| self.wait(wait)).collect();
        parts.extend(step.memory_barriers.iter().map(|barrier| self.memory_barrier(barrier)));
        parts.extend(step.image_barriers.iter().map(|barrier| self.image_barrier(step, barrier)));
        let title = match &step.work {
            Work::Render(scope) => {
                self.scope(scope, &mut parts);
                let [width, height] = scope.extent;
                let layers = if scope.layers == 1 { String::new() } else { format!(", {} layers", scope.layers) };
                format!("rendering scope, {width}×{height}{layers}, {}", samples(scope.samples))
            }
            Work::Dispatch(pass) => {
                parts.push(self.pass(pass));
                "dispatch".to_owned()
            }
            Work::Custom(pass) => {
                parts.push(self.pass(pass));
                "custom".to_owned()
            }
            Work::Resolve(transfer) => self.transfer("resolve", transfer),
            Work::Copy(transfer) => self.transfer("copy", transfer),
            Work::Blit(transfer) => self.transfer("blit", transfer),
            Work::Fill(fill) => {
                let name = fill.name.as_ref().map_or_else(String::new, |name| format!("`{}` ", Shown(name)));
                let value = fill_value(&fill.value);
                format!("{name}fills {} with {value}{}", self.side(&fill.target), cause(&fill.cause))
            }
            Work::Export if self.id.0 as usize + 1 == self.plan.steps.len() => {
                "images are left in their promised states".to_owned()
            }
            Work::Export => "images change their layouts before several queues read them".to_owned(),
        };
        parts.extend(step.releases.iter().map(|barrier| self.image_barrier(step, barrier)));
        let queue = match step.queue {
            Queue::Graphics => "",
            Queue::Compute => " on the compute queue",
            Queue::Transfer => " on the transfer queue",
        };
        Node::new(format!("step {}{queue}: {title}", self.id.0), parts)
    }

    fn wait(self, wait: &Wait) -> Node {
        let frame = match wait.frames_ago {
            0 => String::new(),
            1 => " of the frame before".to_owned(),
            ago => format!(" of {ago} frames ago"),
        };
        let who = self.plan.step_name(wait.step);
        Node::leaf(format!("waits in {} for step {}{frame}: {who}", vulkan(&wait.stages), wait.step.0))
    }

    fn scope(self, scope: &RenderScope, parts: &mut Vec<Node>) {
        let color =
            scope.color.iter().enumerate().map(|(location, attachment)| (format!("color {location}"), attachment));
        let depth = scope.depth.iter().map(|attachment| ("depth".to_owned(), attachment));
        let stencil = scope.stencil.iter().map(|attachment| ("stencil".to_owned(), attachment));
        let attachments: Vec<_> = color.chain(depth).chain(stencil).collect();
        parts.extend(attachments.iter().map(|(place, attachment)| self.attachment(place, attachment)));
        parts.extend(scope.passes.iter().map(|pass| self.pass(pass)));
        for (_, attachment) in &attachments {
            if let Some(resolve) = &attachment.resolve {
                let [from, to] = [(attachment.image, attachment.range), (resolve.image, resolve.range)];
                let [from, to] = [from, to].map(|(image, range)| self.part(image, range));
                let mode = vulkan(&resolve.mode);
                parts.push(Node::leaf(format!("resolve {from} → {to}, {mode}, folded{}", cause(&resolve.cause))));
            }
        }
    }

    fn attachment(self, place: &str, attachment: &Attachment) -> Node {
        let clear = match attachment.clear {
            Some([value, ..]) if matches!(place, "depth" | "stencil") => format!(" {value}"),
            Some([red, green, blue, alpha]) => format!(" ({red}, {green}, {blue}, {alpha})"),
            None => String::new(),
        };
        let part = self.part(attachment.image, attachment.range);
        let [load, store] = [vulkan(&attachment.load), vulkan(&attachment.store)];
        Node::leaf(format!("{place}: {part}, load {load}{clear}, store {store}: {}", Shown(&attachment.because)))
    }

    fn pass(self, pass: &Pass) -> Node {
        let work = match (pass.draw, pass.groups) {
            (Some(Draw::Objects(list)), _) => format!("draws {} objects", words_of_list(list)),
            (Some(Draw::Casters(cascade)), _) => casters(cascade),
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
            text += &format!(", depth {}{}", vulkan(&depth.test), if depth.write { " and written" } else { "" });
        }
        if let Some(StencilState { test, reference, pass, .. }) = &pass.stencil {
            text += &format!(", stencil {} {reference} then {}", vulkan(test), vulkan(pass));
        }
        if let Some(view) = pass.view.and_then(|view| self.plan.views.get(view.0 as usize)) {
            text += &format!(", for view `{}`", Shown(&view.name));
        }
        text += &cause(&pass.cause);
        let mut parts: Vec<Node> = pass.accesses.iter().filter_map(|access| self.binding(access)).collect();
        parts.extend(pass.buffers.iter().map(|access| self.buffer(access)));
        for param in &pass.params {
            let value = match param.value {
                ParamValue::Bool(value) => value.to_string(),
                ParamValue::Integer(value) => value.to_string(),
                ParamValue::Number(value) => value.to_string(),
            };
            parts.push(Node::leaf(format!("{} = {value}", Shown(&param.name))));
        }
        if let Some(merged) = &pass.merged {
            parts.push(Node::leaf(format!("in the scope of the pass before: {}", Shown(merged))));
        }
        Node::new(text, parts)
    }

    fn binding(self, access: &Access) -> Option<Node> {
        let binding = access.binding.as_ref()?;
        let kind = match binding.kind {
            BindingKind::Sampled(sampler) => {
                let declared = binding.texture.map_or_else(String::new, |texture| format!(" as {texture}"));
                format!("sampled{declared}, {}", words_of(&sampler))
            }
            BindingKind::Storage => "storage".to_owned(),
            BindingKind::InputAttachment => "read at its own position".to_owned(),
        };
        Some(Node::leaf(format!("{} = {}, {kind}", Shown(&binding.name), self.part(access.image, access.range))))
    }

    fn buffer(self, access: &BufferAccess) -> Node {
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
        Node::leaf(format!("{binding}{}, {kind}", self.resource(Resource::Buffer(access.buffer))))
    }

    fn transfer(self, word: &str, transfer: &Transfer) -> String {
        let name = transfer.name.as_ref().map_or_else(String::new, |name| format!("`{}`: ", Shown(name)));
        let filter = transfer.filter.map_or_else(String::new, |filter| format!(", {}", vulkan(&filter)));
        let [from, to] = [self.side(&transfer.source), self.side(&transfer.target)];
        format!("{name}{word} {from} → {to}{filter}{}", cause(&transfer.cause))
    }

    fn side(self, side: &Side) -> String {
        match side {
            Side::Image { image, range, extent, .. } => format!("{} {}", self.part(*image, *range), size(*extent)),
            Side::Buffer { bytes: taken, .. } => format!("{} {}", self.resource(side.resource()), bytes(*taken)),
        }
    }

    fn memory_barrier(self, barrier: &MemoryBarrier) -> Node {
        let hands = barrier.hand_overs.iter().map(|[from, to]| [from, to].map(|it| self.resource(*it)).join(" → "));
        let hands: Vec<String> = hands.collect();
        let mut reasons = Vec::new();
        if !hands.is_empty() {
            reasons.push(format!("memory changes hands, {}", hands.join(", ")));
        }
        reasons.extend(barrier.buffers.iter().map(|buffer| {
            let reason = hazard("this step", buffer.hazard, buffer.after);
            format!("{}: {reason}", self.resource(Resource::Buffer(buffer.buffer)))
        }));
        if reasons.is_empty() {
            return Node::leaf("barrier: all memory");
        }
        Node::leaf(format!("barrier: {}", reasons.join("; ")))
    }

    fn image_barrier(self, step: &Step, barrier: &ImageBarrier) -> Node {
        let [old, new] = [vulkan(&barrier.old_layout), vulkan(&barrier.new_layout)];
        let layouts = if old == new { format!("stays {new}") } else { format!("{old} → {new}") };
        let part = self.part(barrier.image, barrier.range);
        let hands = match barrier.ownership {
            Some([from, to]) => format!(", from the {} queue to the {} queue", vulkan(&from), vulkan(&to)),
            None => String::new(),
        };
        Node::leaf(format!("barrier: {part}: {layouts}{hands}, {}", self.reason(step, barrier)))
    }

    /// Why a barrier is there: who does what, after what.
    fn reason(self, step: &Step, barrier: &ImageBarrier) -> String {
        let passes = match &step.work {
            Work::Render(scope) => scope.passes.as_slice(),
            Work::Dispatch(pass) | Work::Custom(pass) => std::slice::from_ref(pass),
            Work::Resolve(_) | Work::Copy(_) | Work::Blit(_) | Work::Fill(_) | Work::Export => &[],
        };
        let touches = |pass: &&Pass| pass.accesses.iter().any(|access| access.image == barrier.image);
        let who = match (passes.iter().find(touches), &step.work) {
            (Some(pass), _) => format!("`{}`", Shown(&pass.name)),
            (None, Work::Render(_)) => "the end of the scope".to_owned(),
            (None, _) => "this step".to_owned(),
        };
        hazard(&who, barrier.hazard, barrier.after)
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

/// Who does what, after what.
fn hazard(who: &str, hazard: Hazard, after: Option<StepId>) -> String {
    let after = after.map_or("the frame before".to_owned(), |StepId(step)| format!("step {step}"));
    match hazard {
        Hazard::FirstUse => format!("first use, after {after}"),
        Hazard::ReadAfterWrite => format!("{who} reads what {after} wrote"),
        Hazard::WriteAfterRead => format!("{who} writes what {after} read"),
        Hazard::WriteAfterWrite => format!("{who} writes what {after} wrote"),
        Hazard::LayoutChange => format!("{who} reads what {after} read in another way"),
        Hazard::Export => format!("promised state, after {after}"),
        Hazard::Ownership => format!("another queue takes it over after {after}"),
    }
}

fn words_of_list(list: DrawList) -> &'static str {
    match list {
        DrawList::Opaque => "opaque",
        DrawList::Masked => "masked",
        DrawList::Transparent => "transparent",
    }
}

fn casters(cascade: Cascade) -> String {
    let Cascade { list, index, of, .. } = cascade;
    let (list, reach) = (words_of_list(list), cascade.reach_in_words());
    format!("draws {list} objects as the sun sees them, cascade {index} of {of} through {reach}")
}

fn view(view: &View) -> Node {
    let [width, height] = view.extent;
    let camera =
        view.camera.as_ref().map_or_else(|| "default camera".to_owned(), |it| format!("camera `{}`", Shown(it)));
    let Allowances { msaa, hdr, scale } = view.allows;
    let not = [(msaa, "MSAA"), (hdr, "HDR"), (scale, "scaling")];
    let not: Vec<&str> = not.iter().filter(|(allowed, _)| !allowed).map(|(_, what)| *what).collect();
    let not = if not.is_empty() { String::new() } else { format!(", without {}", not.join(", ")) };
    let jitter = view.jitter.as_ref().map_or_else(String::new, jitter);
    Node::leaf(format!("`{}` {width}×{height}, {camera}{not}{jitter}", Shown(&view.name)))
}

fn jitter(jitter: &Jitter) -> String {
    let [width, height] = jitter.extent;
    format!(", shifted in turn by {} parts of a texel of {width}×{height}", jitter.offsets.len())
}

fn buffer(plan: &Plan, buffer: &Buffer) -> Node {
    let next = |at: u32| plan.buffers.get(at as usize).map_or("", |buffer| &buffer.name);
    let text = format!("`{}` {}{}", Shown(&buffer.name), bytes(buffer.bytes), role(&buffer.role, &buffer.name, next));
    Node::leaf(text + &cause(&buffer.cause))
}

/// Where the memory of the image or buffer `name` comes from.
fn role<'p>(role: &Role, name: &str, next: impl Fn(u32) -> &'p str) -> String {
    match role {
        Role::Transient(placement) => {
            let [first, last] = placement.lifetime;
            let steps =
                if first == last { format!("step {}", first.0) } else { format!("steps {}–{}", first.0, last.0) };
            let [taken, offset] = [placement.bytes, placement.offset].map(bytes);
            format!(": {taken} at {offset} in heap {}, {steps}", placement.heap)
        }
        Role::Persistent { initial: Initial::File(file), .. } => {
            let decoded = match file.color_space {
                ColorSpace::Srgb => "sRGB",
                ColorSpace::Linear => "linear",
            };
            format!(": the file `{}` ({decoded}), only read", Shown(&file.path))
        }
        Role::Persistent { becomes, initial: Initial::Value(initial), .. } => {
            let next = next(*becomes);
            let becomes = if next == name { "stays".to_owned() } else { format!("becomes `{}`", Shown(next)) };
            format!(": persistent, {becomes} in the next frame, at first {}", fill_value(initial))
        }
        Role::External { .. } => ": external".to_owned(),
    }
}

/// A sampler, without what is usual.
fn words_of(sampler: &Sampler) -> String {
    let mut words = vulkan(&sampler.filter);
    if sampler.mips == Filter::Linear {
        words += ", between mip levels too";
    }
    if sampler.address != AddressMode::default() {
        words += &format!(", {}", vulkan(&sampler.address));
    }
    words
}

fn fill_value(value: &FillValue) -> String {
    match value {
        FillValue::Color([red, green, blue, alpha]) => format!("({red}, {green}, {blue}, {alpha})"),
        FillValue::Bits([red, green, blue, alpha]) => format!("({red}, {green}, {blue}, {alpha})"),
        FillValue::Depth(depth, stencil) => format!("depth {depth}, stencil {stencil}"),
    }
}

fn image(plan: &Plan, image: &Image) -> Node {
    let room = image.room.map_or_else(String::new, |[width, height]| format!(" of {width}×{height}"));
    let mut text = format!("`{}` {} {}{room}", Shown(&image.name), image.format, size(image.extent));
    for (count, word) in [(image.mips, "mips"), (image.layers, "layers")] {
        if count > 1 {
            text += &format!(", {count} {word}");
        }
    }
    text += &format!(", {}", samples(image.samples));
    let next = |at: u32| plan.images.get(at as usize).map_or("", |image| &image.name);
    text += &role(&image.role, &image.name, next);
    Node::new(text + &cause(&image.cause), image.chosen.iter().map(chosen).collect())
}

fn chosen(chosen: &ChosenFormat) -> Node {
    let ChosenFormat { because, usual, more_bytes } = chosen;
    let amount = bytes(more_bytes.unsigned_abs());
    let comes_to = match more_bytes {
        0 => "as many bytes as".to_owned(),
        1.. => format!("{amount} more than"),
        ..0 => format!("{amount} fewer than"),
    };
    Node::leaf(format!("{}: {comes_to} in {usual}", Shown(because)))
}

fn output(plan: &Plan, output: &Output) -> Option<Node> {
    let resource = output.resource;
    let role = match resource {
        Resource::Image(id) => &plan.images.get(id.0 as usize)?.role,
        Resource::Buffer(id) => &plan.buffers.get(id.0 as usize)?.role,
    };
    let (Role::External { after, .. } | Role::Persistent { after, .. }) = role else { return None };
    let name = Shown(plan.resource_name(resource));
    let [layout, stages, accesses] = [vulkan(&after.layout), vulkan(&after.stages), vulkan(&after.accesses)];
    let encoded = output.encoding.map_or_else(String::new, |encoding| {
        let by = output.encoded.as_deref().unwrap_or("");
        match encoding {
            Encoding::Srgb => format!("; sRGB, encoded {}", Shown(by)),
            Encoding::Hdr10 => format!("; HDR10, encoded {}", Shown(by)),
            Encoding::Linear => "; linear light, not encoded".to_owned(),
            Encoding::Unorm => "; shares from 0 to 1, not encoded".to_owned(),
        }
    });
    Some(Node::leaf(match resource {
        Resource::Image(_) => format!("`{name}` in {layout}, last {accesses} in {stages}{encoded}"),
        Resource::Buffer(_) => format!("`{name}`, last {accesses} in {stages}"),
    }))
}

fn note(note: &Note) -> Node {
    let text = format!("{} `{}`: {}{}", vulkan(&note.stage), Shown(&note.subject), Shown(&note.text), place(&note.at));
    Node::leaf(text)
}

fn totals(totals: &Totals) -> Node {
    let Totals { transient_bytes, placed_bytes, live_peak_bytes, kept_bytes, .. } = *totals;
    let ratio = if live_peak_bytes == 0 {
        String::new()
    } else {
        format!(" ({:.3} × live peak {})", placed_bytes as f64 / live_peak_bytes as f64, bytes(live_peak_bytes))
    };
    let work = format!(
        "{} ({} inserted) in {}, {} ({} folded), {}",
        count(totals.passes.saturating_add(totals.inserted_passes), "pass", "passes"),
        totals.inserted_passes,
        count(totals.scopes, "scope", "scopes"),
        count(totals.resolves, "resolve", "resolves"),
        totals.folded_resolves,
        count(totals.copies, "copy", "copies"),
    );
    let barriers = format!(
        "{} and {} in {}",
        count(totals.image_barriers, "image barrier", "image barriers"),
        count(totals.memory_barriers, "memory barrier", "memory barriers"),
        count(totals.barrier_calls, "call", "calls"),
    );
    let [transient, placed, kept] = [transient_bytes, placed_bytes, kept_bytes].map(bytes);
    let memory = format!("transient {transient} placed in {placed}{ratio}, kept {kept}");
    Node::new("totals", [work, barriers, memory].map(Node::leaf).into())
}

fn count(number: u32, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

fn samples(samples: u32) -> String {
    count(samples, "sample", "samples")
}

/// Width × height, and depth if there is any.
fn size([width, height, depth]: [u32; 3]) -> String {
    if depth == 1 { format!("{width}×{height}") } else { format!("{width}×{height}×{depth}") }
}

/// Bytes in the largest unit that leaves at least 1.
fn bytes(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["KiB", "MiB", "GiB", "TiB"];
    if bytes < 1024 {
        return format!("{bytes} B");
    }
    let unit = ((bytes.ilog2() / 10) as usize).min(UNITS.len());
    format!("{:.1} {}", bytes as f64 / 1024_f64.powi(unit as i32), UNITS[unit - 1])
}

/// Where something was written, or why it was inserted.
fn cause(cause: &Cause) -> String {
    match cause {
        Cause::Written(at) => place(at),
        Cause::Inserted(why) => format!(": {}{}", Shown(&why.because), place(&why.at)),
    }
}

fn place(at: &Option<Place>) -> String {
    at.as_ref().map_or_else(String::new, |place| format!(" ({}:{})", Shown(&place.file), place.line))
}
