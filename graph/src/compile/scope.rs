//! `scope`: neighbouring raster passes become one rendering scope where nothing forbids it and something gains; resolves
//! fold into the scope that wrote last.

use super::model::{Adapted, OpKind, Role, Start, StoreIndex, Use};
use crate::frame::Frame;
use crate::plan::{Note, Stage};
use std::sync::Arc;

/// Steps in execution order.
#[derive(Debug)]
pub(super) struct Scoped {
    pub(super) steps: Vec<Step>,
    /// Why a pass shares its scope with the pass before it, for each operation.
    pub(super) merged: Vec<Option<String>>,
}

/// One step.
#[derive(Debug)]
pub(super) enum Step {
    /// A rendering scope.
    Scope(Scope),
    /// One operation that is not drawn.
    Single(u32),
    /// The promised state of the outputs.
    Export,
}

/// A rendering scope.
#[derive(Debug, Default)]
pub(super) struct Scope {
    /// Colour attachments by location.
    pub(super) color: Vec<StoreIndex>,
    pub(super) depth: Option<StoreIndex>,
    /// Operations that draw.
    pub(super) ops: Vec<u32>,
    /// For each colour attachment the resolve operation that it carries.
    pub(super) resolves: Vec<Option<u32>>,
    /// The resolve operation that the depth attachment carries.
    pub(super) depth_resolve: Option<u32>,
}

/// The name of an operation's pass.
pub(super) fn op_name<'f>(frame: &'f Frame, adapted: &Adapted, op: u32) -> Option<&'f Arc<str>> {
    match &adapted.ops[op as usize].kind {
        OpKind::Draw(pass) | OpKind::Dispatch(pass) | OpKind::ForwardDraw { pass, .. } => {
            Some(&frame.passes[*pass as usize].name)
        }
        OpKind::Resolve { .. } | OpKind::Copy { .. } => None,
    }
}

pub(super) fn scope(frame: &Frame, adapted: &mut Adapted, order: &[u32]) -> Scoped {
    let mut builder = Builder {
        frame,
        adapted,
        steps: Vec::with_capacity(order.len() + 1),
        merged: vec![None; 0],
        traces: Vec::new(),
        notes: Vec::new(),
    };
    builder.merged.resize(builder.adapted.ops.len(), None);
    builder.traces.resize(builder.adapted.stores.len(), Trace::default());
    for op in order {
        builder.op(*op);
    }
    builder.steps.push(Step::Export);
    let Builder { steps, merged, notes, .. } = builder;
    adapted.notes.extend(notes);
    Scoped { steps, merged }
}

struct Builder<'a> {
    frame: &'a Frame,
    adapted: &'a Adapted,
    steps: Vec<Step>,
    merged: Vec<Option<String>>,
    /// For each store what is known of it.
    traces: Vec<Trace>,
    notes: Vec<Note>,
}

/// What steps did to a store so far; steps are indices into [`Builder::steps`].
#[derive(Debug, Clone, Copy, Default)]
struct Trace {
    /// The last step that used it.
    used: Option<usize>,
    /// The last step that wrote it.
    written: Option<usize>,
    /// The last scope that wrote it as an attachment.
    drawn: Option<usize>,
    /// In what ways the last step that used it did.
    ways: Ways,
}

/// Ways in which the passes of one scope use a store.
#[derive(Debug, Clone, Copy, Default)]
struct Ways {
    attached: bool,
    sampled: bool,
    stored: bool,
    /// Whether a shader writes it.
    shaded: bool,
}

impl Ways {
    /// Whether a use can't be in one scope with these.
    fn clash(self, role: &Role) -> bool {
        let Ways { attached, sampled, stored, shaded } = self;
        let others = if matches!(role, Role::Sampled { .. }) { stored } else { sampled };
        match role.is_attachment() {
            true => sampled || stored,
            false => attached || shaded || others || (role.writes() && (sampled || stored)),
        }
    }

    fn add(&mut self, role: &Role) {
        self.attached |= role.is_attachment();
        self.sampled |= matches!(role, Role::Sampled { .. });
        self.stored |= matches!(role, Role::Storage { .. });
        self.shaded |= !role.is_attachment() && role.writes();
    }
}

