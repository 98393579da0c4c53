//! What a Plan says about one thing: the lines of its own entries, what it needs and is needed by, and its memory.

use crate::system::text;
use framewright_graph::base;
use framewright_graph::dataflow::{Dataflow, Edge, Node, NodeKind};
use framewright_graph::plan::{
    About, Detail, Entry, EntryKind, ImageId, Item, Outline, Placement, Plan, Queue, Resource, Role, StepId, Text,
};
use framewright_graph::vulkan::Usage;
use std::collections::BTreeSet;

/// An explanation, and where to read on.
pub(super) struct Explanation {
    pub(super) explanations: Vec<Outline>,
    pub(super) read_on: Vec<&'static str>,
}

const PLANS: &str = "docs/plans.md, on what a Plan holds";
const SYNCHRONIZATION: &str = "docs/synchronization.md, on barriers and queues";
const PAGE: &str = "`framewright inspect … --format html`, which shows it among everything else";

/// What there is to say about `thing`, if the Plan knows it.
pub(super) fn explained(plan: &Plan, thing: &str) -> Option<Explanation> {
    let flow = Dataflow::of(plan);
    let text = Text::of(plan, Detail { verbose: true, ..Detail::default() });
    let told = Explainer { plan, flow: &flow, text: &text };
    let (explanations, read_on) = match thing.split_once(':') {
        Some(("step", number)) => (told.step(number), vec![SYNCHRONIZATION, PAGE]),
        Some(("resolve", name)) => (told.resolves(name), vec![PLANS, PAGE]),
        Some(("barrier", name)) => (told.barriers(name), vec![SYNCHRONIZATION, PAGE]),
        Some(("heap", number)) => (told.heap(number), vec![PLANS, PAGE]),
        Some(("queue", name)) => (told.queue(name), vec![SYNCHRONIZATION, PAGE]),
        _ => (told.named(thing), vec![PLANS, PAGE]),
    };
    (!explanations.is_empty()).then_some(Explanation { explanations, read_on })
}

/// The help for a thing that the Plan doesn't know.
pub(super) fn names_near(plan: &Plan, thing: &str) -> Option<String> {
    let flow = Dataflow::of(plan);
    let (kind, name) = thing.split_once(':').unwrap_or(("", thing));
    let images = plan.images.iter().map(|image| &*image.name).chain(plan.buffers.iter().map(|buffer| &*buffer.name));
    let names: Vec<&str> = flow.nodes.iter().map(|node| &*node.name).chain(images).collect();
    match kind {
        "step" => Some(format!("the steps are 0 to {}", plan.steps.len().saturating_sub(1))),
        "heap" => Some(format!("the heaps are 0 to {}", plan.heaps.len().saturating_sub(1))),
        "queue" => Some("queues are graphics, compute and transfer".to_owned()),
        _ => base::suggestion(name, names.iter().copied()),
    }
}

#[derive(Clone, Copy)]
struct Explainer<'p> {
    plan: &'p Plan,
    flow: &'p Dataflow,
    text: &'p Text<'p>,
}

impl<'p> Explainer<'p> {
    /// Passes, images and buffers of a name, and passes that were left out.
    fn named(self, name: &str) -> Vec<Outline> {
        let passes = (0_u32..).zip(&self.flow.nodes).filter(|(_, node)| node.name == name);
        let mut told: Vec<Outline> = passes.map(|(at, node)| self.pass(at, node)).collect();
        let images = self.plan.images.iter().filter(|image| *image.name == *name);
        told.extend(images.map(|image| self.resource(Resource::Image(image.id), &image.role)));
        let buffers = self.plan.buffers.iter().filter(|buffer| *buffer.name == *name);
        told.extend(buffers.map(|buffer| self.resource(Resource::Buffer(buffer.id), &buffer.role)));
        let notes = self.notes(name);
        match told.first_mut() {
            Some(first) => first.parts.extend(notes),
            None if notes.is_empty() => {}
            None => told.push(line(format!("{} is not in the Plan", code(name)), notes)),
        }
        told
    }

    /// The decisions about a name that no step shows.
    fn notes(self, name: &str) -> Vec<Outline> {
        let notes = self.plan.notes.iter().filter(|note| *note.subject == *name);
        notes.map(|note| self.text.line(Entry { step: None, item: Item::Note(note) })).collect()
    }

