//! `retain`: what each step needs of each image, and from that the load and store operations: contents are kept only
//! where somebody needs them.

use super::Options;
use super::model::{Adapted, OpKind, Role, Start, StoreIndex, Use};
use super::scope::{Scope, Scoped, Step};
use crate::vocabulary::{Accesses, Layout, LoadOp, Stages, StoreOp, Usage};

/// Everything that one step does with one image.
#[derive(Debug, Clone, Copy)]
pub(super) struct Need {
    pub(super) store: StoreIndex,
    pub(super) step: u32,
    /// The first operation of the step that uses it, unless that is a resolve that the scope carries.
    pub(super) op: Option<u32>,
    pub(super) stages: Stages,
    pub(super) accesses: Accesses,
    pub(super) layout: Layout,
    /// Whether it needs what was there before.
    pub(super) keeps: bool,
    /// Load and store operations, if it is an attachment.
    pub(super) attachment: Option<AttachmentOps>,
}

/// Load and store operations of an attachment.
#[derive(Debug, Clone, Copy)]
pub(super) struct AttachmentOps {
    pub(super) load: LoadOp,
    pub(super) store: StoreOp,
    pub(super) clear: Option<[f32; 4]>,
    /// Whether a pass of the scope writes it.
    written: bool,
}

/// All needs, image by image, each in execution order.
#[derive(Debug)]
pub(super) struct Retained {
    needs: Vec<Need>,
    starts: Vec<u32>,
}

impl Retained {
    /// The needs of one image.
    pub(super) fn of(&self, store: StoreIndex) -> &[Need] {
        &self.needs[self.starts[store as usize] as usize..self.starts[store as usize + 1] as usize]
    }

    /// What step number `step` needs of an image.
    pub(super) fn at(&self, store: StoreIndex, step: u32) -> Option<&Need> {
        let needs = self.of(store);
        needs.binary_search_by_key(&step, |need| need.step).ok().map(|at| &needs[at])
    }

    /// The need after that of step number `step`.
    pub(super) fn after(&self, store: StoreIndex, step: u32) -> Option<&Need> {
        let needs = self.of(store);
        needs.get(needs.partition_point(|need| need.step <= step))
    }
}

/// The state that outputs are left in: a copy to the host comes next.
pub(super) const EXPORTED: (Stages, Accesses, Layout) =
    (Stages::COPY, Accesses::TRANSFER_READ, Layout::TransferSrcOptimal);

pub(super) fn retain(adapted: &mut Adapted, scoped: &Scoped, options: &Options) -> Retained {
    note_usage(adapted, scoped);
    let in_step_order = gather(adapted, scoped);
    let mut retained = by_store(&in_step_order, adapted.stores.len());
    for store in 0..adapted.stores.len() {
        let range = retained.starts[store] as usize..retained.starts[store + 1] as usize;
        decide_store_ops(&mut retained.needs[range]);
    }
    note_purpose(adapted, &retained, options);
    retained
}

/// Needs in the order of steps.
struct Gathered {
    needs: Vec<Need>,
    /// For each store where its last need stands.
    last: Vec<u32>,
}

fn gather(adapted: &Adapted, scoped: &Scoped) -> Vec<Need> {
    let mut gathered =
        Gathered { needs: Vec::with_capacity(adapted.uses.len()), last: vec![u32::MAX; adapted.stores.len()] };
    for (step, number) in scoped.steps.iter().zip(0_u32..) {
        match step {
            Step::Scope(scope) => gather_scope(adapted, scope, number, &mut gathered),
            Step::Single(op) => {
                let resolves = matches!(adapted.ops[*op as usize].kind, OpKind::Resolve { .. });
                let stage = if resolves { Stages::RESOLVE } else { Stages::COPY };
                for used in adapted.uses(*op) {
                    gathered.add(Need { op: Some(*op), ..need(adapted, used, number, stage) });
                }
            }
            Step::Export => gathered.needs.extend(adapted.outputs.iter().map(|store| {
                let (stages, accesses, layout) = EXPORTED;
                Need { store: *store, step: number, op: None, stages, accesses, layout, keeps: true, attachment: None }
            })),
        }
    }
    gathered.needs
}

