//! What a Plan says about one thing: its own lines of the outline, what it needs and is needed by, and its memory.

use crate::system::text;
use framewright_graph::base;
use framewright_graph::dataflow::{Dataflow, Edge, Node, NodeKind};
use framewright_graph::plan::{About, Detail, ImageId, Outline, Placement, Plan, Queue, Resource, Role, StepId};
use framewright_graph::vulkan::Usage;
use std::collections::BTreeSet;

/// An explanation, and where to read on.
pub(super) struct Explained {
    pub(super) explanations: Vec<Outline>,
    pub(super) read_on: Vec<&'static str>,
}

const PLANS: &str = "docs/plans.md, on what a Plan holds";
const SYNCHRONIZATION: &str = "docs/synchronization.md, on barriers and queues";
const PAGE: &str = "`framewright inspect … --format html`, which shows it among everything else";

/// What there is to say about `thing`, if the Plan knows it.
pub(super) fn explained(plan: &Plan, thing: &str) -> Option<Explained> {
    let flow = Dataflow::of(plan);
    let outline = plan.outline(Detail { verbose: true, ..Detail::default() });
    let told = Telling { plan, flow: &flow, outline: &outline };
    let (explanations, read_on) = match thing.split_once(':') {
        Some(("step", number)) => (told.step(number), vec![SYNCHRONIZATION, PAGE]),
        Some(("resolve", name)) => (told.resolves(name), vec![PLANS, PAGE]),
        Some(("barrier", name)) => (told.barriers(name), vec![SYNCHRONIZATION, PAGE]),
        Some(("heap", number)) => (told.heap(number), vec![PLANS, PAGE]),
        Some(("queue", name)) => (told.queue(name), vec![SYNCHRONIZATION, PAGE]),
        _ => (told.named(thing), vec![PLANS, PAGE]),
    };
    (!explanations.is_empty()).then_some(Explained { explanations, read_on })
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
struct Telling<'p> {
    plan: &'p Plan,
    flow: &'p Dataflow,
    outline: &'p Outline,
}

