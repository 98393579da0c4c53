//! A pass's pipeline, the template of its descriptor set, and its command.

use super::command_list::{
    Bindings, CommandList, DispatchCommand, DrawCommand, DrawCounts, DrawnVertices, Faces, OwnDraw, Run, WorkgroupCount,
};
use super::frame::Frame;
use super::pass_set::PassSets;
use super::supplied_sets::SuppliedSets;
use super::variant::{scope_formats, variant};
use crate::base::{Error, by};
use crate::gpu::{
    Gpu, GraphicsDescriptor, LocalReads, PipelineDescriptor, RotationConstants, ScopeFormats, VertexBinding,
};
use crate::pipeline::{
    brought_attributes, check_brought, check_needs, check_outputs, check_program, check_pushed, check_supplied,
    own_attributes,
};
use crate::shaders::{CompiledShader, ShaderLibrary};
use ash::vk;
use framewright_graph::frame::{BufferRole, Draw, EyeForm, Groups, IndirectDraws, Stereo};
use framewright_graph::plan::{self, BufferId, Plan, RenderScope};
use framewright_graph::shader::{
    DrawInterface, PASS_SET, PushedBlock, ShaderInterface, ShaderInterfaces, ShaderProblem,
};
use framewright_graph::vulkan::{Accesses, PrimitiveTopology};
use std::sync::Arc;

/// The objects of a pass of a rendering scope.
pub(crate) struct PreparedDraw {
    pub(crate) draw: Draw,
    pub(crate) sets: PassSets,
    /// `None`: a custom draw for which there is no shader, and whose program brings its own pipeline.
    pub(crate) pipeline: Option<PassPipeline>,
    /// How the pass sees the scope's colour attachments; `None` where no pass of the scope reads them locally.
    pub(crate) local: Option<LocalReads>,
    pub(crate) state: PassState,
    /// The pass's own vertex buffers.
    vertices: Vec<BufferId>,
    indices: Option<BufferId>,
    /// The buffer of the counts of its draws, and that of their number.
    indirect: Option<(BufferId, Option<BufferId>)>,
}

/// A pipeline of a pass. Its handle is null until it is made.
pub(crate) struct PassPipeline {
    pub(crate) raw: vk::Pipeline,
    pub(super) descriptor: PipelineDescriptor,
}

/// State of the pass's pipeline that a recorder must know.
pub(crate) struct PassState {
    pub(crate) formats: ScopeFormats,
    pub(crate) supplied: SuppliedSets,
    /// The vertex buffers that the pipeline reads and the draw source provides.
    pub(crate) vertex_buffers: Vec<VertexBinding>,
    /// Whether any of them has an element for each instance, or for several.
    pub(crate) reads_by_instance: bool,
    /// How many vertex buffers the draw source provides.
    pub(crate) brought_buffers: u32,
    /// The blocks of push constants that its stages read.
    pub(crate) pushed: Vec<PushedBlock>,
    /// The bytes of push constants that the draw source provides; 0 if no stage reads any.
    pub(crate) pushed_bytes: u32,
    /// As [`crate::shaders::CompiledShader::usual_vertices`].
    pub(crate) usual_vertices: bool,
}

/// A dispatch's objects.
pub(crate) struct PreparedDispatch {
    pub(crate) sets: PassSets,
    pub(crate) pipeline: PassPipeline,
    pub(crate) supplied: SuppliedSets,
    /// Invocations of a workgroup.
    size: [u32; 3],
}

impl PreparedDraw {
    /// The pipeline for a scope of another size; `None` if the one that it has serves for all sizes.
    pub(crate) fn resized(&self, gpu: &Gpu, name: &str, extent: [u32; 2]) -> Result<Option<vk::Pipeline>, Error> {
        let Some(PassPipeline { descriptor: PipelineDescriptor::Graphics(descriptor), .. }) = &self.pipeline else {
            return Ok(None);
        };
        let Some(turned) = descriptor.turned.filter(|turned| turned.extent != [0; 2]) else { return Ok(None) };
        let turned = Some(RotationConstants { extent, ..turned });
        let resized = GraphicsDescriptor { turned, ..(**descriptor).clone() };
        gpu.pipeline(name, &PipelineDescriptor::Graphics(resized.into())).map(Some)
    }

