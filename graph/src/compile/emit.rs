//! Puts what the stages decided into a [`Plan`].

use super::cull::Live;
use super::model::{Adapted, Op, OpKind, Role, Samples, StoreIndex, Use};
use super::place::Placed;
use super::retain::{EXPORTED, Need, Retained};
use super::scope::{Scope, Scoped, Step as Grouped, op_name};
use super::synchronise::Barriers;
use crate::device::Profile;
use crate::frame::{Blend, DepthTarget, Draw, Frame, Work as FrameWork};
use crate::plan::{
    Access, Attachment, AttachmentResolve, Binding, BindingKind, Cause, DepthState, DeviceUsed, FORMAT_VERSION, Image,
    ImageId, Note, Param, Pass, Plan, Queue, RenderScope, Resource, Role as ImageRole, SettingUsed, Side, Stage, Step,
    Totals, Transfer, Work,
};
use crate::vocabulary::{Accesses, Layout, LoadOp, Stages, State, StoreOp};
use std::sync::Arc;

/// What the stages decided.
pub(super) struct Parts<'a> {
    pub(super) frame: &'a Frame,
    pub(super) device: &'a Profile,
    pub(super) live: Live,
    pub(super) samples: Samples,
    pub(super) adapted: Adapted,
    pub(super) scoped: Scoped,
    pub(super) retained: Retained,
    pub(super) placed: Placed,
    pub(super) barriers: Barriers,
}

/// The shader that draws one image into another.
const COPY_SHADER: &str = "copy";
/// The name by which it knows its source.
const COPY_SOURCE: &str = "source";

pub(super) fn emit(parts: Parts<'_>, exact_memory: bool) -> Plan {
    let emitter = Emitter { parts: &parts };
    let works: Vec<Work> = parts.scoped.steps.iter().zip(0_u32..).map(|(step, at)| emitter.work(step, at)).collect();
    let images = emitter.images();
    let notes = emitter.notes();
    let outputs = parts.adapted.outputs.iter().map(|store| Resource::Image(ImageId(*store))).collect();
    let settings = parts.frame.settings.iter();
    let steps: Vec<Step> = works
        .into_iter()
        .zip(parts.barriers.image)
        .zip(parts.barriers.memory)
        .map(|((work, image_barriers), memory)| Step {
            queue: Queue::Graphics,
            waits: Vec::new(),
            memory_barriers: memory.into_iter().collect(),
            image_barriers,
            work,
            releases: Vec::new(),
        })
        .collect();
    let totals = Totals {
        transient_bytes: parts.placed.transient_bytes,
        placed_bytes: parts.placed.heaps.iter().map(|heap| heap.bytes).sum(),
        live_peak_bytes: parts.placed.live_peak_bytes,
        kept_bytes: parts.placed.output_bytes,
        ..Totals::count(&steps)
    };
    Plan {
        format_version: FORMAT_VERSION,
        device: DeviceUsed { name: parts.device.name.clone(), exact_memory },
        settings: settings.map(|(name, value)| SettingUsed { name: name.clone(), value: value.clone() }).collect(),
        images,
        buffers: Vec::new(),
        heaps: parts.placed.heaps,
        steps,
        outputs,
        notes,
        totals,
    }
}

struct Emitter<'a> {
    parts: &'a Parts<'a>,
}