impl Telling<'_> {
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
        let lists = self.outline.parts.iter().filter(|part| part.text == "notes");
        let about = |note: &&Outline| {
            note.text
                .split_once('`')
                .is_some_and(|(_, rest)| rest.strip_prefix(name).is_some_and(|rest| rest.starts_with("`: ")))
        };
        let mut found: Vec<Outline> = lists.flat_map(|list| list.parts.iter().filter(about)).cloned().collect();
        // Those of shipped fragments are no part of the outline.
        if found.is_empty() {
            let notes = self.plan.notes.iter().filter(|note| *note.subject == *name);
            found.extend(notes.map(|note| Outline { at: note.at.clone(), ..line(note.text.clone(), Vec::new()) }));
        }
        found
    }

    fn pass(self, at: u32, node: &Node) -> Outline {
        let own = self.lines(|about| matches!(about, About::Pass(name) if **name == *node.name));
        let mut parts = own.clone();
        if parts.is_empty() {
            parts.extend(self.resolve_line(node));
        }
        parts.extend(node.because.iter().map(|because| line(format!("it was inserted: {because}"), Vec::new())));
        let edges = |pick: fn(&Edge) -> Option<u32>, other: fn(&Edge) -> Option<u32>, beside: &str| {
            let found = self.flow.edges.iter().filter(|edge| pick(edge) == Some(at));
            let named = found.map(|edge| {
                let name =
                    other(edge).map_or_else(|| beside.to_owned(), |node| code(&self.flow.nodes[node as usize].name));
                format!("{name} for {}", self.name(edge.resource))
            });
            named.collect::<BTreeSet<String>>().into_iter().map(|text| line(text, Vec::new())).collect::<Vec<_>>()
        };
        let needs = edges(|edge| edge.to, |edge| edge.from, "what came before the frame");
        let needed = edges(|edge| edge.from, |edge| edge.to, "what comes after the frame");
        parts.push(match needs.is_empty() {
            true => line("needs nothing that came before", Vec::new()),
            false => line("needs", needs),
        });
        parts.push(match needed.is_empty() {
            true => line("nothing needs what it leaves", Vec::new()),
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
        line(format!("{} {kind} in step {}", code(&node.name), node.step.0), parts)
    }

    /// The line of the resolve that a scope carries.
    fn resolve_line(self, node: &Node) -> Vec<Outline> {
        let steps = self.lines(|about| *about == About::Step(node.step));
        let written = node.uses.iter().find(|used| used.writes).map(|used| self.name(used.resource));
        let lines = steps.into_iter().flat_map(|step| step.parts);
        lines
            .filter(|line| {
                line.text.starts_with("resolve ")
                    && written.as_ref().is_some_and(|name| line.text.contains(&format!("→ {name}")))
            })
            .collect()
    }

    /// What the step of a pass moves, and what stays on the chip.
    fn cost(self, step: StepId) -> Vec<Outline> {
        let Some(step) = self.plan.steps.get(step.0 as usize) else { return Vec::new() };
        let shown = |amount: u64, before: &str, after: &str| {
            (amount > 0).then(|| line(format!("its step {before} {}{after}", text::bytes(amount)), Vec::new()))
        };
        let moved = shown(self.plan.moved_by(step).sum(), "moves", "");
        let kept = shown(self.plan.on_chip_in(step), "keeps", " on the chip, neither loaded nor stored");
        moved.into_iter().chain(kept).collect()
    }

    fn resource(self, resource: Resource, role: &Role) -> Outline {
        let is_own = |about: &About| match resource {
            Resource::Image(id) => *about == About::Image(id),
            Resource::Buffer(id) => *about == About::Buffer(id),
        };
        let lists = self.outline.parts.iter().filter(|part| matches!(&*part.text, "images" | "buffers"));
        let own = lists.flat_map(|list| list.parts.iter().filter(|part| part.about.as_ref().is_some_and(is_own)));
        let mut parts: Vec<Outline> = own.cloned().collect();
        let users = self.flow.nodes.iter().filter_map(|node| {
            let uses: Vec<_> = node.uses.iter().filter(|used| used.resource == resource).collect();
            let how = match (uses.iter().any(|used| used.reads), uses.iter().any(|used| used.writes)) {
                (true, true) => "reads and writes it",
                (true, false) => "reads it",
                (false, true) => "writes it",
                (false, false) => return None,
            };
            Some(line(format!("{} in step {} {how}", code(&node.name), node.step.0), Vec::new()))
        });
        parts.push(line("used by", users.collect()));
        match role {
            Role::Transient(placement) => parts.push(self.shared(resource, placement)),
            Role::Persistent { .. } => {
                parts.push(line("it has memory of its own: it is kept from frame to frame", Vec::new()))
            }
            Role::External { .. } => parts.push(line("its memory is the program's: it comes from outside", Vec::new())),
        }
        if let Resource::Image(id) = resource {
            parts.push(line(self.on_chip(id), Vec::new()));
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
                line(format!("{}, alive in steps {first}–{last}", self.name(other)), Vec::new())
            })
            .collect();
        match others.is_empty() {
            true => {
                let free =
                    self.placements().filter(|(_, it)| it.lifetime[1].0 < first || it.lifetime[0].0 > last).count();
                line(
                    match free {
                        0 => "its memory isn't shared: everything else is alive at the same time".to_owned(),
                        _ => "its memory isn't shared: what is alive at other times fits elsewhere".to_owned(),
                    },
                    Vec::new(),
                )
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
        let is_one = |node: &Node| matches!(node.kind, NodeKind::Resolve | NodeKind::FoldedResolve);
        let about = |node: &Node| node.uses.iter().any(|used| self.plain(used.resource) == name);
        let found = (0_u32..).zip(&self.flow.nodes).filter(|(_, node)| is_one(node) && about(node));
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
        let steps = self.outline.parts.iter().filter(|part| matches!(part.about, Some(About::Step(_))));
        let told = steps.filter_map(|step| {
            let shown = format!("`{name}`");
            let barriers =
                step.parts.iter().filter(|part| part.text.starts_with("barrier: ") && part.text.contains(&shown));
            let barriers: Vec<Outline> = barriers.cloned().collect();
            (!barriers.is_empty()).then(|| line(step.text.clone(), barriers))
        });
        told.collect()
    }

    fn step(self, number: &str) -> Vec<Outline> {
        let Ok(number) = number.parse() else { return Vec::new() };
        self.lines(|about| *about == About::Step(StepId(number)))
            .into_iter()
            .filter(|it| it.text.starts_with("step "))
            .collect()
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
            line(format!("{}: {bytes} at {offset}, steps {first}–{last}", self.name(resource)), Vec::new())
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
        let on_it =
            |about: &About| matches!(about, About::Step(step) if self.plan.steps[step.0 as usize].queue == wanted);
        let steps = self.outline.parts.iter().filter(|part| part.about.as_ref().is_some_and(on_it));
        let steps: Vec<Outline> = steps
            .map(|step| {
                let waits = step.parts.iter().filter(|part| part.text.starts_with("waits ")).cloned().collect();
                Outline { parts: waits, ..step.clone() }
            })
            .collect();
        let number = text::count(steps.len(), "step runs", "steps run");
        vec![line(format!("{number} on the {name} queue"), steps)]
    }

    /// The lines that are about something, wherever they stand, but for those under another such line.
    fn lines(self, about: impl Fn(&About) -> bool) -> Vec<Outline> {
        fn walk(line: &Outline, about: &dyn Fn(&About) -> bool, found: &mut Vec<Outline>) {
            match &line.about {
                Some(it) if about(it) => found.push(line.clone()),
                _ => line.parts.iter().for_each(|part| walk(part, about, found)),
            }
        }
        let mut found = Vec::new();
        walk(self.outline, &about, &mut found);
        found
    }

    fn placements(&self) -> impl Iterator<Item = (Resource, &Placement)> {
        let images = self.plan.images.iter().map(|image| (Resource::Image(image.id), &image.role));
        let buffers = self.plan.buffers.iter().map(|buffer| (Resource::Buffer(buffer.id), &buffer.role));
        images.chain(buffers).filter_map(|(resource, role)| match role {
            Role::Transient(placement) => Some((resource, placement)),
            Role::Persistent { .. } | Role::External { .. } => None,
        })
    }

    fn plain(&self, resource: Resource) -> &str {
        match resource {
            Resource::Image(id) => &self.plan.images[id.0 as usize].name,
            Resource::Buffer(id) => &self.plan.buffers[id.0 as usize].name,
        }
    }

    fn name(&self, resource: Resource) -> String {
        code(self.plain(resource))
    }
}

fn code(name: &str) -> String {
    format!("`{}`", text::escape(name))
}

fn line(text: impl Into<String>, parts: Vec<Outline>) -> Outline {
    Outline { text: text.into(), about: None, at: None, parts }
}
