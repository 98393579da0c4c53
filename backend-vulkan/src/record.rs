//! A Plan's steps as commands.

use crate::convert;
use crate::device::Shared;
use crate::error::Error;
use crate::poison;
use crate::prepare::{Pass, Prepared, Scope, Views};
use crate::recorder::{CullMode, DrawSource, FrontFace, Kept, Recorder};
use crate::timing::Timing;
use ash::vk;
use framewright_graph::frame::Draw;
use framewright_graph::plan::{
    Attachment, ImageBarrier, ImageState, MemoryBarrier, Plan, RenderScope, Role, Step, Subresources, Transfer, Work,
};
use framewright_graph::vocabulary::{Layout, LoadOp};

/// What a frame is recorded from.
pub(crate) struct Frame<'f> {
    pub(crate) shared: &'f Shared,
    pub(crate) plan: &'f Plan,
    pub(crate) prepared: &'f Prepared,
    pub(crate) poison: bool,
}

/// A recorded frame.
#[derive(Default)]
pub(crate) struct Recorded {
    /// Draw calls of each pass.
    pub(crate) draws: Vec<u32>,
    kept: Kept,
}

impl Frame<'_> {
    /// Records every step; returns the number of draw calls of each pass, in order, and what the commands use.
    pub(crate) fn record(
        &self,
        commands: vk::CommandBuffer,
        source: &mut dyn DrawSource,
        timing: &mut Timing,
    ) -> Result<Recorded, Error> {
        let mut recorded = Recorded::default();
        timing.begin(commands);
        self.promise_outputs(commands);
        for (index, (step, scope)) in self.plan.steps.iter().zip(&self.prepared.scopes).enumerate() {
            let label = format!("step {index}: {}", title(self.plan, step));
            self.shared.labelled(commands, &label, || {
                if self.poison {
                    poison::record(self, commands, step);
                } else {
                    let images = step.image_barriers.iter().map(|it| self.image_barrier(it)).collect::<Vec<_>>();
                    barriers(self.shared, commands, &memory_barriers(&step.memory_barriers), &images);
                }
                match (&step.work, scope) {
                    (Work::Render(plan), Some(scope)) => {
                        self.render(commands, plan, scope, source, timing, &mut recorded)?
                    }
                    (Work::Resolve(transfer), _) => self.resolve(commands, transfer),
                    (Work::Copy(transfer), _) => self.copy(commands, transfer),
                    _ => {}
                }
                timing.stamp(commands);
                Ok::<_, Error>(())
            })?;
        }
        Ok(recorded)
    }

    /// Puts outputs into the state that the Plan relies on when the frame begins.
    fn promise_outputs(&self, commands: vk::CommandBuffer) {
        let promised =
            self.plan.images.iter().zip(&self.prepared.images).filter_map(|(image, made)| match image.role {
                Role::Output { before, .. } if before.layout != Layout::Undefined => {
                    let range = Subresources::all(image.format, image.mips, image.layers);
                    Some(state_change(made.raw, range, None, before))
                }
                _ => None,
            });
        barriers(self.shared, commands, &[], &promised.collect::<Vec<_>>());
    }

    /// A barrier of the Plan.
    pub(crate) fn image_barrier(&self, barrier: &ImageBarrier) -> vk::ImageMemoryBarrier2<'static> {
        vk::ImageMemoryBarrier2::default()
            .src_stage_mask(convert::stages(barrier.src_stages))
            .src_access_mask(convert::accesses(barrier.src_accesses))
            .dst_stage_mask(convert::stages(barrier.dst_stages))
            .dst_access_mask(convert::accesses(barrier.dst_accesses))
            .old_layout(convert::layout(barrier.old_layout))
            .new_layout(convert::layout(barrier.new_layout))
            .image(self.prepared.images[barrier.image.0 as usize].raw)
            .subresource_range(convert::range(barrier.range))
    }

    fn render(
        &self,
        commands: vk::CommandBuffer,
        plan: &RenderScope,
        scope: &Scope,
        source: &mut dyn DrawSource,
        timing: &mut Timing,
        recorded: &mut Recorded,
    ) -> Result<(), Error> {
        let device = &self.shared.raw;
        let info = |(attachment, views)| self.attachment(attachment, views);
        let color: Vec<_> = plan.color.iter().zip(&scope.color).map(info).collect();
        let depth = plan.depth.as_ref().zip(scope.depth.as_ref()).map(info);
        let [width, height] = plan.extent;
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        let mut rendering =
            vk::RenderingInfo::default().render_area(area).layer_count(plan.layers).color_attachments(&color);
        if let Some(depth) = &depth {
            rendering = rendering.depth_attachment(depth);
        }
        #[allow(clippy::cast_precision_loss, reason = "attachments are at most 2^24 texels wide")]
        let viewport = vk::Viewport::default().width(width as f32).height(height as f32).max_depth(1.0);
        // SAFETY: the command buffer is being recorded outside a scope; views and formats are those that the pipelines
        // were made for.
        unsafe {
            device.cmd_begin_rendering(commands, &rendering);
            device.cmd_set_viewport(commands, 0, &[viewport]);
            device.cmd_set_scissor(commands, 0, &[area]);
        }
        for (pass, made) in plan.passes.iter().zip(&scope.passes) {
            let drawn = self.shared.labelled(commands, &pass.name, || {
                self.draw(commands, &pass.name, made, plan.extent, source, &mut recorded.kept)
            });
            timing.stamp(commands);
            recorded.draws.push(drawn?);
        }
        // SAFETY: the scope was begun above.
        unsafe { device.cmd_end_rendering(commands) };
        Ok(())
    }

    fn draw(
        &self,
        commands: vk::CommandBuffer,
        name: &str,
        pass: &Pass,
        extent: [u32; 2],
        source: &mut dyn DrawSource,
        kept: &mut Kept,
    ) -> Result<u32, Error> {
        let device = &self.shared.raw;
        let sets = [pass.own.set.raw];
        // SAFETY: the command buffer is being recorded within a scope that the pipeline was made for, and the set has the
        // layout's first set layout.
        unsafe {
            let graphics = vk::PipelineBindPoint::GRAPHICS;
            device.cmd_bind_pipeline(commands, graphics, pass.pipeline);
            device.cmd_bind_descriptor_sets(commands, graphics, pass.state.layout, 0, &sets, &[]);
        }
        let mut recorder = Recorder::new(self.shared, commands, kept, &pass.state, extent);
        recorder.set_cull_mode(CullMode::None);
        recorder.set_front_face(FrontFace::CounterClockwise);
        let drawn = if pass.draw == Draw::FullScreen {
            recorder.draw(0..3, 0..1);
            1
        } else {
            source.record(pass.draw, &mut recorder)?
        };
        recorder.finish().map_err(|what| Error::Recording { pass: name.to_owned(), what })?;
        Ok(drawn)
    }

    fn attachment<'v>(&self, plan: &Attachment, views: &'v Views) -> vk::RenderingAttachmentInfo<'v> {
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
            Some(value) if plan.load == LoadOp::Clear => info.clear_value(if format.is_depth() {
                vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: value[0], stencil: 0 } }
            } else {
                vk::ClearValue { color: clear_color(format.is_integer(), value) }
            }),
            _ => info,
        }
    }

    fn resolve(&self, commands: vk::CommandBuffer, transfer: &Transfer) {
        let region = vk::ImageResolve2::default()
            .src_subresource(convert::layers(transfer.source_range))
            .dst_subresource(convert::layers(transfer.target_range))
            .extent(extent(transfer.extent));
        let regions = [region];
        let info = vk::ResolveImageInfo2::default()
            .src_image(self.prepared.images[transfer.source.0 as usize].raw)
            .src_image_layout(vk::ImageLayout::TRANSFER_SRC_OPTIMAL)
            .dst_image(self.prepared.images[transfer.target.0 as usize].raw)
            .dst_image_layout(vk::ImageLayout::TRANSFER_DST_OPTIMAL)
            .regions(&regions);
        // SAFETY: the command buffer is being recorded outside a scope, and both parts exist.
        unsafe { self.shared.raw.cmd_resolve_image2(commands, &info) };
    }

    fn copy(&self, commands: vk::CommandBuffer, transfer: &Transfer) {
        let region = vk::ImageCopy2::default()
            .src_subresource(convert::layers(transfer.source_range))
            .dst_subresource(convert::layers(transfer.target_range))
            .extent(extent(transfer.extent));
        let regions = [region];
        let info = vk::CopyImageInfo2::default()
            .src_image(self.prepared.images[transfer.source.0 as usize].raw)
            .src_image_layout(vk::ImageLayout::TRANSFER_SRC_OPTIMAL)
            .dst_image(self.prepared.images[transfer.target.0 as usize].raw)
            .dst_image_layout(vk::ImageLayout::TRANSFER_DST_OPTIMAL)
            .regions(&regions);
        // SAFETY: the command buffer is being recorded outside a scope, and both parts exist.
        unsafe { self.shared.raw.cmd_copy_image2(commands, &info) };
    }
}