    /// Takes another pipeline in place of the one that it has.
    pub(crate) fn set_pipeline(&mut self, raw: vk::Pipeline) {
        if let Some(pipeline) = &mut self.pipeline {
            pipeline.raw = raw;
        }
    }

    /// The command of the pass in a frame; its number in the scope and that of its target are `numbers`.
    pub(super) fn command(
        &mut self,
        list: &mut CommandList,
        frame: &Frame<'_>,
        plan: &plan::Pass,
        (pass, target): (u32, u32),
    ) -> Result<DrawCommand, Error> {
        let buffer = |id: BufferId| frame.buffer(id).raw;
        let own = |counts| {
            let vertices = self.vertices.iter().copied().map(buffer).collect();
            let offsets = vec![0; self.vertices.len()];
            let (indices, supplied) = (self.indices.map(buffer), self.state.supplied.are_read());
            DrawnVertices::Own(Box::new(OwnDraw { vertices, offsets, indices, counts, supplied }))
        };
        let indirect = self.draw.indirect().zip(self.indirect);
        let vertices = match (self.draw.counts(), indirect) {
            (Some([count, instances]), _) => own(DrawCounts::Direct(count, instances)),
            (None, Some((draws, (counts, number)))) => {
                own(DrawCounts::Indirect(draws, buffer(counts), number.map(buffer)))
            }
            (None, None) if self.draw.is_full_screen() && !self.state.supplied.are_read() => DrawnVertices::FullScreen,
            (None, None) => DrawnVertices::Source,
        };
        let bindings = bindings(list, frame, plan, &mut self.sets, &self.state.supplied)?;
        let pipeline = self.pipeline.as_ref().map(|pipeline| pipeline.raw);
        let faces = Faces::of(plan);
        Ok(DrawCommand { pipeline, bindings, pass, target, vertices, faces })
    }
}

impl PreparedDispatch {
    /// The command of the dispatch in a frame.
    pub(super) fn command(
        &mut self,
        list: &mut CommandList,
        frame: &Frame<'_>,
        pass: &plan::Pass,
    ) -> Result<DispatchCommand, Error> {
        let groups = match self.groups(frame.gpu, pass)? {
            WorkgroupCount::Direct(count) => WorkgroupCount::Direct(count),
            WorkgroupCount::Indirect(buffer, offset) => WorkgroupCount::Indirect(frame.buffer(buffer).raw, offset),
        };
        let bindings = bindings(list, frame, pass, &mut self.sets, &self.supplied)?;
        Ok(DispatchCommand { pipeline: self.pipeline.raw, bindings, groups, supplied: self.supplied.are_read() })
    }

    /// How many workgroups it takes.
    ///
    /// # Errors
    /// [`Error::Mismatch`] if they are too many, or nothing says how many they are.
    pub(crate) fn groups(&self, gpu: &Gpu, pass: &plan::Pass) -> Result<WorkgroupCount<BufferId>, Error> {
        let mismatch = |what: String| Error::Mismatch { pass: pass.name.to_string(), what };
        let count = match pass.groups {
            None => return Err(mismatch("a dispatch doesn't say how many workgroups".to_owned())),
            Some(Groups::Count(count)) => count,
            Some(Groups::Invocations(wanted)) => [0, 1, 2].map(|axis| wanted[axis].div_ceil(self.size[axis].max(1))),
            Some(Groups::Indirect { offset }) => {
                return Ok(WorkgroupCount::Indirect(indirect(pass).map_err(mismatch)?, offset));
            }
        };
        let most = gpu.limits.max_compute_work_group_count;
        if count.iter().zip(most).any(|(count, most)| *count > most) {
            return Err(mismatch(format!("{} workgroups are more than the {} of this device", by(count), by(most))));
        }
        Ok(WorkgroupCount::Direct(count))
    }
}

