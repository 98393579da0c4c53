//! Rendering scopes and their draws.

use super::bindings::bind;
use super::bound_sets::bind_program_sets;
use super::canvas::Canvas;
use super::recorded_frame::Counts;
use super::recorder::Recorder;
use super::step::Recording;
use crate::base::Error;
use crate::gpu::{Gpu, LocalReads};
use crate::prepare::{CommandList, DrawCommand, DrawCounts, DrawnVertices, OwnDraw, ScopeCommand};
use ash::vk;
use framewright_graph::frame::IndirectDraws;

/// Begins a rendering scope, or goes on with it.
pub(super) fn begin(
    gpu: &Gpu,
    commands: vk::CommandBuffer,
    list: &CommandList,
    scope: &ScopeCommand,
    flags: vk::RenderingFlags,
) {
    let mut rendering = vk::RenderingInfo::default()
        .flags(flags)
        .render_area(scope.extent.into())
        .layer_count(scope.layers)
        .view_mask(scope.view_mask)
        .color_attachments(scope.color.of(&list.attachments));
    if let [depth] = scope.depth.of(&list.attachments) {
        rendering = rendering.depth_attachment(depth);
    }
    if let [stencil] = scope.stencil.of(&list.attachments) {
        rendering = rendering.stencil_attachment(stencil);
    }
    // SAFETY: the command buffer is being recorded outside a scope; views and formats are those that the pipelines were made
    // for.
    unsafe { gpu.raw.cmd_begin_rendering(commands, &rendering) };
}

impl Recording<'_> {
    /// Records a pass of the scope of a step.
    pub(super) fn draw(
        &mut self,
        commands: vk::CommandBuffer,
        step: usize,
        draw: &DrawCommand,
    ) -> Result<Counts, Error> {
        let (gpu, list) = (self.frame.gpu, &self.prepared.list);
        if let Some(counts) = self.secondary(commands, step, draw)? {
            return Ok(counts);
        }
        let (mut draws, mut culled) = (1, 0);
        self.state.begin_pass();
        if let Some(pipeline) = draw.pipeline {
            let graphics = vk::PipelineBindPoint::GRAPHICS;
            if self.state.needs_graphics(pipeline) {
                // SAFETY: the command buffer is being recorded within a scope that the pipeline was made for.
                unsafe { gpu.raw.cmd_bind_pipeline(commands, graphics, pipeline) };
            }
            bind(gpu, commands, graphics, list, &draw.bindings);
        }
        let missing = match draw.bindings.program {
            true => {
                let supplied = &self.prepared.steps[step].draws()[draw.pass as usize].state.supplied;
                let point = vk::PipelineBindPoint::GRAPHICS;
                bind_program_sets(gpu, commands, point, supplied, self.frame.sets)
            }
            false => Ok(None),
        };
        let mut canvas = Canvas::new(gpu, commands, &mut self.state, &list.targets[draw.target as usize], draw.faces);
        let begun = missing.and_then(|missing| match (&draw.vertices, missing) {
            (DrawnVertices::Own(own), _) if own.supplied => canvas.begin(),
            (DrawnVertices::FullScreen | DrawnVertices::Own(_), Some(set)) => {
                Err(format!("a draw without set {set}, which the program binds itself by `Executor::bind_set`"))
            }
            _ => canvas.begin(),
        });
        let planned = || &self.frame.plan.steps[step].work.passes()[draw.pass as usize];
        let drawn = match &draw.vertices {
            DrawnVertices::FullScreen => begun.and_then(|()| {
                canvas.for_eyes(0..1, |device, commands, first, count| {
                    // SAFETY: everything that the pipeline reads is bound.
                    unsafe { device.cmd_draw(commands, 3, count, 0, first) };
                })
            }),
            DrawnVertices::Own(own) if !own.supplied => begun.and_then(|()| draw_own(&mut canvas, own)),
            DrawnVertices::Own(_) | DrawnVertices::Source => {
                let made = &self.prepared.steps[step].draws()[draw.pass as usize];
                let kept = &mut self.recorded.kept;
                let mut recorder = Recorder::new(canvas, kept, made, planned(), self.frame, begun);
                let recorded = self.source.record(made.draw, &mut recorder)?;
                if let Some(watch) = &mut self.observers.watch {
                    watch.note_asked(planned(), recorder.asked());
                }
                match &draw.vertices {
                    DrawnVertices::Own(own) => recorder.bound().and_then(|mut canvas| draw_own(&mut canvas, own)),
                    DrawnVertices::FullScreen | DrawnVertices::Source => {
                        draws = recorded;
                        recorder.finish().map(|objects| culled = objects)
                    }
                }
            }
        };
        drawn.map_err(|what| Error::Recording { pass: planned().name.to_string(), what })?;
        Ok(Counts { draws, culled })
    }
}