impl Builder<'_> {
    fn op(&mut self, op: u32) {
        match self.adapted.ops[op as usize].kind {
            OpKind::Draw(_) | OpKind::ForwardDraw { .. } => self.draw(op),
            OpKind::Resolve { .. } => match self.fold(op) {
                Ok(()) => {}
                Err(why) => {
                    let subject = self.adapted.stores[self.adapted.uses(op)[0].store as usize].name.clone();
                    let text = format!("is resolved by a step of its own: {why}");
                    self.notes.push(Note { stage: Stage::Scope, subject, text, at: None });
                    self.single(op);
                }
            },
            OpKind::Copy { .. } | OpKind::Dispatch(_) => self.single(op),
        }
    }

    fn single(&mut self, op: u32) {
        self.steps.push(Step::Single(op));
        self.trace(op, self.steps.len() - 1);
    }

    /// Notes what step number `at` does by this operation.
    fn trace(&mut self, op: u32, at: usize) {
        for used in self.adapted.uses(op) {
            let trace = &mut self.traces[used.store as usize];
            if trace.used != Some(at) {
                trace.ways = Ways::default();
            }
            trace.ways.add(&used.role);
            trace.used = trace.used.max(Some(at));
            if used.role.writes() {
                trace.written = trace.written.max(Some(at));
                trace.drawn = if used.role.is_attachment() { Some(at) } else { trace.drawn };
            }
        }
    }

    fn draw(&mut self, op: u32) {
        let adapted = self.adapted;
        let uses = adapted.uses(op);
        let neighbour = match self.steps.last() {
            Some(Step::Scope(scope)) => Some(scope.compare(adapted, uses, |used| {
                let trace = &self.traces[used.store as usize];
                trace.used == Some(self.steps.len() - 1) && trace.ways.clash(&used.role)
            })),
            _ => None,
        };
        match neighbour {
            Some(Meeting::Merge) => {
                let text = self.gain(uses);
                let Some(Step::Scope(scope)) = self.steps.last_mut() else { return };
                scope.depth = scope.depth.or_else(|| depth_of(uses));
                scope.ops.push(op);
                self.merged[op as usize] = Some(text);
            }
            Some(Meeting::Apart(why)) => {
                if let Some(why) = why {
                    self.refuse(op, why);
                }
                self.open(op);
            }
            None => self.open(op),
        }
        self.trace(op, self.steps.len() - 1);
    }

    fn open(&mut self, op: u32) {
        let uses = self.adapted.uses(op);
        let color = colors_of(uses);
        let resolves = vec![None; color.len()];
        self.steps.push(Step::Scope(Scope {
            color,
            depth: depth_of(uses),
            ops: vec![op],
            resolves,
            depth_resolve: None,
        }));
    }

    /// Why sharing a scope pays.
    fn gain(&self, uses: &[Use]) -> String {
        let Some(Step::Scope(scope)) = self.steps.last() else { return String::new() };
        let before = scope.ops.last().and_then(|op| op_name(self.frame, self.adapted, *op));
        let shared: Vec<&Use> =
            uses.iter().filter(|used| scope.color.contains(&used.store) || scope.depth == Some(used.store)).collect();
        let bytes: u64 = shared
            .iter()
            .map(|used| {
                let descriptor = &self.adapted.stores[used.store as usize].descriptor;
                let texels = descriptor.extent.iter().fold(1_u64, |area, side| area.saturating_mul(u64::from(*side)));
                texels.saturating_mul(descriptor.format.texel_bytes()).saturating_mul(u64::from(descriptor.samples))
            })
            .fold(0, u64::saturating_add);
        let names: Vec<String> =
            shared.iter().map(|used| format!("`{}`", self.adapted.stores[used.store as usize].name)).collect();
        let before = before.map_or("", |name| name);
        let mebibytes = bytes as f64 / f64::from(1 << 20);
        format!(
            "draws into {} like `{before}`: {mebibytes:.1} MiB need neither be stored nor loaded",
            names.join(" and ")
        )
    }

    fn refuse(&mut self, op: u32, why: Refusal) {
        let Some(name) = op_name(self.frame, self.adapted, op) else { return };
        let store = |store: StoreIndex| &self.adapted.stores[store as usize].name;
        let why = match why {
            Refusal::OtherAttachments => "its attachments are not the same".to_owned(),
            Refusal::Clears(image) => format!("it starts by clearing `{}`", store(image)),
            Refusal::Uses(image) => format!("it uses `{}`, which the scope before it writes", store(image)),
            Refusal::Writes(image) => format!("it writes `{}`, which the scope before it uses", store(image)),
            Refusal::Resolved(image) => format!("the scope before it ends with the resolve of `{}`", store(image)),
        };
        let OpKind::Draw(pass) = self.adapted.ops[op as usize].kind else { return };
        self.notes.push(Note {
            stage: Stage::Scope,
            subject: name.clone(),
            text: format!("opens a rendering scope of its own: {why}"),
            at: self.frame.sources.place(self.frame.passes[pass as usize].span),
        });
    }

    /// Lets the scope that wrote the source last carry the resolve, or says why it can't.
    fn fold(&mut self, op: u32) -> Result<(), &'static str> {
        let [source, target] = self.adapted.uses(op) else { return Err("it is no resolve from image to image") };
        let (source, target) = (source.store, target.store);
        let descriptor = &self.adapted.stores[source as usize].descriptor;
        if (descriptor.mips, descriptor.layers) != (1, 1) {
            return Err("it has several mip levels or layers");
        }
        let Trace { drawn, written, .. } = self.traces[source as usize];
        let Some(at) = drawn else { return Err("no rendering scope drew it") };
        if written != drawn || self.traces[target as usize].used >= drawn {
            return Err("its target is in use since it was drawn, or it was written by other means");
        }
        let Step::Scope(scope) = &mut self.steps[at] else { return Err("no rendering scope drew it") };
        match scope.resolve_of(source) {
            Some(slot @ None) => *slot = Some(op),
            _ => return Err("the scope that drew it resolves it into another image"),
        }
        let trace = &mut self.traces[target as usize];
        (trace.used, trace.written) = (Some(at), Some(at));
        Ok(())
    }
}