impl Emitter<'_> {
    fn images(&self) -> Vec<Image> {
        let parts = self.parts;
        let (stages, accesses, layout) = EXPORTED;
        parts
            .adapted
            .stores
            .iter()
            .zip(&parts.placed.placements)
            .zip(0_u32..)
            .map(|((store, placement), id)| Image {
                id: ImageId(id),
                name: store.name.clone(),
                cause: store.cause.clone(),
                format: store.descriptor.format,
                shape: store.descriptor.shape,
                extent: store.descriptor.extent,
                mips: store.descriptor.mips,
                layers: store.descriptor.layers,
                samples: store.descriptor.samples,
                usage: store.descriptor.usage,
                sharing: store.descriptor.sharing,
                role: match placement {
                    Some(placement) => ImageRole::Transient(placement.clone()),
                    None => ImageRole::External {
                        before: State { stages, accesses: Accesses::empty(), layout: Layout::Undefined },
                        after: State { stages, accesses, layout },
                    },
                },
            })
            .collect()
    }

    fn notes(&self) -> Vec<Note> {
        let parts = self.parts;
        let frame = parts.frame;
        let off = frame.switched_off.iter().map(|off| Note {
            stage: Stage::Expand,
            subject: off.name.clone(),
            text: format!("is off: {}", off.because),
            at: frame.sources.place(off.span),
        });
        let culled = parts.live.culled.iter().map(|pass| &frame.passes[*pass as usize]).map(|pass| Note {
            stage: Stage::Cull,
            subject: pass.name.clone(),
            text: "does not run: no output needs what it writes".to_owned(),
            at: frame.sources.place(pass.span),
        });
        off.chain(culled)
            .chain(parts.samples.notes.iter().cloned())
            .chain(parts.adapted.notes.iter().cloned())
            .collect()
    }

    fn work(&self, step: &Grouped, at: u32) -> Work {
        match step {
            Grouped::Scope(scope) => Work::Render(self.scope(scope, at)),
            Grouped::Export => Work::Export,
            Grouped::Single(op) => {
                let Op { kind, .. } = &self.parts.adapted.ops[*op as usize];
                match kind {
                    OpKind::Resolve { .. } => Work::Resolve(self.transfer(*op)),
                    OpKind::Copy { .. } => Work::Copy(self.transfer(*op)),
                    OpKind::Dispatch(_) | OpKind::Draw(_) | OpKind::ForwardDraw { .. } => {
                        Work::Dispatch(self.pass(*op, at, None))
                    }
                }
            }
        }
    }

    fn inserted(&self, op: u32) -> Cause {
        match &self.parts.adapted.ops[op as usize].kind {
            OpKind::Resolve { because, at, .. } | OpKind::Copy { because, at } => {
                Cause::Inserted { because: because.clone(), at: at.clone() }
            }
            OpKind::ForwardDraw { pass, because, .. } => Cause::Inserted {
                because: because.clone(),
                at: self.parts.frame.sources.place(self.parts.frame.passes[*pass as usize].span),
            },
            OpKind::Draw(pass) | OpKind::Dispatch(pass) => {
                Cause::Written(self.parts.frame.sources.place(self.parts.frame.passes[*pass as usize].span))
            }
        }
    }

    fn transfer(&self, op: u32) -> Transfer {
        let uses = self.parts.adapted.uses(op);
        let side = |at: usize, layout| {
            let store = uses[at].store;
            let held = &self.parts.adapted.stores[store as usize];
            Side::Image { image: ImageId(store), range: held.range(), extent: held.descriptor.extent, layout }
        };
        Transfer {
            name: None,
            cause: self.inserted(op),
            source: side(0, Layout::TransferSrcOptimal),
            target: side(1, Layout::TransferDstOptimal),
            filter: None,
        }
    }

    fn scope(&self, scope: &Scope, at: u32) -> RenderScope {
        let first = scope.color.first().copied().or(scope.depth);
        let (extent, layers, samples) = first.map_or(([1, 1], 1, 1), |store| {
            let descriptor = &self.parts.adapted.stores[store as usize].descriptor;
            ([descriptor.extent[0], descriptor.extent[1]], descriptor.layers, descriptor.samples)
        });
        let attach = |store: StoreIndex, resolve: Option<u32>| {
            let attachment = self.attachment(store, at)?;
            Some(Attachment { resolve: resolve.and_then(|op| self.attachment_resolve(op, at)), ..attachment })
        };
        let color = scope.color.iter().zip(&scope.resolves).filter_map(|(store, resolve)| attach(*store, *resolve));
        RenderScope {
            extent,
            layers,
            samples,
            color: color.collect(),
            depth: scope.depth.and_then(|store| attach(store, scope.depth_resolve)),
            stencil: None,
            passes: scope.ops.iter().map(|op| self.pass(*op, at, Some(scope))).collect(),
        }
    }

    fn attachment_resolve(&self, op: u32, at: u32) -> Option<AttachmentResolve> {
        let OpKind::Resolve { mode, .. } = self.parts.adapted.ops[op as usize].kind else { return None };
        let target = self.parts.adapted.uses(op)[1].store;
        Some(AttachmentResolve {
            image: ImageId(target),
            range: self.parts.adapted.stores[target as usize].range(),
            layout: self.parts.retained.at(target, at)?.layout,
            mode,
            cause: self.inserted(op),
        })
    }

    fn attachment(&self, store: StoreIndex, at: u32) -> Option<Attachment> {
        let need = self.parts.retained.at(store, at)?;
        let ops = need.attachment?;
        Some(Attachment {
            image: ImageId(store),
            range: self.parts.adapted.stores[store as usize].range(),
            layout: need.layout,
            load: ops.load,
            store: ops.store,
            clear: ops.clear,
            resolve: None,
            because: format!("{}; {}", self.load_reason(need, ops.load), self.store_reason(need, ops.store)),
        })
    }

    fn load_reason(&self, need: &Need, load: LoadOp) -> String {
        let name = need.op.and_then(|op| op_name(self.parts.frame, &self.parts.adapted, op));
        let name = name.map_or("", |name| name);
        match load {
            LoadOp::Clear => format!("`{name}` clears it"),
            LoadOp::Load => format!("`{name}` continues on what is there"),
            LoadOp::DontCare => format!("`{name}` covers every pixel"),
        }
    }

    fn store_reason(&self, need: &Need, store: StoreOp) -> String {
        let next = self.parts.retained.after(need.store, need.step);
        let words = next.map(|next| match &self.parts.scoped.steps[next.step as usize] {
            Grouped::Export => "it is an output".to_owned(),
            _ => match next.op.and_then(|op| op_name(self.parts.frame, &self.parts.adapted, op)) {
                Some(name) => format!("`{name}` uses it next"),
                None => format!("step {} reads it", next.step),
            },
        });
        match (store, words) {
            (StoreOp::Store, Some(words)) => words,
            (StoreOp::None, Some(words)) => format!("only tested here, and {words}"),
            (StoreOp::None, None) => "only tested here".to_owned(),
            (StoreOp::DontCare, Some(_)) => "what comes next starts afresh".to_owned(),
            (StoreOp::DontCare | StoreOp::Store, None) => "nobody needs it afterwards".to_owned(),
        }
    }

    fn pass(&self, op: u32, at: u32, scope: Option<&Scope>) -> Pass {
        let parts = self.parts;
        let uses = parts.adapted.uses(op);
        let merged = parts.scoped.merged[op as usize].clone();
        let cause = self.inserted(op);
        let colors = scope.map_or(0, |scope| scope.color.len());
        let number = match &parts.adapted.ops[op as usize].kind {
            OpKind::Draw(pass) | OpKind::Dispatch(pass) | OpKind::ForwardDraw { pass, .. } => *pass,
            OpKind::Resolve { .. } | OpKind::Copy { .. } => 0,
        };
        let pass = &parts.frame.passes[number as usize];
        let (draw, groups, shader) = match &pass.work {
            FrameWork::Draw { draw, shader, .. } => (Some(*draw), None, shader.clone()),
            FrameWork::Dispatch { shader, groups } => (None, Some(*groups), shader.clone()),
            FrameWork::Forward { .. } => (Some(Draw::FullScreen), None, COPY_SHADER.into()),
            FrameWork::Copy | FrameWork::Blit { .. } | FrameWork::Fill { .. } => (None, None, "".into()),
            FrameWork::Custom { callback } => (None, None, callback.clone()),
        };
        let mut planned = Pass {
            name: pass.name.clone(),
            cause,
            draw,
            groups,
            shader,
            blend: vec![Blend::Replace; colors],
            depth: None,
            stencil: None,
            params: Vec::new(),
            accesses: Vec::with_capacity(uses.len()),
            buffers: Vec::new(),
            local_barrier: false,
            merged,
        };
        if let OpKind::ForwardDraw { filter, .. } = parts.adapted.ops[op as usize].kind {
            let binding = Binding { name: COPY_SOURCE.into(), kind: BindingKind::Sampled(filter) };
            let sampled = uses.iter().map(|used| matches!(used.role, Role::Sampled { .. }).then(|| binding.clone()));
            planned.accesses =
                uses.iter().zip(sampled).filter_map(|(used, binding)| self.access(used, at, binding)).collect();
            return planned;
        }
        for (blend, target) in planned.blend.iter_mut().zip(&pass.color) {
            *blend = target.blend;
        }
        planned.depth =
            pass.depth.as_ref().map(|DepthTarget { test, write, .. }| DepthState { test: *test, write: *write });
        for used in uses {
            let binding = match used.role {
                Role::Sampled { entry, .. } => {
                    let sampled = &pass.sampled[entry as usize];
                    Some(Binding { name: sampled.binding.clone(), kind: BindingKind::Sampled(sampled.filter) })
                }
                Role::Storage { entry, .. } => {
                    let name = pass.storage[entry as usize].binding.clone();
                    Some(Binding { name, kind: BindingKind::Storage })
                }
                Role::Color { .. } | Role::Depth { .. } | Role::Source | Role::Target => None,
            };
            planned.accesses.extend(self.access(used, at, binding));
        }
        planned.params = pass.params.iter().map(|(name, value)| Param { name: name.clone(), value: *value }).collect();
        planned
    }

    /// One access of a pass; load, store and resolve operations are the scope's.
    fn access(&self, used: &Use, at: u32, binding: Option<Binding>) -> Option<Access> {
        let need = self.parts.retained.at(used.store, at)?;
        let (stages, accesses) = match used.role {
            Role::Sampled { stages, .. } => (stages, Accesses::SHADER_SAMPLED_READ),
            Role::Storage { stages, read, write, .. } => {
                let reads = if read { Accesses::SHADER_STORAGE_READ } else { Accesses::empty() };
                (stages, if write { reads | Accesses::SHADER_STORAGE_WRITE } else { reads })
            }
            Role::Color { blends, .. } => {
                let reads = if blends { Accesses::COLOR_ATTACHMENT_READ } else { Accesses::empty() };
                (Stages::COLOR_ATTACHMENT_OUTPUT, reads | Accesses::COLOR_ATTACHMENT_WRITE)
            }
            Role::Depth { write, .. } => {
                let writes = if write { Accesses::DEPTH_STENCIL_ATTACHMENT_WRITE } else { Accesses::empty() };
                let stages = Stages::EARLY_FRAGMENT_TESTS | Stages::LATE_FRAGMENT_TESTS;
                (stages, Accesses::DEPTH_STENCIL_ATTACHMENT_READ | writes)
            }
            Role::Source | Role::Target => return None,
        };
        let range = self.parts.adapted.stores[used.store as usize].range();
        Some(Access { image: ImageId(used.store), range, stages, accesses, layout: need.layout, binding })
    }
}
