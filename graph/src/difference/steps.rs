//! The steps of a Plan as entries that can be compared by their names.

use super::Kind;
use super::describe::{Description, code};
use crate::frame::Blend;
use crate::plan::names::ShownText;
use crate::plan::text::{bound, fill_value, size};
use crate::plan::{
    Access, Attachment, AttachmentResolve, Hazard, ImageBarrier, ImageId, MemoryBarrier, OutsideTransfer, OutsideWay,
    Pass, Plan, Queue, Resource, Side, Step, StepId, Transfer, Wait, Work,
};
use crate::vulkan::{State, Subresources, in_plan, name_of};

/// The step that an entry is or belongs to.
#[derive(Clone, Copy)]
pub(super) struct EntryStep<'p> {
    pub(super) plan: &'p Plan,
    pub(super) id: Option<StepId>,
}

impl<'p> EntryStep<'p> {
    fn step(self) -> Option<&'p Step> {
        self.plan.steps.get(self.id?.0 as usize)
    }

    /// The name of the step that needs a barrier: a later one, or this one.
    fn name(self, needed_by: Option<StepId>) -> String {
        needed_by.or(self.id).map_or_else(String::new, |id| self.plan.step_name(id))
    }

    /// In which frames the step runs, unless it does in all.
    fn runs(self) -> Option<(&'static str, String)> {
        let run = self.step().map(|step| &step.run).filter(|run| !run.is_always())?;
        Some(("runs", ShownText(&run.to_string()).to_string()))
    }

    /// The first pass of the rendering scope.
    fn first(self) -> Option<&'p Pass> {
        self.step()?.work.scope()?.passes.first()
    }

    fn name_of_first(self) -> String {
        self.first().map_or_else(String::new, |pass| code(&pass.name))
    }

    pub(super) fn wait(self, wait: &Wait) -> Description {
        let frame = if wait.frames_ago == 0 { "" } else { " of a frame before" };
        let waited_for = format!("for {}{frame}", self.plan.step_name(wait.step));
        let name = format!("{} {waited_for}", self.name(None));
        Description::new(Kind::Wait, name, vec![("stages", name_of(&wait.stages))]).of_step(waited_for)
    }

    pub(super) fn resolve(self, attachment: &Attachment, resolve: &AttachmentResolve) -> Description {
        let sides = [(attachment.image, attachment.range), (resolve.image, resolve.range)];
        let [from, to] = sides.map(|(image, range)| self.part(image, range));
        let fields = vec![
            ("mode", name_of(&resolve.mode)),
            ("done", "at the end of a scope".to_owned()),
            ("layout", name_of(&resolve.layout)),
        ];
        Description::new(Kind::Resolve, format!("{from} → {to}"), fields)
    }

    pub(super) fn attachment(self, location: usize, attachment: &Attachment) -> Description {
        let image = self.part(attachment.image, attachment.range);
        let mut fields = vec![("load", name_of(&attachment.load)), ("store", name_of(&attachment.store))];
        if let Some(clear) = attachment.clear {
            fields.push(("clear value", in_plan(&clear)));
        }
        fields.push(("layout", name_of(&attachment.layout)));
        fields.push(("attached as", attachment.kind.words(location)));
        let of_itself = format!("{image}, {}", name_of(&attachment.range.aspects));
        let name = format!("{of_itself}, of the scope of {}", self.name_of_first());
        let because = Some(ShownText(&attachment.because.to_string()).to_string());
        Description { because, ..Description::new(Kind::Attachment, name, fields).of_step(of_itself) }
    }

    pub(super) fn pass(self, pass: &Pass) -> Description {
        let mut fields = Vec::new();
        if let Some(scope) = self.step().and_then(|step| step.work.scope()) {
            let [width, height] = scope.extent;
            let is_first = self.first().is_some_and(|first| first.name == pass.name);
            let shared = if is_first { "its own".to_owned() } else { format!("that of {}", self.name_of_first()) };
            fields.push(("rendering scope", shared));
            fields.push(("size", format!("{width}×{height}")));
            fields.push(("samples", scope.samples.to_string()));
            if scope.layers > 1 {
                fields.push(("layers", scope.layers.to_string()));
            }
        }
        fields.push(("shader", code(&pass.shader)));
        let queue = self.step().map(|step| step.queue).filter(|queue| *queue != Queue::Graphics);
        fields.extend(queue.iter().map(|queue| ("queue", name_of(queue))));
        fields.extend(self.runs());
        fields.extend(pass.draw.iter().map(|draw| ("draw", in_plan(draw))));
        fields.extend(pass.groups.iter().map(|groups| ("workgroups", in_plan(groups))));
        fields.extend(pass.stencil.iter().map(|stencil| ("stencil", in_plan(stencil))));
        fields.extend(pass.redraws.iter().map(|redrawn| ("draws the depth again of", code(redrawn))));
        let view = pass.view.and_then(|view| self.plan.views.get(view.0 as usize));
        fields.extend(view.iter().map(|view| ("view", code(&view.name))));
        let flags = [
            ("alpha to coverage", pass.alpha_to_coverage),
            ("covers", pass.covers),
            ("discards", pass.discards),
            ("local barrier", pass.local_barrier),
        ];
        fields.extend(flags.into_iter().filter(|(_, set)| *set).map(|(name, _)| (name, "yes".to_owned())));
        if pass.blend.iter().any(|blend| *blend != Blend::Replace) {
            fields.push(("blend", pass.blend.iter().map(in_plan).collect::<Vec<_>>().join(", ")));
        }
        if !pass.write_masks.is_empty() {
            fields.push(("writes", pass.write_masks.iter().map(name_of).collect::<Vec<_>>().join(", ")));
        }
        if !pass.raster.is_usual() {
            fields.push(("raster state", pass.raster.to_string()));
        }
        if let Some(depth) = &pass.depth {
            fields.push((
                "depth test",
                format!("{}{}", name_of(&depth.test), if depth.write { ", written" } else { "" }),
            ));
        }
        let images = pass.accesses.iter().filter_map(|access| {
            let binding = access.binding.as_ref()?;
            Some(format!("{} = {}", ShownText(&binding.name), self.part(access.image, access.range)))
        });
        let buffers = pass.buffers.iter().map(|access| {
            let name = access.binding.as_ref().map_or_else(String::new, |name| format!("{} = ", ShownText(name)));
            format!("{name}{}", self.resource(Resource::Buffer(access.buffer)))
        });
        let bound: Vec<String> = images.chain(buffers).collect();
        if !bound.is_empty() {
            fields.push(("binds", bound.join(", ")));
        }
        let params = pass.params.iter().map(|param| format!("{} = {}", ShownText(&param.name), param.value));
        let params: Vec<String> = params.collect();
        if !params.is_empty() {
            fields.push(("parameters", params.join(", ")));
        }
        let constants = pass.constants.iter().map(|it| format!("{} = {}", ShownText(&it.name), it.value));
        let constants: Vec<String> = constants.collect();
        if !constants.is_empty() {
            fields.push(("constants", constants.join(", ")));
        }
        if !pass.accesses.is_empty() {
            fields.push((
                "accesses",
                pass.accesses.iter().map(|access| self.access(access)).collect::<Vec<_>>().join("; "),
            ));
        }
        Description::new(Kind::Pass, code(&pass.name), fields)
    }

    /// All of an access to an image.
    fn access(self, access: &Access) -> String {
        let eye = access.eye.map_or_else(String::new, |eye| format!(", the {} eye's", eye.name()));
        let kind = access.binding.as_ref().map_or_else(String::new, |binding| format!(", {}", bound(binding)));
        let [accesses, stages, layout] = [name_of(&access.accesses), name_of(&access.stages), name_of(&access.layout)];
        format!("{}{eye}: {accesses} in {stages} as {layout}{kind}", self.part(access.image, access.range))
    }

    /// The work of a step, if it is a transfer.
    pub(super) fn transfer(self, work: &Work) -> Option<Description> {
        let between = |kind, transfer: &Transfer, mut fields: Vec<(&'static str, String)>| {
            let [from, to] = [transfer.source, transfer.target].map(|side| self.side(side));
            fields.extend(transfer.filter.iter().map(|filter| ("filter", name_of(filter))));
            fields.extend(self.runs());
            Some(Description::new(kind, format!("{from} → {to}"), fields))
        };
        match work {
            Work::Resolve(resolve) => {
                let mode = name_of(&self.plan.mode_of(resolve));
                between(Kind::Resolve, resolve, vec![("mode", mode), ("done", "by a step of its own".to_owned())])
            }
            Work::Copy(copy) => between(Kind::Transfer, copy, vec![("work", "copy".to_owned())]),
            Work::Blit(blit) => between(Kind::Transfer, blit, vec![("work", "blit".to_owned())]),
            Work::Fill(fill) => {
                let mut fields = vec![("work", "fill".to_owned()), ("value", fill_value(self.plan, fill))];
                fields.extend(self.runs());
                Some(Description::new(Kind::Transfer, self.side(fill.target), fields))
            }
            Work::Render(_) | Work::Dispatch(_) | Work::Custom(_) | Work::Export => None,
        }
    }

    pub(super) fn image_barrier(self, barrier: &ImageBarrier) -> Description {
        let image = self.part(barrier.image, barrier.range);
        let name = format!("{image} before {}: {}", self.name(barrier.needed_by), words(barrier.hazard));
        let [from, to] = [&barrier.old_layout, &barrier.new_layout].map(name_of);
        let mut fields = vec![("layouts", format!("{from} → {to}"))];
        fields.extend(scopes(
            [name_of(&barrier.src_stages), name_of(&barrier.dst_stages)],
            [name_of(&barrier.src_accesses), name_of(&barrier.dst_accesses)],
        ));
        Description::new(Kind::Barrier, name, fields).of_step(format!("{image}: {}", words(barrier.hazard)))
    }

    pub(super) fn outside(self, transfer: &OutsideTransfer) -> Description {
        let resource = self.resource(transfer.resource);
        let name = match transfer.way {
            OutsideWay::Acquire => format!("{resource} from {}", transfer.owner.words()),
            OutsideWay::Release => format!("{resource} to {}", transfer.owner.words()),
        };
        let State { stages, accesses, layout } = &transfer.state;
        let fields = vec![("layout", name_of(layout)), ("stages", name_of(stages)), ("accesses", name_of(accesses))];
        Description::new(Kind::Barrier, name, fields)
    }

    pub(super) fn memory_barrier(self, barrier: &MemoryBarrier) -> Vec<Description> {
        let fields = scopes(
            [name_of(&barrier.src_stages), name_of(&barrier.dst_stages)],
            [name_of(&barrier.src_accesses), name_of(&barrier.dst_accesses)],
        );
        let described = |name: String| Description::new(Kind::Barrier, name, fields.to_vec());
        let hands = barrier.hand_overs.iter().map(|sides| {
            let [before, after] = sides.map(|resource| self.resource(resource));
            described(format!("memory of {before} becomes that of {after}"))
        });
        let buffers = barrier.buffers.iter().map(|hazard| {
            let buffer = self.resource(Resource::Buffer(hazard.buffer));
            let name = format!("{buffer} before {}: {}", self.name(hazard.needed_by), words(hazard.hazard));
            described(name).of_step(format!("{buffer}: {}", words(hazard.hazard)))
        });
        hands.chain(buffers).collect()
    }

    fn resource(self, resource: Resource) -> String {
        code(self.plan.resource_name(resource))
    }

    fn side(self, side: Side) -> String {
        match side {
            Side::Image { image, range, extent, layout } => {
                format!("{}, {} in {}", self.part(image, range), size(extent), name_of(&layout))
            }
            Side::Buffer { buffer, bytes } => format!("{}, {bytes} bytes", self.resource(Resource::Buffer(buffer))),
        }
    }

    /// An image, and which part of it unless it is the whole.
    fn part(self, id: ImageId, range: Subresources) -> String {
        let name = self.resource(Resource::Image(id));
        let image = self.plan.images.get(id.0 as usize);
        let whole = image.map(|image| Subresources::all(image.format, image.mips, image.layers));
        if whole == Some(range) { name } else { format!("{name} ({range})") }
    }
}

/// Stages and accesses of a barrier.
fn scopes([src, dst]: [String; 2], [before, after]: [String; 2]) -> [(&'static str, String); 2] {
    [("stages", format!("{src} → {dst}")), ("accesses", format!("{before} → {after}"))]
}

fn words(hazard: Hazard) -> &'static str {
    match hazard {
        Hazard::FirstUse => "first use",
        Hazard::ReadAfterWrite => "read after write",
        Hazard::WriteAfterRead => "write after read",
        Hazard::WriteAfterWrite => "write after write",
        Hazard::LayoutChange => "another layout",
        Hazard::Export => "promised state",
        Hazard::Ownership => "another queue",
    }
}
