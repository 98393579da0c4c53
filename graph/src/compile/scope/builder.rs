//! Groups operations, in execution order, into steps.

use super::can_join::Refusal;
use super::gain::Gain;
use super::local;
use super::step::{Scope, Step, colors_of, op_name, plane_of, resource_name};
use super::trace::{ScopeUse, Trace};
use crate::compile::model::{AdaptedFrame, OpKind, PhysicalIndex, Role, Use};
use crate::device::Profile;
use crate::frame::Frame;
use crate::plan::{Note, NoteKind};

pub(super) struct Builder<'a> {
    frame: &'a Frame,
    device: &'a Profile,
    adapted: &'a AdaptedFrame,
    pub(super) steps: Vec<Step>,
    pub(super) gains: Vec<Option<Gain>>,
    /// For each subresource what is known of it.
    traces: Vec<Trace>,
    pub(super) notes: Vec<Note>,
    /// Uses that read at their own position what their scope drew.
    pub(super) local: Vec<u32>,
}

impl<'a> Builder<'a> {
    pub(super) fn new(frame: &'a Frame, adapted: &'a AdaptedFrame, device: &'a Profile) -> Builder<'a> {
        Builder {
            frame,
            device,
            adapted,
            steps: Vec::with_capacity(adapted.ops.len() + 1),
            gains: vec![None; adapted.ops.len()],
            traces: vec![Trace::default(); adapted.subresources as usize],
            notes: Vec::new(),
            local: Vec::new(),
        }
    }

    pub(super) fn op(&mut self, op: u32) {
        match &self.adapted.ops[op as usize].kind {
            draw if draw.draws() => self.draw(op),
            OpKind::Resolve { .. } => match self.fold(op) {
                Ok(()) => {}
                Err(why) => {
                    let subject = self.name(self.adapted.uses(op)[0].resource).into();
                    let text = format!("is resolved by a step of its own: {why}");
                    self.notes.push(Note::new(NoteKind::ResolvedAlone, subject, text, None));
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
        let Builder { adapted, traces, local, .. } = self;
        let first = adapted.ops[op as usize].uses.start;
        for (used, number) in adapted.uses(op).iter().zip(first..) {
            // A local barrier orders later draws of the scope behind local reads.
            if local.iter().rev().take(adapted.uses(op).len()).any(|local| *local == number) {
                continue;
            }
            adapted.for_each_subresource(used, |subresource| {
                let trace = &mut traces[subresource as usize];
                if trace.used != Some(at) {
                    trace.ways = ScopeUse::default();
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
        let has_own_pixel_reads = local::has_own_pixel_reads(self.frame, adapted, op);
        let reads_locally = |scope: &Scope, used: &Use| {
            has_own_pixel_reads
                && self.device.local_read
                && local::possible(self.frame, adapted, op, used, &scope.color)
        };
        let custom = is_custom(self.frame, adapted, op);
        let joins = match self.steps.last() {
            Some(Step::Scope(scope)) => {
                let most = self.device.max_color_attachments as usize;
                let clashes = |used: &Use| {
                    let mut clashes = false;
                    adapted.for_each_subresource(used, |subresource| {
                        let trace = &self.traces[subresource as usize];
                        clashes |= trace.used == Some(self.steps.len() - 1) && trace.ways.clash(used);
                    });
                    clashes
                };
                scope.can_join(adapted, op, most, custom || scope.custom, |used| reads_locally(scope, used), clashes)
            }
            _ => Err(None),
        };
        match joins {
            Ok(()) => {
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
                scope.custom |= custom;
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
                if has_own_pixel_reads && !reads_any {
                    self.explain(op);
                }
            }
            Err(why) => {
                if let Some(why) = why {
                    self.refuse(op, why);
                }
                if has_own_pixel_reads {
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
            custom: is_custom(self.frame, adapted, op),
        })));
    }

    fn name(&self, resource: PhysicalIndex) -> &str {
        resource_name(self.frame, self.adapted, resource)
    }

    fn refuse(&mut self, op: u32, why: Refusal) {
        let Some(name) = op_name(self.frame, self.adapted, op) else { return };
        let resource = |resource: PhysicalIndex| self.name(resource);
        let why = match why {
            Refusal::OtherAttachments => "its attachments are not the same".to_owned(),
            Refusal::Clears(image) => format!("it starts by clearing `{}`", resource(image)),
            Refusal::Samples(image) => format!("it samples `{}`, which the scope before it writes", resource(image)),
            Refusal::Uses(image) => format!("it uses `{}`, which the scope before it writes", resource(image)),
            Refusal::Writes(image) => format!("it writes `{}`, which the scope before it uses", resource(image)),
            Refusal::Runs(cadence) => format!("the scope before it runs {cadence}"),
            Refusal::Resolved(image) => format!("the scope before it ends with the resolve of `{}`", resource(image)),
        };
        let OpKind::Draw(pass) = self.adapted.ops[op as usize].kind else { return };
        let text = format!("opens a rendering scope of its own: {why}");
        let at = self.frame.sources.place(self.frame.passes[pass as usize].span);
        self.notes.push(Note::new(NoteKind::OwnScope, name.clone(), text, at));
    }

    /// Lets the scope that wrote the source last take the resolve, or says why it can't.
    fn fold(&mut self, op: u32) -> Result<(), &'static str> {
        let [source, target] = self.adapted.uses(op) else { return Err("it is no resolve from image to image") };
        let (source, target) = (source.resource, target.resource);
        let [source_resource, target_resource] =
            [source, target].map(|resource| &self.adapted.resources[resource as usize]);
        if source_resource.grid.is_some() || source_resource.image().is_none_or(|image| image.layers > 1) {
            return Err("it has several layers");
        }
        let Trace { drawn, written, .. } = self.traces[source_resource.first_subresource as usize];
        let target_subresource = target_resource.first_subresource as usize;
        let Some(at) = drawn else { return Err("no rendering scope drew it") };
        if written != drawn || self.traces[target_subresource].used >= drawn {
            return Err("its target is in use since it was drawn, or it was written by other means");
        }
        let adapted = self.adapted;
        let Step::Scope(scope) = &mut self.steps[at] else { return Err("no rendering scope drew it") };
        if scope.ops.first().is_some_and(|first| adapted.cadence(*first) != adapted.cadence(op)) {
            return Err("the scope that drew it runs in other frames");
        }
        match scope.resolve_of(source) {
            Some(slot @ None) => *slot = Some(op),
            _ => return Err("the scope that drew it resolves it into another image"),
        }
        debug_assert_ne!(source, target);
        let trace = &mut self.traces[target_subresource];
        (trace.used, trace.written) = (Some(at), Some(at));
        Ok(())
    }

    /// Notes why a read at the fragment's own position goes through memory.
    fn explain(&mut self, op: u32) {
        let adapted = self.adapted;
        let uses = adapted.uses(op).iter();
        let mut own = uses.filter_map(|used| Some((used, local::own_pixel(self.frame, adapted, op, used)?)));
        let (Some((used, sampled)), Some(subject)) = (own.next(), op_name(self.frame, adapted, op)) else { return };
        let why = if let Some(why) = local::obstacle(adapted, sampled, used) {
            why.to_owned()
        } else if !self.device.local_read {
            format!("`{}` has no local reads", self.device.name)
        } else {
            "it doesn't share the scope that draws it".to_owned()
        };
        let text = format!("reads `{}` at its own position from memory: {why}", self.name(used.resource));
        let at = self.frame.sources.place(sampled.span);
        self.notes.push(Note::new(NoteKind::ReadFromMemory, subject.clone(), text, at));
    }
}

/// Whether the program records what an operation draws.
fn is_custom(frame: &Frame, adapted: &AdaptedFrame, op: u32) -> bool {
    let OpKind::Draw(pass) = adapted.ops[op as usize].kind else { return false };
    frame.passes[pass as usize].is_custom()
}