/// What the pipeline of a pass reads of the pass's own in a frame.
fn bindings(
    list: &mut CommandList,
    frame: &Frame<'_>,
    pass: &plan::Pass,
    sets: &mut PassSets,
    supplied: &SuppliedSets,
) -> Result<Bindings, Error> {
    let set = sets.prepare(frame)?.unwrap_or_default();
    let parts = frame.plan.parts(pass).flat_map(|(_, access)| {
        let image = frame.plan.image(access.image);
        let extent = frame.physical.extent(image, frame.number);
        image.part(extent, access.range.base_mip).map(f32::to_ne_bytes)
    });
    let parts = parts.flatten();
    let (layout, program) = (supplied.layout, supplied.has_program_sets());
    Ok(Bindings { layout, set, parts: Run::add(&mut list.parts, parts), program })
}

/// The buffers of a pass that have this role.
fn buffers(pass: &plan::Pass, role: BufferRole) -> Vec<BufferId> {
    pass.buffers.iter().filter(|it| it.role == Some(role)).map(|it| it.buffer).collect()
}

/// The one buffer with the counts. The checker has found that it holds them.
fn indirect(pass: &plan::Pass) -> Result<BufferId, String> {
    buffers(pass, BufferRole::Indirect).first().copied().ok_or_else(|| "no buffer tells its counts".to_owned())
}

/// The buffers of the counts of indirect draws and of their number. The device must allow as many.
fn check_indirect(gpu: &Gpu, pass: &plan::Pass, draws: IndirectDraws) -> Result<(BufferId, Option<BufferId>), String> {
    let (most, of) = (gpu.limits.max_draw_indirect_count, draws.draws);
    if of > most {
        return Err(format!("{of} indirect draws are more than the {most} of this device"));
    }
    let number = buffers(pass, BufferRole::Count).first().copied();
    match (number, draws.count) {
        (None, Some(_)) => Err("the number of its draws stands in a buffer, and it has none of that role".to_owned()),
        (Some(_), None) => Err("it has a buffer for the number of its draws, and reads no number there".to_owned()),
        (None, None) | (Some(_), Some(_)) => Ok((indirect(pass)?, number)),
    }
}

impl PassPipeline {
    /// One that is yet to be made.
    const fn unmade(descriptor: PipelineDescriptor) -> PassPipeline {
        PassPipeline { raw: vk::Pipeline::null(), descriptor }
    }
}

/// The objects of a dispatch, but for its pipeline.
pub(super) fn prepare_dispatch(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    pass: &plan::Pass,
    (shaders, frames): (&mut ShaderLibrary, u32),
) -> Result<PreparedDispatch, Error> {
    let mismatch = |what: String| Error::Mismatch { pass: pass.name.to_string(), what };
    let shader = shaders
        .compute(&pass.shader, &variant(plan, pass, None)?)
        .map_err(|problem| Error::Shader { name: pass.shader.to_string(), problem })?;
    let brought = if reads_supplied(&shader.interface) {
        shaders.brought_along(None, &pass.shader)
    } else {
        DrawInterface::default()
    };
    check_brought(&brought).map_err(mismatch)?;
    check_program(&shader.interface, shaders.draws()).map_err(mismatch)?;
    let sets = shaders.draws().sets();
    check_needs(gpu, &shader.interface, &brought, sets, 0).map_err(mismatch)?;
    check_supplied(&shader.interface, &brought).map_err(mismatch)?;
    let size = shader.interface.workgroup_size.unwrap_or([1; 3]);
    let sets = PassSets::new(gpu, plan, pass, &shader.interface.bindings, frames)?;
    let supplied = SuppliedSets::new(gpu, sets.layout, &shader.interface, &brought, shaders)?;
    let descriptor = PipelineDescriptor::Compute { shader: shader.compute, layout: supplied.layout };
    let pipeline = PassPipeline::unmade(descriptor);
    Ok(PreparedDispatch { sets, pipeline, supplied, size })
}