    fn pass(self, at: u32, node: &Node) -> Outline {
        let is_own = |entry: &Entry<'_>| matches!(entry.item, Item::Pass(pass) if *pass.name == *node.name);
        let mut parts = self.in_steps(is_own);
        if parts.is_empty() {
            parts = self.folded_resolve(node);
        }
        if parts.is_empty() {
            let own = self.steps().filter(|step| step.step == Some(node.step) && step.cause().is_some());
            parts.extend(own.map(|step| leaf(self.text.line(step).text)));
        }
        parts.extend(node.because.iter().map(|because| leaf(format!("it was inserted: {because}"))));
        let edges = |pick: fn(&Edge) -> Option<u32>, other: fn(&Edge) -> Option<u32>, beside: &str| {
            let found = self.flow.edges.iter().filter(|edge| pick(edge) == Some(at));
            let named = found.map(|edge| {
                let name =
                    other(edge).map_or_else(|| beside.to_owned(), |node| code(&self.flow.nodes[node as usize].name));
                format!("{name} for {}", self.name(edge.resource))
            });
            named.collect::<BTreeSet<String>>().into_iter().map(leaf).collect::<Vec<_>>()
        };
        let needs = edges(|edge| edge.to, |edge| edge.from, "what came before the frame");
        let needed = edges(|edge| edge.from, |edge| edge.to, "what comes after the frame");
        parts.push(match needs.is_empty() {
            true => leaf("needs nothing that came before"),
            false => line("needs", needs),
        });
        parts.push(match needed.is_empty() {
            true => leaf("nothing needs what it leaves"),
            false => line("is needed by", needed),
        });
        parts.extend(self.cost(node.step));
        let kind = match node.kind {
            NodeKind::Draw => "draws",
            NodeKind::Dispatch => "dispatches",
            NodeKind::Custom => "is recorded by the program",
            NodeKind::FoldedResolve => "is folded into the scope",
            NodeKind::Resolve => "resolves",
            NodeKind::Copy => "copies",
            NodeKind::Blit => "scales",
            NodeKind::Fill => "fills",
        };
        let run = self.plan.steps.get(node.step.0 as usize).map(|step| &step.run).filter(|run| !run.is_always());
        let runs = run.map_or_else(String::new, |run| format!(", and runs {}", text::escape(&run.to_string())));
        line(format!("{} {kind} in step {}{runs}", code(&node.name), node.step.0), parts)
    }

    /// The line of the resolve that a scope carries.
    fn folded_resolve(self, node: &Node) -> Vec<Outline> {
        let written = node.uses.iter().find(|used| used.writes).map(|used| used.resource);
        self.in_steps(|entry| {
            let into = |image| written == Some(Resource::Image(image));
            let is_one = matches!(entry.item, Item::Resolve(_, resolve) if into(resolve.image));
            entry.step == Some(node.step) && is_one
        })
    }

    /// What the step of a pass moves, and what stays on the chip.
    fn cost(self, step: StepId) -> Vec<Outline> {
        let Some(step) = self.plan.steps.get(step.0 as usize) else { return Vec::new() };
        let shown = |amount: u64, before: &str, after: &str| {
            (amount > 0).then(|| leaf(format!("its step {before} {}{after}", text::bytes(amount))))
        };
        let moved = shown(self.plan.moved_by(step).sum(), "moves", "");
        let kept = shown(self.plan.on_chip_in(step), "keeps", " on the chip, neither loaded nor stored");
        moved.into_iter().chain(kept).collect()
    }