fn gather_scope(adapted: &Adapted, scope: &Scope, step: u32, gathered: &mut Gathered) {
    let first = gathered.needs.len();
    for op in &scope.ops {
        for used in adapted.uses(*op) {
            gathered.add(Need { op: Some(*op), ..need(adapted, used, step, Stages::COPY) });
        }
    }
    for op in scope.carries() {
        let [source, target] = adapted.uses(op) else { continue };
        let stages = Stages::COLOR_ATTACHMENT_OUTPUT;
        let layout = match adapted.stores[target.store as usize].descriptor.format.is_depth() {
            true => Layout::DepthStencilAttachmentOptimal,
            false => Layout::ColorAttachmentOptimal,
        };
        let attach =
            |store, accesses| Need { store, step, op: None, stages, accesses, layout, keeps: false, attachment: None };
        gathered.add(attach(source.store, Accesses::COLOR_ATTACHMENT_READ));
        gathered.add(attach(target.store, Accesses::COLOR_ATTACHMENT_WRITE));
    }
    for need in &mut gathered.needs[first..] {
        let Some(ops) = &mut need.attachment else { continue };
        if scope.depth == Some(need.store) && !ops.written {
            need.layout = Layout::DepthStencilReadOnlyOptimal;
        }
        let (stage, read, write) = load_access(scope.depth == Some(need.store));
        need.stages |= stage;
        need.accesses |= if ops.load == LoadOp::Load { read } else { write };
    }
}

/// Stage and accesses of load operations.
fn load_access(depth: bool) -> (Stages, Accesses, Accesses) {
    if depth {
        (
            Stages::EARLY_FRAGMENT_TESTS,
            Accesses::DEPTH_STENCIL_ATTACHMENT_READ,
            Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE,
        )
    } else {
        (Stages::COLOR_ATTACHMENT_OUTPUT, Accesses::COLOR_ATTACHMENT_READ, Accesses::COLOR_ATTACHMENT_WRITE)
    }
}

impl Gathered {
    /// Joins what one step needs of one image in several ways. The first use says what is kept.
    fn add(&mut self, new: Need) {
        let last = &mut self.last[new.store as usize];
        let Some(old) = self.needs.get_mut(*last as usize).filter(|old| old.step == new.step) else {
            *last = self.needs.len() as u32;
            return self.needs.push(new);
        };
        old.stages |= new.stages;
        old.accesses |= new.accesses;
        old.attachment = match (old.attachment, new.attachment) {
            (Some(a), Some(b)) => Some(AttachmentOps { written: a.written || b.written, ..a }),
            (a, b) => a.or(b),
        };
        if old.layout != new.layout {
            let depth =
                |layout| matches!(layout, Layout::DepthStencilReadOnlyOptimal | Layout::DepthStencilAttachmentOptimal);
            old.layout = if depth(old.layout) && depth(new.layout) {
                Layout::DepthStencilReadOnlyOptimal
            } else {
                Layout::General
            };
        }
    }
}

fn need(adapted: &Adapted, used: &Use, step: u32, transfer: Stages) -> Need {
    let attached_depth = adapted.stores[used.store as usize].descriptor.usage.contains(Usage::DEPTH_STENCIL_ATTACHMENT);
    let (stages, accesses, layout, attachment) = match used.role {
        Role::Sampled { stages, .. } => {
            let layout =
                if attached_depth { Layout::DepthStencilReadOnlyOptimal } else { Layout::ShaderReadOnlyOptimal };
            (stages, Accesses::SHADER_SAMPLED_READ, layout, None)
        }
        Role::Storage { stages, read, write, .. } => {
            let mut accesses = Accesses::empty();
            accesses.set(Accesses::SHADER_STORAGE_READ, read);
            accesses.set(Accesses::SHADER_STORAGE_WRITE, write);
            (stages, accesses, Layout::General, None)
        }
        Role::Color { start, blends, .. } => {
            let mut accesses = Accesses::COLOR_ATTACHMENT_WRITE;
            accesses.set(Accesses::COLOR_ATTACHMENT_READ, blends);
            let ops = attachment_ops(start, true);
            (Stages::COLOR_ATTACHMENT_OUTPUT, accesses, Layout::ColorAttachmentOptimal, Some(ops))
        }
        Role::Depth { start, write } => {
            let mut accesses = Accesses::DEPTH_STENCIL_ATTACHMENT_READ;
            accesses.set(Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE, write);
            let ops = attachment_ops(start, write || start != Start::Keep);
            let stages = Stages::EARLY_FRAGMENT_TESTS | Stages::LATE_FRAGMENT_TESTS;
            (stages, accesses, Layout::DepthStencilAttachmentOptimal, Some(ops))
        }
        Role::Source => (transfer, Accesses::TRANSFER_READ, Layout::TransferSrcOptimal, None),
        Role::Target => (transfer, Accesses::TRANSFER_WRITE, Layout::TransferDstOptimal, None),
    };
    Need { store: used.store, step, op: None, stages, accesses, layout, keeps: used.role.reads(), attachment }
}