/// The objects of a pass of a rendering scope, but for its pipeline.
pub(super) fn prepare_draw(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    scope: &RenderScope,
    pass: &plan::Pass,
    (shaders, frames): (&mut ShaderLibrary, u32),
) -> Result<PreparedDraw, Error> {
    let mismatch = |what: String| Error::Mismatch { pass: pass.name.to_string(), what };
    let draw = pass.draw.ok_or_else(|| mismatch("a rendering scope holds a dispatch".to_owned()))?;
    let (indices, wanted) = (buffers(pass, BufferRole::Index), buffers(pass, BufferRole::Vertex));
    let indices = match indices[..] {
        [] => None,
        [one] => Some(one),
        _ => return Err(mismatch("it has several index buffers".to_owned())),
    };
    let indirect = draw.indirect().map(|draws| check_indirect(gpu, pass, draws)).transpose().map_err(mismatch)?;
    let targets = targets(plan, scope, pass).map_err(mismatch)?;
    let mut brought = shaders.brought_along(Some(draw), &pass.shader);
    let brought_buffers = u32::try_from(brought.vertex_buffers.len()).unwrap_or(u32::MAX);
    let nothing = |sets, formats: ScopeFormats| PreparedDraw {
        draw,
        sets,
        pipeline: None,
        local: formats.local.clone(),
        state: PassState {
            formats,
            supplied: SuppliedSets::default(),
            vertex_buffers: Vec::new(),
            reads_by_instance: false,
            brought_buffers,
            pushed: Vec::new(),
            pushed_bytes: 0,
            usual_vertices: false,
        },
        vertices: Vec::new(),
        indices,
        indirect,
    };
    let form = plan.eyes(scope);
    let shader = match shaders.compiled(&pass.shader, draw, &variant(plan, pass, Some(scope))?) {
        Err(ShaderProblem::Missing { .. }) if draw.is_custom() => {
            let local = local_reads(gpu, scope, pass, None, &targets).map_err(mismatch)?;
            return Ok(nothing(PassSets::empty(gpu)?, ScopeFormats { local, ..scope_formats(plan, scope) }));
        }
        other => other.map_err(|problem| Error::Shader { name: pass.shader.to_string(), problem })?,
    };
    if draw.has_own_vertices() && !reads_supplied(&shader.interface) {
        brought = DrawInterface::default();
    }
    let written: Vec<_> = targets.iter().map(|target| &scope.color()[*target]).collect();
    check_brought(&brought).map_err(mismatch)?;
    check_program(&shader.interface, shaders.draws()).map_err(mismatch)?;
    let sets = shaders.draws().sets();
    check_needs(gpu, &shader.interface, &brought, sets, scope.color().len()).map_err(mismatch)?;
    check_supplied(&shader.interface, &brought).map_err(mismatch)?;
    check_outputs(&shader.interface, plan, &written).map_err(mismatch)?;
    let parts = !plan.variant(pass, Some(scope)).parts.is_empty();
    check_pushed(&shader.interface, &brought, parts).map_err(mismatch)?;
    check_raster(gpu, &shader.interface, pass).map_err(mismatch)?;
    check_covers(&shader.interface, plan, scope, pass).map_err(mismatch)?;
    let own_vertices = draw.has_own_vertices() && !wanted.is_empty();
    let (attributes, vertex_buffers) = match own_vertices {
        true => own_attributes(&shader.interface, wanted.len()),
        false => brought_attributes(&shader.interface, &brought),
    }
    .map_err(mismatch)?;
    check_eyes(plan, scope, &vertex_buffers).map_err(mismatch)?;
    let vertices = if own_vertices { wanted } else { Vec::new() };
    if indices.is_none() {
        check_reach(plan, draw, &vertices, &vertex_buffers).map_err(mismatch)?;
    }
    let sets = PassSets::new(gpu, plan, pass, &shader.interface.bindings, frames)?;
    let supplied = SuppliedSets::new(gpu, sets.layout, &shader.interface, &brought, shaders)?;
    let local = local_reads(gpu, scope, pass, Some(&shader), &targets).map_err(mismatch)?;
    let formats = ScopeFormats { local, ..scope_formats(plan, scope) };
    let blend = |number: &usize| {
        let blend = pass.blend.get(*number).filter(|_| targets.contains(number))?;
        Some((*blend, pass.write_mask(*number)))
    };
    let rotation = plan.rotation(scope);
    let extent = if shader.interface.uses_frag_coord { scope.extent } else { [0; 2] };
    let placed = form == Some(EyeForm::Halves) && shader.interface.uses_frag_coord;
    let turned = (rotation.turns() || placed).then_some(RotationConstants { rotation, extent });
    let descriptor = GraphicsDescriptor {
        vertex: shader.vertex.clone(),
        fragment: shader.fragment.clone(),
        layout: supplied.layout,
        vertex_buffers: vertex_buffers.clone(),
        attributes,
        formats: formats.clone(),
        blend: (0..scope.color().len()).map(|number| blend(&number)).collect(),
        raster: pass.raster.of_pipeline(),
        depth: pass.depth,
        stencil: pass.stencil,
        alpha_to_coverage: pass.alpha_to_coverage,
        turned,
    };
    let pipeline = Some(PassPipeline::unmade(PipelineDescriptor::Graphics(descriptor.into())));
    let read = if own_vertices { Vec::new() } else { vertex_buffers };
    let usual_vertices = shader.usual_vertices;
    let pushed = shader.interface.pushed.clone();
    let pushed_bytes = if pushed.is_empty() { 0 } else { brought.pushed_bytes() };
    let state = PassState {
        formats: formats.clone(),
        supplied,
        reads_by_instance: read.iter().any(|buffer| buffer.rate.is_by_instance()),
        vertex_buffers: read,
        brought_buffers,
        pushed,
        pushed_bytes,
        usual_vertices,
    };
    Ok(PreparedDraw { pipeline, state, vertices, ..nothing(sets, formats) })
}

