//! Rendering scopes and their draws.

use super::recorder::{CullMode, FrontFace, Recorder};
use super::step::{Recording, tell_parts};
use super::timing::Counts;
use crate::base::Error;
use crate::gpu::{Gpu, LocalRead};
use crate::prepare::{DrawCommands, DrawTarget, PreparedDraw, ScopeCommands};
use ash::vk;
use framewright_graph::frame::Draw;
use framewright_graph::plan::{Pass, RenderScope};

impl Recording<'_> {
    /// Records a rendering scope.
    pub(super) fn render(
        &mut self,
        commands: vk::CommandBuffer,
        plan: &RenderScope,
        made: &[PreparedDraw],
        scope: &ScopeCommands,
    ) -> Result<(), Error> {
        let gpu = self.frame.gpu;
        let mut rendering = vk::RenderingInfo::default()
            .render_area(scope.area)
            .layer_count(scope.layers)
            .view_mask(scope.view_mask)
            .color_attachments(&scope.color);
        if let Some(depth) = &scope.depth {
            rendering = rendering.depth_attachment(depth);
        }
        if let Some(stencil) = &scope.stencil {
            rendering = rendering.stencil_attachment(stencil);
        }
        // SAFETY: the command buffer is being recorded outside a scope; views and formats are those that the pipelines
        // were made for.
        unsafe { gpu.raw.cmd_begin_rendering(commands, &rendering) };
        for ((plan, made), pass) in plan.passes.iter().zip(made).zip(&scope.passes) {
            let drawn = gpu.labelled(commands, &made.label, || {
                if plan.local_barrier {
                    local_barrier(gpu, commands);
                }
                if let Some(local) = &made.local {
                    see_attachments(gpu, commands, local);
                }
                self.draw(commands, plan, made, pass, scope.target)
            });
            self.end_pass(commands, drawn?);
        }
        // SAFETY: the scope was begun above.
        unsafe { gpu.raw.cmd_end_rendering(commands) };
        Ok(())
    }

    fn draw(
        &mut self,
        commands: vk::CommandBuffer,
        plan: &Pass,
        made: &PreparedDraw,
        pass: &DrawCommands,
        target: DrawTarget,
    ) -> Result<Counts, Error> {
        let gpu = self.frame.gpu;
        self.state.begin_pass();
        if let Some(pipeline) = made.pipeline {
            // SAFETY: the command buffer is being recorded within a scope that the pipeline was made for, and the set has
            // the layout's first set layout.
            unsafe {
                let graphics = vk::PipelineBindPoint::GRAPHICS;
                if self.state.needs_graphics(pipeline) {
                    gpu.raw.cmd_bind_pipeline(commands, graphics, pipeline);
                }
                if let Some(set) = pass.set {
                    gpu.raw.cmd_bind_descriptor_sets(commands, graphics, made.state.layout, 0, &[set], &[]);
                }
            }
            tell_parts(gpu, commands, made.state.layout, &pass.parts);
        }
        let (state, kept) = (&mut self.state, &mut self.recorded.kept);
        let mut recorder = Recorder::new((gpu, commands), (state, kept), made, plan, target, self.frame.number);
        recorder.see_all();
        recorder.set_cull_mode(CullMode::None);
        recorder.set_front_face(FrontFace::CounterClockwise);
        let draws = match made.draw {
            Draw::FullScreen if !made.state.reads_supplied() => {
                recorder.draw(0..3, 0..1);
                1
            }
            Draw::Vertices { count, instances } => {
                bind_own_buffers(gpu, commands, pass);
                recorder.draw_own(count, instances, pass.indices.is_some());
                1
            }
            Draw::Indirect => {
                bind_own_buffers(gpu, commands, pass);
                if let Some(counts) = pass.counts {
                    recorder.draw_indirect(counts, pass.indices.is_some());
                }
                1
            }
            Draw::FullScreen | Draw::Objects(_) | Draw::Casters(_) | Draw::Sky | Draw::Custom => {
                self.source.record(made.draw, &mut recorder)?
            }
        };
        let culled = recorder.finish().map_err(|what| Error::Recording { pass: plan.name.to_string(), what })?;
        Ok(Counts { draws, culled })
    }
}

/// Makes what the scope drew so far visible to fragment shaders at their own position; what they read so far may be drawn
/// over behind it, since colour output comes later than they do.
fn local_barrier(gpu: &Gpu, commands: vk::CommandBuffer) {
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
fn see_attachments(gpu: &Gpu, commands: vk::CommandBuffer, local: &LocalRead) {
    let Some(extension) = &gpu.local_read else { return };
    let locations = vk::RenderingAttachmentLocationInfoKHR::default().color_attachment_locations(&local.locations);
    let inputs = vk::RenderingInputAttachmentIndexInfoKHR::default().color_attachment_input_indices(&local.inputs);
    // SAFETY: the command buffer is being recorded in a scope with these colour attachments, and the extension is on.
    unsafe {
        (extension.fp().cmd_set_rendering_attachment_locations_khr)(commands, &locations);
        (extension.fp().cmd_set_rendering_input_attachment_indices_khr)(commands, &inputs);
    }
}

/// Binds the vertex and index buffers that the Plan gives the pass.
fn bind_own_buffers(gpu: &Gpu, commands: vk::CommandBuffer, pass: &DrawCommands) {
    // SAFETY: the command buffer is being recorded, and the Plan's usages were checked by the checker.
    unsafe {
        if !pass.vertices.is_empty() {
            gpu.raw.cmd_bind_vertex_buffers(commands, 0, &pass.vertices, &pass.offsets);
        }
        if let Some(indices) = pass.indices {
            gpu.raw.cmd_bind_index_buffer(commands, indices, 0, vk::IndexType::UINT32);
        }
    }
}