    fn resource(self, resource: Resource, role: &Role) -> Outline {
        let about = match resource {
            Resource::Image(id) => About::Image(id),
            Resource::Buffer(id) => About::Buffer(id),
        };
        let own = self.plan.entries().filter(|entry| entry.about().as_ref() == Some(&about));
        let mut parts: Vec<Outline> = own.map(|entry| self.text.line(entry)).collect();
        let users = self.flow.nodes.iter().filter_map(|node| {
            let uses: Vec<_> = node.uses.iter().filter(|used| used.resource == resource).collect();
            let how = match (uses.iter().any(|used| used.reads), uses.iter().any(|used| used.writes)) {
                (true, true) => "reads and writes it",
                (true, false) => "reads it",
                (false, true) => "writes it",
                (false, false) => return None,
            };
            Some(leaf(format!("{} in step {} {how}", code(&node.name), node.step.0)))
        });
        parts.push(line("used by", users.collect()));
        match role {
            Role::Transient(placement) => parts.push(self.shared(resource, placement)),
            Role::Persistent { .. } => parts.push(leaf("it has memory of its own: it is kept from frame to frame")),
            Role::External { .. } => parts.push(leaf("its memory is the program's: it comes from outside")),
        }
        if let Resource::Image(id) = resource {
            parts.push(leaf(self.on_chip(id)));
        }
        line(self.name(resource), parts)
    }

    /// What lies in the same bytes at other times.
    fn shared(self, resource: Resource, own: &Placement) -> Outline {
        let [first, last] = own.lifetime.map(|step| step.0);
        let others = self.placements().filter(|(other, placement)| {
            *other != resource
                && placement.heap == own.heap
                && placement.offset < own.offset.saturating_add(own.bytes)
                && own.offset < placement.offset.saturating_add(placement.bytes)
        });
        let others: Vec<Outline> = others
            .map(|(other, placement)| {
                let [first, last] = placement.lifetime.map(|step| step.0);
                leaf(format!("{}, alive in steps {first}–{last}", self.name(other)))
            })
            .collect();
        match others.is_empty() {
            true => {
                let free =
                    self.placements().filter(|(_, it)| it.lifetime[1].0 < first || it.lifetime[0].0 > last).count();
                leaf(match free {
                    0 => "its memory isn't shared: everything else is alive at the same time".to_owned(),
                    _ => "its memory isn't shared: what is alive at other times fits elsewhere".to_owned(),
                })
            }
            false => line("its memory is shared with", others),
        }
    }

    /// Whether a tiled device can keep the image on the chip.
    fn on_chip(self, id: ImageId) -> String {
        let (resource, usage) = (Resource::Image(id), self.plan.image(id).usage);
        let kept = self.plan.steps.iter().flat_map(|step| self.plan.on_chip_of_each(step));
        let kept = kept.filter(|(image, _)| *image == id).map(|(_, bytes)| bytes).fold(0, u64::saturating_add);
        if kept > 0 {
            return format!(
                "it is never loaded nor stored: the device draws in tiles, and keeps its {} on the chip",
                text::bytes(kept)
            );
        }
        if usage.contains(Usage::TRANSIENT_ATTACHMENT) {
            return "it is a transient attachment: never loaded nor stored, so a tiled device keeps it on the chip"
                .to_owned();
        }
        let attachment = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT;
        let other = self.flow.nodes.iter().find(|node| {
            let beside = |used: &&framewright_graph::dataflow::Use| {
                use framewright_graph::dataflow::UseRole::{Color, Depth, Source, Target};
                let folded = node.kind == NodeKind::FoldedResolve && matches!(used.role, Source | Target);
                used.resource == resource && !matches!(used.role, Color | Depth) && !folded
            };
            node.uses.iter().any(|used| beside(&used))
        });
        match other {
            _ if !usage.intersects(attachment) => "it is no attachment, so it lies in memory".to_owned(),
            Some(node) => format!("it is no transient attachment: {} needs it in memory", code(&node.name)),
            None => {
                "it is no transient attachment: its contents go from scope to scope, or out of the frame".to_owned()
            }
        }
    }

    fn resolves(self, name: &str) -> Vec<Outline> {
        let about = |node: &Node| node.uses.iter().any(|used| self.plan.resource_name(used.resource) == name);
        let found = (0_u32..).zip(&self.flow.nodes).filter(|(_, node)| node.kind.resolves() && about(node));
        let found: Vec<Outline> = found.map(|(at, node)| self.pass(at, node)).collect();
        match found.is_empty() {
            true => self
                .named(name)
                .into_iter()
                .map(|about| line(format!("no resolve reads or writes {}", code(name)), vec![about]))
                .collect(),
            false => found,
        }
    }

