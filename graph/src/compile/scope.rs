//! `scope`: neighbouring raster passes become one rendering scope where nothing forbids it and something gains; resolves
//! fold into the scope that wrote last.

mod gain;
mod local;
mod meeting;

use super::model::{Adapted, OpKind, Role, StoreIndex, Use};
use super::parts::Grids;
use crate::device::Profile;
use crate::frame::Frame;
use crate::plan::{Note, Stage, Subresources};
use gain::Gain;
use meeting::{Meeting, Refusal};
use std::sync::Arc;

pub(super) use meeting::same_areas;

/// Steps in execution order.
#[derive(Debug)]
pub(super) struct Scoped {
    pub(super) steps: Vec<Step>,
    /// What a pass gains that shares its scope with the pass before it, for each operation; empty if nothing is drawn.
    gains: Vec<Option<Gain>>,
}

impl Scoped {
    /// Why operation number `op` shares its scope with the one before it.
    pub(super) fn merged(&self, frame: &Frame, adapted: &Adapted, op: u32) -> Option<String> {
        Some(self.gains.get(op as usize)?.as_ref()?.words(frame, adapted))
    }
}

/// One step.
#[derive(Debug, PartialEq)]
pub(super) enum Step {
    /// A rendering scope.
    Scope(Box<Scope>),
    /// One operation that is not drawn.
    Single(u32),
    /// The promised state of what outlives the frame.
    Export,
}

/// An attachment: which part of which image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Target {
    pub(super) store: StoreIndex,
    pub(super) range: Subresources,
}

impl Target {
    pub(super) fn of(adapted: &Adapted, used: &Use) -> Target {
        Target { store: used.store, range: adapted.range(used) }
    }
}

/// A rendering scope.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Scope {
    /// Colour attachments by location.
    pub(super) color: Vec<Target>,
    pub(super) depth: Option<Target>,
    pub(super) stencil: Option<Target>,
    /// Operations that draw.
    pub(super) ops: Vec<u32>,
    /// For each colour attachment the resolve operation that it carries.
    pub(super) resolves: Vec<Option<u32>>,
    /// The resolve operation that the depth attachment carries.
    pub(super) depth_resolve: Option<u32>,
    /// Whether passes read at their own position what others drew: then each draws into some of the colour attachments.
    pub(super) local: bool,
}

/// The name of the pass that an operation is in the Plan.
pub(super) fn op_name<'f>(frame: &'f Frame, adapted: &'f Adapted, op: u32) -> Option<&'f Arc<str>> {
    match &adapted.ops[op as usize].kind {
        OpKind::DepthOnly { name, .. } | OpKind::ResolveDraw { name, .. } => Some(name),
        kind => kind.pass().map(|pass| &frame.passes[pass as usize].name),
    }
}

pub(super) fn scope(frame: &Frame, grids: &Grids, adapted: &mut Adapted, order: &[u32], device: &Profile) -> Scoped {
    if !adapted.ops.iter().any(|op| op.kind.draws()) {
        let mut steps = Vec::with_capacity(order.len() + 1);
        steps.extend(order.iter().map(|op| Step::Single(*op)));
        return Scoped { steps, gains: Vec::new() };
    }
    let mut builder = Builder {
        frame,
        grids,
        device,
        adapted,
        steps: Vec::with_capacity(order.len() + 1),
        gains: vec![None; adapted.ops.len()],
        traces: vec![Trace::default(); adapted.cells as usize],
        notes: Vec::new(),
        local: Vec::new(),
    };
    for op in order {
        builder.op(*op);
    }
    let Builder { steps, gains, notes, local, .. } = builder;
    adapted.notes.extend(notes);
    local::read_locally(adapted, &local);
    Scoped { steps, gains }
}

struct Builder<'a> {
    frame: &'a Frame,
    grids: &'a Grids,
    device: &'a Profile,
    adapted: &'a Adapted,
    steps: Vec<Step>,
    gains: Vec<Option<Gain>>,
    /// For each cell what is known of it.
    traces: Vec<Trace>,
    notes: Vec<Note>,
    /// Uses that read at their own position what their scope drew.
    local: Vec<u32>,
}

