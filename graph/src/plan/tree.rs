//! The tree form of a Plan, for people: what runs, in order, with what was inserted at its place and why.

use super::names::{Shown, vulkan};
use super::outline::Node;
use super::{
    Attachment, Binding, Cause, Hazard, Image, ImageBarrier, ImageId, MemoryBarrier, Note, Pass, Plan, RenderScope,
    Role, Step, StepId, Subresources, Totals, Transfer, Work,
};
use crate::frame::{Blend, Draw, DrawList, ParamValue};
use crate::source::Place;

/// The tree form.
pub(super) fn tree(plan: &Plan) -> String {
    let memory = if plan.device.exact_memory { "its own memory needs" } else { "estimated memory needs" };
    let mut parts = Vec::new();
    if !plan.settings.is_empty() {
        let settings = plan.settings.iter().map(|used| format!("{} = {}", Shown(&used.name), Shown(&used.value)));
        parts.push(Node::leaf(format!("settings: {}", settings.collect::<Vec<_>>().join(", "))));
    }
    parts.extend((0..).map(StepId).zip(&plan.steps).map(|(id, step)| Tree { plan, id }.step(step)));
    parts.push(Node::new("images", plan.images.iter().map(image).collect()));
    parts.push(Node::new("outputs", plan.outputs.iter().filter_map(|id| output(plan, *id)).collect()));
    if !plan.notes.is_empty() {
        parts.push(Node::new("notes", plan.notes.iter().map(note).collect()));
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
        let mut parts = Vec::new();
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
            Work::Resolve(transfer) => self.transfer("resolve", transfer),
            Work::Copy(transfer) => self.transfer("copy", transfer),
            Work::Export => "outputs are left in their promised states".to_owned(),
        };
        Node::new(format!("step {}: {title}", self.id.0), parts)
    }

    fn scope(self, scope: &RenderScope, parts: &mut Vec<Node>) {
        let color =
            scope.color.iter().enumerate().map(|(location, attachment)| (format!("color {location}"), attachment));
        let depth = scope.depth.iter().map(|attachment| ("depth".to_owned(), attachment));
        let attachments: Vec<_> = color.chain(depth).collect();
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
            Some([depth, ..]) if place == "depth" => format!(" {depth}"),
            Some([red, green, blue, alpha]) => format!(" ({red}, {green}, {blue}, {alpha})"),
            None => String::new(),
        };
        let part = self.part(attachment.image, attachment.range);
        let [load, store] = [vulkan(&attachment.load), vulkan(&attachment.store)];
        Node::leaf(format!("{place}: {part}, load {load}{clear}, store {store}: {}", Shown(&attachment.because)))
    }

    fn pass(self, pass: &Pass) -> Node {
        let work = match pass.draw {
            Some(Draw::Objects(DrawList::Opaque)) => "draws opaque objects",
            Some(Draw::Objects(DrawList::Masked)) => "draws masked objects",
            Some(Draw::Objects(DrawList::Transparent)) => "draws transparent objects",
            Some(Draw::Sky) => "draws the sky",
            Some(Draw::FullScreen) => "draws the full screen",
            None => "dispatches",
        };
        let mut text = format!("`{}` {work} with shader `{}`", Shown(&pass.name), Shown(&pass.shader));
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
        text += &cause(&pass.cause);
        let mut parts: Vec<Node> = pass.bindings.iter().map(|binding| self.binding(binding)).collect();
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

    fn binding(self, binding: &Binding) -> Node {
        let kind = binding.filter.map_or("storage".to_owned(), |filter| format!("sampled, {}", vulkan(&filter)));
        Node::leaf(format!("{} = {}, {kind}", Shown(&binding.name), self.part(binding.image, binding.range)))
    }

    fn transfer(self, word: &str, transfer: &Transfer) -> String {
        let from = self.part(transfer.source, transfer.source_range);
        let to = self.part(transfer.target, transfer.target_range);
        format!("{word} {from} → {to}, {}{}", size(transfer.extent), cause(&transfer.cause))
    }

    fn memory_barrier(self, barrier: &MemoryBarrier) -> Node {
        let hands = barrier.hand_overs.iter().map(|[from, to]| format!("{} → {}", self.name(*from), self.name(*to)));
        let hands: Vec<String> = hands.collect();
        if hands.is_empty() {
            return Node::leaf("barrier: all memory");
        }
        Node::leaf(format!("barrier: memory changes hands, {}", hands.join(", ")))
    }

    fn image_barrier(self, step: &Step, barrier: &ImageBarrier) -> Node {
        let [old, new] = [vulkan(&barrier.old_layout), vulkan(&barrier.new_layout)];
        let layouts = if old == new { format!("stays {new}") } else { format!("{old} → {new}") };
        let part = self.part(barrier.image, barrier.range);
        Node::leaf(format!("barrier: {part}: {layouts}, {}", self.reason(step, barrier)))
    }

    /// Why a barrier is there: who does what, after what.
    fn reason(self, step: &Step, barrier: &ImageBarrier) -> String {
        let passes = match &step.work {
            Work::Render(scope) => scope.passes.as_slice(),
            Work::Dispatch(pass) => std::slice::from_ref(pass),
            Work::Resolve(_) | Work::Copy(_) | Work::Export => &[],
        };
        let touches = |pass: &&Pass| pass.accesses.iter().any(|access| access.image == barrier.image);
        let who = match (passes.iter().find(touches), &step.work) {
            (Some(pass), _) => format!("`{}`", Shown(&pass.name)),
            (None, Work::Render(_)) => "the end of the scope".to_owned(),
            (None, _) => "this step".to_owned(),
        };
        let after = barrier.after.map_or("the frame before".to_owned(), |StepId(step)| format!("step {step}"));
        match barrier.hazard {
            Hazard::FirstUse => format!("first use, after {after}"),
            Hazard::ReadAfterWrite => format!("{who} reads what {after} wrote"),
            Hazard::WriteAfterRead => format!("{who} writes what {after} read"),
            Hazard::WriteAfterWrite => format!("{who} writes what {after} wrote"),
            Hazard::LayoutChange => format!("{who} reads what {after} read in another way"),
            Hazard::Export => format!("promised state, after {after}"),
        }
    }

    fn name(self, id: ImageId) -> String {
        self.plan.images.get(id.0 as usize).map_or_else(String::new, |image| format!("`{}`", Shown(&image.name)))
    }

    /// An image, with its part if that isn't all of it.
    fn part(self, id: ImageId, range: Subresources) -> String {
        let whole = self.plan.images.get(id.0 as usize).is_some_and(|image| {
            range
                == Subresources { aspects: range.aspects, ..Subresources::all(image.format, image.mips, image.layers) }
        });
        if whole { self.name(id) } else { format!("{} ({range})", self.name(id)) }
    }
}

