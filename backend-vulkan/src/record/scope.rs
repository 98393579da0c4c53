//! Rendering scopes and their draws.

use super::draw_source::DrawSource;
use super::frame::{Frame, Recorded, unprepared};
use super::recorder::{CullMode, DrawTarget, FrontFace, HeldResources, Recorder};
use super::timing::{Counts, Timing};
use crate::base::{Error, convert};
use crate::gpu::LocalRead;
use crate::pipeline::or_unused;
use crate::prepare::{AttachmentViews, PreparedDraw, PreparedScope, view_mask};
use ash::vk;
use framewright_graph::frame::{Draw, EyeForm};
use framewright_graph::plan::{self, Attachment, RenderScope};
use framewright_graph::vulkan::{Aspects, LoadOp};

impl Frame<'_> {
    pub(super) fn render(
        &self,
        commands: vk::CommandBuffer,
        plan: &RenderScope,
        scope: &PreparedScope,
        source: &mut dyn DrawSource,
        timing: &mut Timing,
        recorded: &mut Recorded,
    ) -> Result<(), Error> {
        let views = scope.views.at(self.number).ok_or_else(unprepared)?;
        let device = &self.gpu.raw;
        let info = |(attachment, views)| self.attachment(attachment, views);
        let color = or_unused(plan.color.iter().zip(&views.color).map(info));
        let depth = plan.depth.as_ref().zip(views.depth.as_deref()).map(info);
        let stencil = plan.stencil.as_ref().zip(views.stencil.as_deref()).map(info);
        let (form, rotation) = (self.plan.eyes(plan), self.plan.rotation(plan));
        let [width, height, _] = EyeForm::extent(form, [plan.extent[0], plan.extent[1], 1], rotation);
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        let mut rendering = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(EyeForm::layers(form, plan.layers))
            .view_mask(view_mask(self.plan, plan))
            .color_attachments(&color);
        if let Some(depth) = &depth {
            rendering = rendering.depth_attachment(depth);
        }
        if let Some(stencil) = &stencil {
            rendering = rendering.stencil_attachment(stencil);
        }
        // SAFETY: the command buffer is being recorded outside a scope; views and formats are those that the pipelines
        // were made for.
        unsafe {
            device.cmd_begin_rendering(commands, &rendering);
        }
        let has_local_reads = scope.passes.iter().any(|pass| pass.local.is_some());
        for (pass, made) in plan.passes.iter().zip(&scope.passes) {
            let drawn = self.gpu.labelled(commands, &pass.name, || {
                if pass.local_barrier {
                    self.local_barrier(commands);
                }
                if has_local_reads {
                    self.see_attachments(commands, plan.color.len(), made.local.as_ref());
                }
                let eyes = form.map(|form| (self.plan.stereo, form));
                let target = DrawTarget { extent: plan.extent, rotation, eyes, frame: self.number };
                self.draw(commands, pass, made, target, source, &mut recorded.kept)
            });
            timing.stamp(commands);
            recorded.counts.push(drawn?);
        }
        // SAFETY: the scope was begun above.
        unsafe { device.cmd_end_rendering(commands) };
        Ok(())
    }

    /// Makes what the scope drew so far visible to fragment shaders at their own position; what they read so far may be drawn
    /// over behind it, since colour output comes later than they do.
    fn local_barrier(&self, commands: vk::CommandBuffer) {
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT)
            .src_access_mask(vk::AccessFlags2::COLOR_ATTACHMENT_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::FRAGMENT_SHADER)
            .dst_access_mask(vk::AccessFlags2::INPUT_ATTACHMENT_READ)];
        let info =
            vk::DependencyInfo::default().dependency_flags(vk::DependencyFlags::BY_REGION).memory_barriers(&barrier);
        // SAFETY: local reads are on wherever a Plan has such a barrier, which allows this one within a scope.
        unsafe { self.gpu.raw.cmd_pipeline_barrier2(commands, &info) };
    }

    /// Sets what locations and input attachments the scope's colour attachments are to the pass. It holds for the rest of
    /// the scope, so passes without local reads set it back.
    fn see_attachments(&self, commands: vk::CommandBuffer, attachments: usize, local: Option<&LocalRead>) {
        let Some(extension) = &self.gpu.local_read else { return };
        let straight: Vec<u32> = (0..).take(attachments).collect();
        let (locations, inputs) =
            local.map_or((&straight, &straight), |LocalRead { locations, inputs }| (locations, inputs));
        let locations = vk::RenderingAttachmentLocationInfoKHR::default().color_attachment_locations(locations);
        let inputs = vk::RenderingInputAttachmentIndexInfoKHR::default().color_attachment_input_indices(inputs);
        // SAFETY: the command buffer is being recorded in a scope with these colour attachments, and the extension is on.
        unsafe {
            (extension.fp().cmd_set_rendering_attachment_locations_khr)(commands, &locations);
            (extension.fp().cmd_set_rendering_input_attachment_indices_khr)(commands, &inputs);
        }
    }

    fn draw(
        &self,
        commands: vk::CommandBuffer,
        plan: &plan::Pass,
        pass: &PreparedDraw,
        target: DrawTarget,
        source: &mut dyn DrawSource,
        kept: &mut HeldResources,
    ) -> Result<Counts, Error> {
        let device = &self.gpu.raw;
        if let Some(pipeline) = pass.pipeline {
            let sets = [pass.sets.at(self.number).ok_or_else(unprepared)?.set.raw];
            // SAFETY: the command buffer is being recorded within a scope that the pipeline was made for, and the set has
            // the layout's first set layout.
            unsafe {
                let graphics = vk::PipelineBindPoint::GRAPHICS;
                device.cmd_bind_pipeline(commands, graphics, pipeline);
                device.cmd_bind_descriptor_sets(commands, graphics, pass.state.layout, 0, &sets, &[]);
            }
            self.tell_parts(commands, plan, pass.state.layout);
        }
        let mut recorder = Recorder::new(self.gpu, commands, kept, pass, plan, target);
        let [width, height] = recorder.extent();
        recorder.set_viewport([0.0, 0.0], [width, height].map(f64::from));
        recorder.set_scissor([0, 0], [width, height]);
        recorder.set_cull_mode(CullMode::None);
        recorder.set_front_face(FrontFace::CounterClockwise);
        let draws = match pass.draw {
            Draw::FullScreen if !pass.state.reads_supplied() => {
                recorder.draw(0..3, 0..1);
                1
            }
            Draw::Vertices { count, instances } => {
                self.bind_own_buffers(commands, pass);
                recorder.draw_own(count, instances, pass.indices.is_some());
                1
            }
            Draw::Indirect => {
                self.bind_own_buffers(commands, pass);
                if let Some(counts) = pass.indirect {
                    let counts = self.prepared.physical.buffer(counts, self.number);
                    recorder.draw_indirect(counts.raw, pass.indices.is_some());
                }
                1
            }
            Draw::FullScreen | Draw::Objects(_) | Draw::Casters(_) | Draw::Sky | Draw::Custom => {
                source.record(pass.draw, &mut recorder)?
            }
        };
        let culled = recorder.finish().map_err(|what| Error::Recording { pass: plan.name.to_string(), what })?;
        Ok(Counts { draws, culled })
    }

    /// Binds the vertex and index buffers that the Plan gives the pass.
    fn bind_own_buffers(&self, commands: vk::CommandBuffer, pass: &PreparedDraw) {
        let physical = &self.prepared.physical;
        let vertices: Vec<_> = pass.vertices.iter().map(|it| physical.buffer(*it, self.number).raw).collect();
        // SAFETY: the command buffer is being recorded, and the Plan's usages were checked by the checker.
        unsafe {
            if !vertices.is_empty() {
                self.gpu.raw.cmd_bind_vertex_buffers(commands, 0, &vertices, &vec![0; vertices.len()]);
            }
            if let Some(indices) = pass.indices {
                let indices = physical.buffer(indices, self.number).raw;
                self.gpu.raw.cmd_bind_index_buffer(commands, indices, 0, vk::IndexType::UINT32);
            }
        }
    }

    fn attachment<'v>(&self, plan: &Attachment, views: &'v AttachmentViews) -> vk::RenderingAttachmentInfo<'v> {
        let info = vk::RenderingAttachmentInfo::default()
            .image_view(views.attachment.raw)
            .image_layout(convert::layout(plan.layout))
            .load_op(convert::load(plan.load))
            .store_op(convert::store(plan.store));
        let info = match (&plan.resolve, &views.resolve) {
            (Some(resolve), Some(view)) => info
                .resolve_mode(convert::resolve(resolve.mode))
                .resolve_image_view(view.raw)
                .resolve_image_layout(convert::layout(resolve.layout)),
            _ => info,
        };
        let format = self.plan.image(plan.image).format;
        match plan.clear {
            Some(value) if plan.load == LoadOp::Clear => info.clear_value(match plan.range.aspects {
                Aspects::COLOR => vk::ClearValue { color: convert::clear_color(format, value) },
                Aspects::STENCIL => {
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
                    let stencil = u32::from(value[0] as u8);
                    vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 0.0, stencil } }
                }
                _ => vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: value[0], stencil: 0 } },
            }),
            _ => info,
        }
    }
}