fn attachment_ops(start: Start, written: bool) -> AttachmentOps {
    let (load, clear) = match start {
        Start::Clear(value) => (LoadOp::Clear, Some(value)),
        Start::Keep => (LoadOp::Load, None),
        Start::Discard => (LoadOp::DontCare, None),
    };
    AttachmentOps { load, store: StoreOp::None, clear, written }
}

/// Groups needs by image; the order within an image stays.
fn by_store(needs: &[Need], stores: usize) -> Retained {
    let mut starts = vec![0_u32; stores + 1];
    for need in needs {
        starts[need.store as usize + 1] += 1;
    }
    for store in 0..stores {
        starts[store + 1] += starts[store];
    }
    let mut next = starts.clone();
    let mut order = vec![0_u32; needs.len()];
    for (need, at) in needs.iter().zip(0_u32..) {
        let slot = &mut next[need.store as usize];
        order[*slot as usize] = at;
        *slot += 1;
    }
    Retained { needs: order.iter().map(|at| needs[*at as usize]).collect(), starts }
}

/// Keeps what a later step needs; what only was tested is left alone.
fn decide_store_ops(needs: &mut [Need]) {
    for at in 0..needs.len() {
        let needed = needs.get(at + 1).is_some_and(|next| next.keeps);
        let need = &mut needs[at];
        let Some(ops) = &mut need.attachment else { continue };
        ops.store = match (ops.written, needed) {
            (false, _) => StoreOp::None,
            (true, true) => StoreOp::Store,
            (true, false) => StoreOp::DontCare,
        };
        if ops.store != StoreOp::None {
            let depth = need.accesses.intersects(Accesses::DEPTH_STENCIL_ATTACHMENT_READ);
            need.stages |= if depth { Stages::LATE_FRAGMENT_TESTS } else { Stages::COLOR_ATTACHMENT_OUTPUT };
            need.accesses |=
                if depth { Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE } else { Accesses::COLOR_ATTACHMENT_WRITE };
        }
    }
}

/// Usage exactly as used.
fn note_usage(adapted: &mut Adapted, scoped: &Scoped) {
    let mut usage = vec![Usage::empty(); adapted.stores.len()];
    for step in &scoped.steps {
        let carried = match step {
            Step::Scope(scope) => Some(scope.carries()),
            Step::Single(_) | Step::Export => None,
        };
        for used in step.ops().iter().flat_map(|op| adapted.uses(*op)) {
            usage[used.store as usize] |= used.role.usage();
        }
        for used in carried.into_iter().flatten().flat_map(|op| adapted.uses(op)) {
            let depth = adapted.stores[used.store as usize].descriptor.format.is_depth();
            usage[used.store as usize] |= if depth { Usage::DEPTH_STENCIL_ATTACHMENT } else { Usage::COLOR_ATTACHMENT };
        }
    }
    for (store, usage) in adapted.stores.iter_mut().zip(usage) {
        store.descriptor.usage = usage;
    }
}

/// Usage that follows from an image's part in the frame: outputs are copied from; images that never leave their one scope
/// become transient attachments.
fn note_purpose(adapted: &mut Adapted, retained: &Retained, options: &Options) {
    let attachments_only = Usage::COLOR_ATTACHMENT | Usage::DEPTH_STENCIL_ATTACHMENT;
    let stays =
        |need: &Need| need.attachment.is_some_and(|ops| ops.load != LoadOp::Load && ops.store != StoreOp::Store);
    for (store, at) in adapted.stores.iter_mut().zip(0_u32..) {
        let needs = retained.of(at);
        let usage = &mut store.descriptor.usage;
        if store.output {
            *usage |= Usage::TRANSFER_SRC;
        } else if options.poison {
            *usage |= Usage::TRANSFER_DST;
        } else if needs.len() == 1 && needs.iter().all(stays) && attachments_only.contains(*usage) {
            *usage |= Usage::TRANSIENT_ATTACHMENT;
        }
    }
}