fn image(image: &Image) -> Node {
    let mut text = format!("`{}` {} {}", Shown(&image.name), image.format, size(image.extent));
    for (count, word) in [(image.mips, "mips"), (image.layers, "layers")] {
        if count > 1 {
            text += &format!(", {count} {word}");
        }
    }
    text += &format!(", {}", samples(image.samples));
    match &image.role {
        Role::Transient(placement) => {
            let [first, last] = placement.lifetime;
            let steps =
                if first == last { format!("step {}", first.0) } else { format!("steps {}–{}", first.0, last.0) };
            let [taken, offset] = [placement.bytes, placement.offset].map(bytes);
            text += &format!(": {taken} at {offset} in heap {}, {steps}", placement.heap);
        }
        Role::Output { .. } => text += ": output",
    }
    Node::leaf(text + &cause(&image.cause))
}

fn output(plan: &Plan, id: ImageId) -> Option<Node> {
    let image = plan.images.get(id.0 as usize)?;
    let Role::Output { after, .. } = &image.role else { return None };
    let [layout, stages, accesses] = [vulkan(&after.layout), vulkan(&after.stages), vulkan(&after.accesses)];
    Some(Node::leaf(format!("`{}` in {layout}, ready for {accesses} in {stages}", Shown(&image.name))))
}

fn note(note: &Note) -> Node {
    let text = format!("{} `{}`: {}{}", vulkan(&note.stage), Shown(&note.subject), Shown(&note.text), place(&note.at));
    Node::leaf(text)
}

fn totals(totals: &Totals) -> Node {
    let Totals { transient_bytes, placed_bytes, live_peak_bytes, output_bytes, .. } = *totals;
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
    let [transient, placed, output] = [transient_bytes, placed_bytes, output_bytes].map(bytes);
    let memory = format!("transient {transient} placed in {placed}{ratio}, outputs {output}");
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
        Cause::Inserted { because, at } => format!(": {}{}", Shown(because), place(at)),
    }
}

fn place(at: &Option<Place>) -> String {
    at.as_ref().map_or_else(String::new, |place| format!(" ({}:{})", Shown(&place.file), place.line))
}