/// What steps did to a cell so far; steps are indices into [`Builder::steps`].
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

/// Ways in which the passes of one scope use a cell.
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
    fn clash(self, used: &Use) -> bool {
        let Ways { attached, sampled, stored, shaded } = self;
        let others = if used.role == Role::Sampled { stored } else { sampled };
        match used.role.is_attachment() {
            true => sampled || stored,
            false => attached || shaded || others || (used.writes && (sampled || stored)),
        }
    }

    fn add(&mut self, used: &Use) {
        self.attached |= used.role.is_attachment();
        self.sampled |= used.role == Role::Sampled;
        self.stored |= matches!(used.role, Role::Storage | Role::Buffer);
        self.shaded |= !used.role.is_attachment() && used.writes;
    }
}

impl Builder<'_> {
    fn op(&mut self, op: u32) {
        match &self.adapted.ops[op as usize].kind {
            draw if draw.draws() => self.draw(op),
            OpKind::Resolve { .. } => match self.fold(op) {
                Ok(()) => {}
                Err(why) => {
                    let subject = self.name(self.adapted.uses(op)[0].store).into();
                    let text = format!("is resolved by a step of its own: {why}");
                    self.notes.push(Note { stage: Stage::Scope, subject, text, at: None });
                    self.single(op);
                }
            },
            _ => self.single(op),
        }
    }

    fn single(&mut self, op: u32) {
        self.steps.push(Step::Single(op));
        self.trace(op, self.steps.len() - 1);
    }

    /// Notes what step number `at` does by this operation.
    fn trace(&mut self, op: u32, at: usize) {
        let Builder { adapted, grids, traces, local, .. } = self;
        let first = adapted.ops[op as usize].uses.start;
        for (used, number) in adapted.uses(op).iter().zip(first..) {
            // In a scope, whoever draws where another has read its own pixel waits for it behind a local barrier.
            if local.iter().rev().take(adapted.uses(op).len()).any(|local| *local == number) {
                continue;
            }
            adapted.for_each_cell(grids, used, |cell| {
                let trace = &mut traces[cell as usize];
                if trace.used != Some(at) {
                    trace.ways = Ways::default();
                }
                trace.ways.add(used);
                trace.used = trace.used.max(Some(at));
                if used.writes {
                    trace.written = trace.written.max(Some(at));
                    trace.drawn = if used.role.is_attachment() { Some(at) } else { trace.drawn };
                }
            });
        }
    }

    fn draw(&mut self, op: u32) {
        let adapted = self.adapted;
        let uses = adapted.uses(op);
        let wishes = local::wishes(self.frame, adapted, op);
        let reads_locally = |scope: &Scope, used: &Use| {
            wishes && self.device.local_read && local::possible(self.frame, adapted, op, used, &scope.color)
        };
        let neighbour = match self.steps.last() {
            Some(Step::Scope(scope)) => {
                let most = self.device.max_color_attachments as usize;
                let clashes = |used: &Use| {
                    let mut clashes = false;
                    adapted.for_each_cell(self.grids, used, |cell| {
                        let trace = &self.traces[cell as usize];
                        clashes |= trace.used == Some(self.steps.len() - 1) && trace.ways.clash(used);
                    });
                    clashes
                };
                Some(scope.compare(adapted, uses, most, |used| reads_locally(scope, used), clashes))
            }
            _ => None,
        };
        match neighbour {
            Some(Meeting::Merge) => {
                let first = adapted.ops[op as usize].uses.start;
                let Some(Step::Scope(scope)) = self.steps.last() else { return };
                let local: Vec<(u32, &Use)> =
                    (first..).zip(uses).filter(|(_, used)| reads_locally(scope, used)).collect();
                let gain = match local.first() {
                    Some((_, used)) => Gain::read_locally(adapted, used),
                    None => Gain::shared(adapted, scope, uses),
                };
                let reads_any = !local.is_empty();
                self.local.extend(local.into_iter().map(|(number, _)| number));
                let Some(Step::Scope(scope)) = self.steps.last_mut() else { return };
                scope.local |= reads_any;
                for color in colors_of(adapted, uses) {
                    if !scope.color.contains(&color) {
                        scope.color.push(color);
                        scope.resolves.push(None);
                    }
                }
                scope.depth = scope.depth.or_else(|| plane_of(adapted, uses, Role::Depth));
                scope.stencil = scope.stencil.or_else(|| plane_of(adapted, uses, Role::Stencil));
                scope.ops.push(op);
                self.gains[op as usize] = Some(gain);
                if wishes && !reads_any {
                    self.explain(op);
                }
            }
            Some(Meeting::Apart(why)) => {
                if let Some(why) = why {
                    self.refuse(op, why);
                }
                if wishes {
                    self.explain(op);
                }
                self.open(op);
            }
            None => {
                if wishes {
                    self.explain(op);
                }
                self.open(op);
            }
        }
        self.trace(op, self.steps.len() - 1);
    }

    fn open(&mut self, op: u32) {
        let (adapted, uses) = (self.adapted, self.adapted.uses(op));
        let color = colors_of(adapted, uses);
        let resolves = vec![None; color.len()];
        self.steps.push(Step::Scope(Box::new(Scope {
            color,
            depth: plane_of(adapted, uses, Role::Depth),
            stencil: plane_of(adapted, uses, Role::Stencil),
            ops: vec![op],
            resolves,
            depth_resolve: None,
            local: false,
        })));
    }

    fn name(&self, store: StoreIndex) -> &str {
        store_name(self.frame, self.adapted, store)
    }

    fn refuse(&mut self, op: u32, why: Refusal) {
        let Some(name) = op_name(self.frame, self.adapted, op) else { return };
        let store = |store: StoreIndex| self.name(store);
        let why = match why {
            Refusal::OtherAttachments => "its attachments are not the same".to_owned(),
            Refusal::Clears(image) => format!("it starts by clearing `{}`", store(image)),
            Refusal::Samples(image) => format!("it samples `{}`, which the scope before it writes", store(image)),
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
        let [source_store, target_store] = [source, target].map(|store| &self.adapted.stores[store as usize]);
        if source_store.grid(self.grids).is_some() || source_store.image().is_none_or(|image| image.layers > 1) {
            return Err("it has several layers");
        }
        let Trace { drawn, written, .. } = self.traces[source_store.first_cell as usize];
        let target_cell = target_store.first_cell as usize;
        let Some(at) = drawn else { return Err("no rendering scope drew it") };
        if written != drawn || self.traces[target_cell].used >= drawn {
            return Err("its target is in use since it was drawn, or it was written by other means");
        }
        let Step::Scope(scope) = &mut self.steps[at] else { return Err("no rendering scope drew it") };
        match scope.resolve_of(source) {
            Some(slot @ None) => *slot = Some(op),
            _ => return Err("the scope that drew it resolves it into another image"),
        }
        debug_assert_ne!(source, target);
        let trace = &mut self.traces[target_cell];
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

/// The name of a physical image or buffer.
pub(super) fn store_name<'n>(frame: &'n Frame, adapted: &'n Adapted, store: StoreIndex) -> &'n Arc<str> {
    let store = &adapted.stores[store as usize];
    store.renamed.as_ref().unwrap_or(match store.of {
        crate::frame::Resource::Image(image) => &frame.images[image.0 as usize].name,
        crate::frame::Resource::Buffer(buffer) => &frame.buffers[buffer.0 as usize].name,
    })
}

fn colors_of(adapted: &Adapted, uses: &[Use]) -> Vec<Target> {
    uses.iter().filter(|used| used.role == Role::Color).map(|used| Target::of(adapted, used)).collect()
}

fn plane_of(adapted: &Adapted, uses: &[Use], role: Role) -> Option<Target> {
    uses.iter().find(|used| used.role == role).map(|used| Target::of(adapted, used))
}