impl Step {
    /// The operations that it runs, without folded resolves.
    pub(super) fn ops(&self) -> &[u32] {
        match self {
            Step::Scope(scope) => &scope.ops,
            Step::Single(op) => std::slice::from_ref(op),
            Step::Export => &[],
        }
    }
}

/// What comes of a scope and the pass after it.
enum Meeting {
    Merge,
    Apart(Option<Refusal>),
}

/// Why they stay apart.
enum Refusal {
    OtherAttachments,
    Clears(StoreIndex),
    Uses(StoreIndex),
    Writes(StoreIndex),
    Resolved(StoreIndex),
}

impl Scope {
    fn compare(&self, adapted: &Adapted, uses: &[Use], clashes: impl Fn(&Use) -> bool) -> Meeting {
        let attached = |store: StoreIndex| self.color.contains(&store) || self.depth == Some(store);
        let shares = uses.iter().any(|used| used.role.is_attachment() && attached(used.store));
        let refuse = |why| Meeting::Apart(Some(why));
        if let Some(used) = uses.iter().find(|used| !used.role.is_attachment() && attached(used.store)) {
            return refuse(Refusal::Uses(used.store));
        }
        if let Some(store) = self.carried(adapted).find(|store| uses.iter().any(|used| used.store == *store)) {
            return refuse(Refusal::Uses(store));
        }
        if !shares {
            return Meeting::Apart(None);
        }
        let same_depth = match (self.depth, depth_of(uses)) {
            (Some(a), Some(b)) => a == b,
            _ => true,
        };
        let color = colors_of(uses);
        if color != self.color || !same_depth || !self.same_area(adapted, uses) {
            return refuse(Refusal::OtherAttachments);
        }
        for used in uses {
            let starts_over = match used.role {
                Role::Color { start, .. } | Role::Depth { start, .. } => start != Start::Keep,
                _ => false,
            };
            if starts_over && attached(used.store) {
                return refuse(Refusal::Clears(used.store));
            }
            if clashes(used) {
                return refuse(if used.role.writes() {
                    Refusal::Writes(used.store)
                } else {
                    Refusal::Uses(used.store)
                });
            }
        }
        match self.carries().next() {
            Some(op) => refuse(Refusal::Resolved(adapted.uses(op)[0].store)),
            None => Meeting::Merge,
        }
    }

    /// The resolve operations that it carries.
    pub(super) fn carries(&self) -> impl Iterator<Item = u32> + '_ {
        self.resolves.iter().chain([&self.depth_resolve]).flatten().copied()
    }

    /// Where the resolve of an attachment is noted.
    fn resolve_of(&mut self, attachment: StoreIndex) -> Option<&mut Option<u32>> {
        match self.color.iter().position(|color| *color == attachment) {
            Some(location) => self.resolves.get_mut(location),
            None => Some(&mut self.depth_resolve).filter(|_| self.depth == Some(attachment)),
        }
    }

    /// Targets of the resolves that it carries.
    fn carried<'a>(&'a self, adapted: &'a Adapted) -> impl Iterator<Item = StoreIndex> + 'a {
        self.carries().filter_map(|op| adapted.uses(op).get(1)).map(|target| target.store)
    }

    fn same_area(&self, adapted: &Adapted, uses: &[Use]) -> bool {
        let shape = |store: StoreIndex| {
            let descriptor = &adapted.stores[store as usize].descriptor;
            (descriptor.extent, descriptor.samples)
        };
        let first = self.color.first().copied().or(self.depth);
        first.is_none_or(|first| {
            uses.iter().filter(|used| used.role.is_attachment()).all(|used| shape(used.store) == shape(first))
        })
    }
}

fn colors_of(uses: &[Use]) -> Vec<StoreIndex> {
    uses.iter().filter(|used| matches!(used.role, Role::Color { .. })).map(|used| used.store).collect()
}

fn depth_of(uses: &[Use]) -> Option<StoreIndex> {
    uses.iter().find(|used| matches!(used.role, Role::Depth { .. })).map(|used| used.store)
}