    fn barriers(self, name: &str) -> Vec<Outline> {
        let names = |(resource, needed_by): (Resource, Option<StepId>)| {
            let needing = self.plan.needing(needed_by, resource);
            self.plan.resource_name(resource) == name || needing.is_some_and(|pass| *pass.name == *name)
        };
        let of_step = |step: Entry<'_>| {
            let barriers = step.parts().filter(|entry| match entry.item {
                Item::ImageBarrier(barrier) => names((Resource::Image(barrier.image), barrier.needed_by)),
                Item::MemoryBarrier(barrier) => barrier.guarded().any(names),
                Item::Outside(transfer) => names((transfer.resource, None)),
                _ => false,
            });
            let barriers: Vec<Outline> = barriers.map(|entry| self.text.line(entry)).collect();
            (!barriers.is_empty()).then(|| line(self.text.line(step).text, barriers))
        };
        self.steps().filter_map(of_step).collect()
    }

    fn step(self, number: &str) -> Vec<Outline> {
        let number = number.parse().ok().map(StepId);
        let steps = self.steps().filter(|step| number.is_some() && step.step == number);
        steps.map(|step| self.text.line(step)).collect()
    }

    fn heap(self, number: &str) -> Vec<Outline> {
        let Some((number, heap)) =
            number.parse::<u32>().ok().and_then(|at| Some((at, self.plan.heaps.get(at as usize)?)))
        else {
            return Vec::new();
        };
        let mut inside: Vec<_> = self.placements().filter(|(_, placement)| placement.heap == number).collect();
        inside.sort_by_key(|(_, placement)| (placement.offset, placement.lifetime));
        let lines = inside.into_iter().map(|(resource, Placement { offset, bytes, lifetime, .. })| {
            let [first, last] = lifetime.map(|step| step.0);
            let [offset, bytes] = [*offset, *bytes].map(text::bytes);
            leaf(format!("{}: {bytes} at {offset}, steps {first}–{last}", self.name(resource)))
        });
        vec![line(format!("heap {number}: {}", text::bytes(heap.bytes)), lines.collect())]
    }

    fn queue(self, name: &str) -> Vec<Outline> {
        let wanted = match name {
            "graphics" => Queue::Graphics,
            "compute" => Queue::Compute,
            "transfer" => Queue::Transfer,
            _ => return Vec::new(),
        };
        let on_it = |step: &Entry<'_>| matches!(step.item, Item::Step(step) if step.queue == wanted);
        let steps = self.steps().filter(on_it).map(|step| {
            let waits = step.parts().filter(|entry| entry.kind() == EntryKind::Wait);
            Outline { parts: waits.map(|entry| self.text.line(entry)).collect(), ..self.text.line(step) }
        });
        let steps: Vec<Outline> = steps.collect();
        let number = text::count(steps.len(), "step runs", "steps run");
        vec![line(format!("{number} on the {name} queue"), steps)]
    }

    fn steps(self) -> impl Iterator<Item = Entry<'p>> {
        self.plan.entries().filter(|entry| entry.kind() == EntryKind::Step)
    }

    /// The lines of the entries within steps that `is_one` picks.
    fn in_steps(self, is_one: impl Fn(&Entry<'_>) -> bool) -> Vec<Outline> {
        let entries = self.steps().flat_map(Entry::parts).filter(is_one);
        entries.map(|entry| self.text.line(entry)).collect()
    }

    fn placements(&self) -> impl Iterator<Item = (Resource, &Placement)> {
        let images = self.plan.images.iter().map(|image| (Resource::Image(image.id), &image.role));
        let buffers = self.plan.buffers.iter().map(|buffer| (Resource::Buffer(buffer.id), &buffer.role));
        images.chain(buffers).filter_map(|(resource, role)| Some((resource, role.placement()?)))
    }

    fn name(&self, resource: Resource) -> String {
        code(self.plan.resource_name(resource))
    }
}

fn code(name: &str) -> String {
    format!("`{}`", text::escape(name))
}

fn leaf(text: impl Into<String>) -> Outline {
    line(text, Vec::new())
}

fn line(text: impl Into<String>, parts: Vec<Outline>) -> Outline {
    Outline::new(text, parts)
}
