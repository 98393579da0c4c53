//! The commands of a rendering scope.

use super::command_list::{Command, CommandList, Run, ScopeCommand};
use super::descriptions::part;
use super::draw_target::DrawTarget;
use super::frame::Frame;
use super::labels::labelled;
use super::pass::{PreparedDraw, prepare_draw};
use super::variant::view_mask;
use crate::base::{Error, convert};
use crate::gpu::{Gpu, LocalReads, c_string};
use crate::memory::ViewShape;
use crate::pipeline::or_unused;
use crate::shaders::ShaderLibrary;
use ash::vk;
use framewright_graph::frame::EyeForm;
use framewright_graph::plan::{Attachment, AttachmentKind, ImageId, Plan, RenderScope};
use framewright_graph::vulkan::{LoadOp, Subresources};
use std::sync::Arc;

/// The objects of a rendering scope's passes.
pub(super) fn prepare_scope(
    gpu: &Arc<Gpu>,
    plan: &Plan,
    scope: &RenderScope,
    (shaders, frames): (&mut ShaderLibrary, u32),
) -> Result<Vec<PreparedDraw>, Error> {
    let passes = scope.passes.iter().map(|pass| prepare_draw(gpu, plan, scope, pass, (shaders, frames)));
    let mut passes = passes.collect::<Result<Vec<_>, _>>()?;
    if passes.iter().any(|pass| pass.local.is_some()) {
        // A pass's locations and inputs of attachments hold for the rest of the scope: the others set them back.
        let straight: Vec<u32> = (0..).take(scope.color().len()).collect();
        for pass in &mut passes {
            let drawn = vec![true; straight.len()];
            let back = || LocalReads { locations: straight.clone(), inputs: straight.clone(), drawn };
            pass.local.get_or_insert_with(back);
        }
    }
    Ok(passes)
}

/// Adds the commands in a frame of a scope with the passes `made`.
pub(super) fn push_scope(
    list: &mut CommandList,
    frame: &Frame<'_>,
    scope: &RenderScope,
    made: &mut [PreparedDraw],
) -> Result<(), Error> {
    let plan = frame.plan;
    let (form, rotation) = (plan.eyes(scope), plan.rotation(scope));
    let [width, height, _] = EyeForm::extent(form, [scope.extent[0], scope.extent[1], 1], rotation);
    let info = |planned: &Attachment| attachment(frame, planned);
    let color = scope.color().iter().map(info).collect::<Result<Vec<_>, _>>()?;
    let (depth, stencil) = (scope.depth().map(info).transpose()?, scope.stencil().map(info).transpose()?);
    let begin = ScopeCommand {
        color: Run::add(&mut list.attachments, or_unused(color.into_iter())),
        depth: Run::add(&mut list.attachments, depth),
        stencil: Run::add(&mut list.attachments, stencil),
        extent: vk::Extent2D { width, height },
        layers: EyeForm::layers(form, scope.layers),
        view_mask: view_mask(plan, scope),
    };
    list.push(Command::BeginScope(begin));
    let target = list.target(DrawTarget::new(scope.extent, rotation, form.map(|form| (plan.stereo, form))));
    for (number, (pass, made)) in (0..).zip(scope.passes.iter().zip(made)) {
        list.push_labelled(
            frame.gpu,
            || c_string(&labelled(frame.gpu, &pass.name, Some(&pass.cause))),
            |list| {
                if pass.local_barrier {
                    list.push(Command::LocalBarrier);
                }
                if let Some(local) = &made.local {
                    list.push(Command::SeeAttachments(Box::new(local.clone())));
                }
                let draw = made.command(list, frame, pass, (number, target))?;
                list.push(Command::Draw(draw));
                Ok(())
            },
        )?;
    }
    list.push(Command::EndScope);
    Ok(())
}

/// An attachment as Vulkan takes it. The images must live as long as it is used.
fn attachment(frame: &Frame<'_>, planned: &Attachment) -> Result<vk::RenderingAttachmentInfo<'static>, Error> {
    let view = |id: ImageId, range: Subresources| {
        let image = frame.plan.image(id);
        // A view for an attachment has all planes.
        let range = Subresources { aspects: image.format.aspects(), ..part(image, range) };
        let shape = if range.layers > 1 { ViewShape::Layers } else { ViewShape::Flat };
        frame.image(id).view(range, shape)
    };
    let mut info = vk::RenderingAttachmentInfo::default()
        .image_view(view(planned.image, planned.range)?)
        .image_layout(convert::layout(planned.layout))
        .load_op(convert::load(planned.load))
        .store_op(convert::store(planned.store));
    if let Some(resolve) = &planned.resolve {
        info = info
            .resolve_mode(convert::resolve(resolve.mode))
            .resolve_image_view(view(resolve.image, resolve.range)?)
            .resolve_image_layout(convert::layout(resolve.layout));
    }
    let format = frame.plan.image(planned.image).format;
    Ok(match planned.clear {
        Some(value) if planned.load == LoadOp::Clear => info.clear_value(match planned.kind {
            AttachmentKind::Color => vk::ClearValue { color: convert::clear_color(format, value) },
            AttachmentKind::Stencil => {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
                let stencil = u32::from(value[0] as u8);
                vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 0.0, stencil } }
            }
            AttachmentKind::Depth => {
                #[allow(clippy::cast_possible_truncation, reason = "no format holds more")]
                let depth = value[0] as f32;
                vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 } }
            }
        }),
        _ => info,
    })
}