/// Whether a shader reads what a draw source brings along. One that reads nothing of it isn't held to what the device can bind of it.
fn reads_supplied(interface: &ShaderInterface) -> bool {
    interface.bindings.iter().any(|binding| binding.set != PASS_SET)
}

/// Where instances are both eyes', their numbers aren't those of the elements of a buffer.
fn check_eyes(plan: &Plan, scope: &RenderScope, buffers: &[VertexBinding]) -> Result<(), String> {
    let by_instances = matches!(plan.stereo, Stereo::Instanced | Stereo::DoubleWide) && plan.eyes(scope).is_some();
    if by_instances && buffers.iter().any(|buffer| buffer.rate.is_by_instance()) {
        return Err("it draws both eyes by instances, and reads vertex attributes by instance".to_owned());
    }
    Ok(())
}

/// The device must allow what raster state asks for, and the shader have what it and blends take.
fn check_raster(gpu: &Gpu, shader: &ShaderInterface, pass: &plan::Pass) -> Result<(), String> {
    let limits = gpu.shader_limits();
    for (limit, value, what) in pass.raster.limits() {
        #[allow(clippy::cast_precision_loss, reason = "such limits are small")]
        if value > limits.of(limit) as f32 {
            return Err(format!("{what} is {value}, and this device allows {} ({})", limits.of(limit), limit.name()));
        }
    }
    if pass.blend.iter().any(|blend| blend.takes_second_source()) && !shader.second_source {
        return Err(format!("shader `{}` has no second colour to blend with", pass.shader));
    }
    if pass.raster.topology == PrimitiveTopology::PointList && !shader.point_size {
        return Err(format!("shader `{}` doesn't say how large its points are", pass.shader));
    }
    Ok(())
}

/// The Plan must know what the shader leaves as it was, where it relies on that: it may have been made before the shader was changed.
fn check_covers(shader: &ShaderInterface, plan: &Plan, scope: &RenderScope, pass: &plan::Pass) -> Result<(), String> {
    let leaves_out = shader.discards || shader.masks_samples;
    // A pass that draws the same depth again would draw what this one leaves out.
    let mut passes = plan.steps.iter().flat_map(|step| step.work.passes());
    let mut drawn_again = || passes.any(|it| it.redraws.as_ref() == Some(&pass.name));
    if pass.discards || !leaves_out || !(pass.is_taken_to_cover(scope) || drawn_again()) {
        return Ok(());
    }
    Err(format!("shader `{}` leaves samples out, which the Plan doesn't know: compile the Plan again", pass.shader))
}