/// Draws the vertices of the pass's own.
fn draw_own(canvas: &mut Canvas<'_>, own: &OwnDraw) -> Result<(), String> {
    let (device, commands) = (&canvas.gpu.raw, canvas.commands);
    // SAFETY: the command buffer is being recorded, the Plan's usages were checked by the checker, everything that the pipeline
    // reads is bound, and with robustBufferAccess an index beyond the vertices reads no foreign memory, or the program has vouched
    // for its files (`BufferBounds`, `adopt`). A buffer of counts holds as many commands, and the device allows as many.
    unsafe {
        if !own.vertices.is_empty() {
            device.cmd_bind_vertex_buffers(commands, 0, &own.vertices, &own.offsets);
        }
        if let Some(indices) = own.indices {
            device.cmd_bind_index_buffer(commands, indices, 0, vk::IndexType::UINT32);
        }
        let indexed = own.indices.is_some();
        match own.counts {
            DrawCounts::Direct(count, instances) => {
                return canvas.for_eyes(0..instances, |device, commands, first, instances| {
                    if indexed {
                        device.cmd_draw_indexed(commands, count, instances, 0, 0, first);
                    } else {
                        device.cmd_draw(commands, count, instances, 0, first);
                    }
                });
            }
            DrawCounts::Indirect(draws, counts, number) => {
                let IndirectDraws { draws: most, offset, count, .. } = draws;
                let stride = draws.stride(indexed);
                match (number.zip(count), indexed) {
                    (None, false) => device.cmd_draw_indirect(commands, counts, offset, most, stride),
                    (None, true) => device.cmd_draw_indexed_indirect(commands, counts, offset, most, stride),
                    (Some((number, at)), false) => {
                        device.cmd_draw_indirect_count(commands, counts, offset, number, at, most, stride);
                    }
                    (Some((number, at)), true) => {
                        device.cmd_draw_indexed_indirect_count(commands, counts, offset, number, at, most, stride);
                    }
                }
            }
        }
    }
    Ok(())
}

/// Makes what the scope drew so far visible to fragment shaders at their own position; what they read so far may be drawn
/// over behind it, since colour output comes later than they do.
pub(super) fn local_barrier(gpu: &Gpu, commands: vk::CommandBuffer) {
    let barrier = [vk::MemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
        .src_access_mask(vk::AccessFlags2::COLOR_ATTACHMENT_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::FRAGMENT_SHADER)
        .dst_access_mask(vk::AccessFlags2::INPUT_ATTACHMENT_READ)];
    let info = vk::DependencyInfo::default().dependency_flags(vk::DependencyFlags::BY_REGION).memory_barriers(&barrier);
    // SAFETY: local reads are on wherever a Plan has such a barrier, which allows this one within a scope.
    unsafe { gpu.raw.cmd_pipeline_barrier2(commands, &info) };
}

/// Sets what locations and input attachments the scope's colour attachments are to the pass.
pub(super) fn see_attachments(gpu: &Gpu, commands: vk::CommandBuffer, local: &LocalReads) {
    let Some(extension) = &gpu.local_read else { return };
    let locations = vk::RenderingAttachmentLocationInfoKHR::default().color_attachment_locations(&local.locations);
    let inputs = vk::RenderingInputAttachmentIndexInfoKHR::default().color_attachment_input_indices(&local.inputs);
    // SAFETY: the command buffer is being recorded in a scope with these colour attachments, and the extension is on.
    unsafe {
        (extension.fp().cmd_set_rendering_attachment_locations_khr)(commands, &locations);
        (extension.fp().cmd_set_rendering_input_attachment_indices_khr)(commands, &inputs);
    }
}