/// The memory barriers of a step.
pub(crate) fn memory_barriers(barriers: &[MemoryBarrier]) -> Vec<vk::MemoryBarrier2<'static>> {
    barriers
        .iter()
        .map(|it| {
            vk::MemoryBarrier2::default()
                .src_stage_mask(convert::stages(it.src_stages))
                .src_access_mask(convert::accesses(it.src_accesses))
                .dst_stage_mask(convert::stages(it.dst_stages))
                .dst_access_mask(convert::accesses(it.dst_accesses))
        })
        .collect()
}

/// Records barriers in one call; none if there are none.
pub(crate) fn barriers(
    shared: &Shared,
    commands: vk::CommandBuffer,
    memory: &[vk::MemoryBarrier2<'_>],
    images: &[vk::ImageMemoryBarrier2<'_>],
) {
    if memory.is_empty() && images.is_empty() {
        return;
    }
    let info = vk::DependencyInfo::default().memory_barriers(memory).image_memory_barriers(images);
    // SAFETY: the command buffer is being recorded outside a scope, and the images live.
    unsafe { shared.raw.cmd_pipeline_barrier2(commands, &info) };
}

/// A barrier from one state of an image to another; from `None` nothing is kept.
pub(crate) fn state_change(
    image: vk::Image,
    range: Subresources,
    from: Option<ImageState>,
    to: ImageState,
) -> vk::ImageMemoryBarrier2<'static> {
    let barrier = vk::ImageMemoryBarrier2::default()
        .dst_stage_mask(convert::stages(to.stages))
        .dst_access_mask(convert::accesses(to.accesses))
        .new_layout(convert::layout(to.layout))
        .image(image)
        .subresource_range(convert::range(range));
    from.map_or(barrier, |from| {
        barrier
            .src_stage_mask(convert::stages(from.stages))
            .src_access_mask(convert::accesses(from.accesses))
            .old_layout(convert::layout(from.layout))
    })
}

/// A colour in the form that the format's components need.
fn clear_color(integer: bool, value: [f32; 4]) -> vk::ClearColorValue {
    if integer {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates, as a clear should")]
        let uint32 = value.map(|component| component as u32);
        vk::ClearColorValue { uint32 }
    } else {
        vk::ClearColorValue { float32: value }
    }
}

fn extent([width, height, depth]: [u32; 3]) -> vk::Extent3D {
    vk::Extent3D { width, height, depth }
}

/// What a debugger shows for a step.
fn title(plan: &Plan, step: &Step) -> String {
    match &step.work {
        Work::Render(scope) => scope.passes.iter().map(|pass| &*pass.name).collect::<Vec<_>>().join(", "),
        Work::Dispatch(pass) => pass.name.to_string(),
        Work::Resolve(transfer) => format!("resolve {}", plan.image(transfer.source).name),
        Work::Copy(transfer) => format!("copy {}", plan.image(transfer.source).name),
        Work::Export => "export".to_owned(),
    }
}