/// The colour attachments of the scope that the pass writes, by the shader's locations.
fn targets(plan: &Plan, scope: &RenderScope, pass: &plan::Pass) -> Result<Vec<usize>, String> {
    let writes =
        |access: &&plan::Access| access.accesses.contains(Accesses::COLOR_ATTACHMENT_WRITE) && access.binding.is_none();
    let mut targets = Vec::new();
    for access in pass.accesses.iter().filter(writes) {
        let same = |it: &&plan::Attachment| {
            it.image == access.image
                && it.range.base_mip == access.range.base_mip
                && it.range.base_layer == access.range.base_layer
        };
        let found = scope.color().iter().position(|it| same(&it));
        let found =
            found.ok_or_else(|| format!("it writes `{}`, which is no attachment", plan.image(access.image).name));
        targets.push(found?);
    }
    targets.dedup();
    Ok(targets)
}

/// How the pass sees the scope's colour attachments; `None` if its shader's locations are theirs, and it reads none. A pass without
/// shader, for which the program has pipelines, reads an attachment by the attachment's own number.
fn local_reads(
    gpu: &Gpu,
    scope: &RenderScope,
    pass: &plan::Pass,
    shader: Option<&CompiledShader>,
    targets: &[usize],
) -> Result<Option<LocalReads>, String> {
    let mut inputs = vec![vk::ATTACHMENT_UNUSED; scope.color().len()];
    for access in &pass.accesses {
        let Some(binding) = access.binding.as_ref().filter(|it| it.kind.is_input_attachment()) else {
            continue;
        };
        let attachment = scope.color().iter().position(|it| it.image == access.image);
        let index = match shader {
            Some(shader) => shader.input_attachments.iter().find(|(name, _)| **name == *binding.name).map(|it| it.1),
            None => attachment.and_then(|number| u32::try_from(number).ok()),
        };
        let (Some(index), Some(attachment)) = (index, attachment) else {
            return Err(format!("`{}` is no input attachment of a colour attachment of its scope", binding.name));
        };
        inputs[attachment] = index;
    }
    let reads = inputs.iter().any(|index| *index != vk::ATTACHMENT_UNUSED);
    let straight = targets.iter().enumerate().all(|(location, target)| location == *target);
    if straight && !reads {
        return Ok(None);
    }
    if gpu.local_read.is_none() {
        return Err("it needs local reads, and this device has none".to_owned());
    }
    let mut locations = vec![vk::ATTACHMENT_UNUSED; scope.color().len()];
    for (location, target) in (0..).zip(targets) {
        locations[*target] = location;
    }
    fill_gaps(&mut locations);
    fill_gaps(&mut inputs);
    let drawn = (0..scope.color().len()).map(|number| targets.contains(&number)).collect();
    Ok(Some(LocalReads { locations, inputs, drawn }))
}

/// Gives numbers that are left over to attachments that the pass doesn't use: SwiftShader takes `VK_ATTACHMENT_UNUSED` for an
/// index and crashes.
fn fill_gaps(numbers: &mut [u32]) {
    let taken = numbers.to_vec();
    let mut free = (0..).filter(|number| !taken.contains(number));
    for number in numbers.iter_mut().filter(|number| **number == vk::ATTACHMENT_UNUSED) {
        *number = free.next().unwrap_or(vk::ATTACHMENT_UNUSED);
    }
}

/// A draw's vertices must lie within its buffers. The checker has said so of indices. Only the device knows the vertices that
/// they point to, and it keeps within the buffers.
fn check_reach(plan: &Plan, draw: Draw, vertices: &[BufferId], read: &[VertexBinding]) -> Result<(), String> {
    let Some([count, _]) = draw.counts() else { return Ok(()) };
    vertices.iter().zip(read).try_for_each(|(buffer, VertexBinding { stride, .. })| {
        let buffer = &plan.buffers[buffer.0 as usize];
        if u64::from(count) * u64::from(*stride) <= buffer.bytes {
            return Ok(());
        }
        Err(format!("{count} of {stride} bytes each are more than `{}` holds: {} bytes", buffer.name, buffer.bytes))
    })
}
