//! A rendering scope's objects: views of its attachments, and what its passes need.

use super::descriptions::part;
use super::frame::Frame;
use super::history::RingCache;
use super::pass::{DrawCommands, PreparedDraw, prepare_draw};
use super::physical::PhysicalResources;
use super::variant::view_mask;
use crate::base::{Error, convert};
use crate::gpu::{Gpu, LocalRead};
use crate::memory::{View, ViewShape};
use crate::pipeline::or_unused;
use crate::shaders::ShaderLibrary;
use ash::vk;
use framewright_graph::frame::{EyeForm, Stereo};
use framewright_graph::plan::{Attachment, ImageId, Plan, RenderScope, Resource};
use framewright_graph::vulkan::{Aspects, LoadOp, Rotation, Subresources};
use std::sync::Arc;

/// A rendering scope's objects.
pub(crate) struct PreparedScope {
    views: RingCache<ScopeViews>,
    pub(crate) passes: Vec<PreparedDraw>,
}

/// A rendering scope's attachments.
struct ScopeViews {
    color: Vec<AttachmentViews>,
    depth: Option<Arc<AttachmentViews>>,
    /// Depth and stencil of one image share a view.
    stencil: Option<Arc<AttachmentViews>>,
}

/// An attachment's view and that of its resolve target.
struct AttachmentViews {
    attachment: View,
    resolve: Option<View>,
}

/// What a rendering scope records.
pub(crate) struct ScopeCommands {
    pub(crate) color: Vec<vk::RenderingAttachmentInfo<'static>>,
    pub(crate) depth: Option<vk::RenderingAttachmentInfo<'static>>,
    pub(crate) stencil: Option<vk::RenderingAttachmentInfo<'static>>,
    pub(crate) area: vk::Rect2D,
    pub(crate) layers: u32,
    pub(crate) view_mask: u32,
    pub(crate) target: DrawTarget,
    pub(crate) passes: Vec<DrawCommands>,
}

/// What a pass draws into.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawTarget {
    /// Width and height, those of the turned picture; of two eyes one's.
    pub(crate) extent: [u32; 2],
    pub(crate) rotation: Rotation,
    /// How both eyes are drawn for at once, and into what, if they are.
    pub(crate) eyes: Option<(Stereo, EyeForm)>,
}

impl PreparedScope {
    /// The objects of `scope`; views and sets are made by [`PreparedScope::commands`].
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        physical: &PhysicalResources,
        scope: &RenderScope,
        shaders: &mut ShaderLibrary,
    ) -> Result<PreparedScope, Error> {
        let mut passes = Vec::new();
        for pass in &scope.passes {
            passes.push(prepare_draw(gpu, plan, physical, scope, pass, shaders)?);
        }
        if passes.iter().any(|pass| pass.local.is_some()) {
            // What a pass says of its attachments holds for the rest of the scope: the others set it back.
            let straight: Vec<u32> = (0..).take(scope.color.len()).collect();
            for pass in &mut passes {
                let back = || LocalRead { locations: straight.clone(), inputs: straight.clone() };
                pass.local.get_or_insert_with(back);
            }
        }
        let attachments = scope.color.iter().chain(&scope.depth).chain(&scope.stencil);
        let images = attachments.flat_map(|it| [Some(it.image), it.resolve.as_ref().map(|resolve| resolve.image)]);
        let period = physical.period(images.flatten().map(Resource::Image));
        Ok(PreparedScope { views: RingCache::new(period), passes })
    }

    /// What the scope records in a frame.
    pub(super) fn commands(&mut self, frame: &Frame<'_>, scope: &RenderScope) -> Result<ScopeCommands, Error> {
        let plan = frame.plan;
        let views = self.views.prepare(frame.number, || ScopeViews::new(frame, scope))?;
        let info = |(planned, views)| attachment(plan, planned, views);
        let (form, rotation) = (plan.eyes(scope), plan.rotation(scope));
        let [width, height, _] = EyeForm::extent(form, [scope.extent[0], scope.extent[1], 1], rotation);
        let passes = self.passes.iter_mut().zip(&scope.passes).map(|(made, pass)| made.commands(frame, pass));
        Ok(ScopeCommands {
            color: or_unused(scope.color.iter().zip(&views.color).map(info)),
            depth: scope.depth.as_ref().zip(views.depth.as_deref()).map(info),
            stencil: scope.stencil.as_ref().zip(views.stencil.as_deref()).map(info),
            area: vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } },
            layers: EyeForm::layers(form, scope.layers),
            view_mask: view_mask(plan, scope),
            target: DrawTarget { extent: scope.extent, rotation, eyes: form.map(|form| (plan.stereo, form)) },
            passes: passes.collect::<Result<_, _>>()?,
        })
    }

    /// Forgets views and sets.
    pub(super) fn forget(&mut self) {
        self.views.forget();
        self.passes.iter_mut().for_each(|pass| pass.sets.forget());
    }
}

impl ScopeViews {
    fn new(frame: &Frame<'_>, scope: &RenderScope) -> Result<ScopeViews, Error> {
        let view = |id: ImageId, range: Subresources| {
            let image = frame.plan.image(id);
            // A view for an attachment has all planes.
            let range = Subresources { aspects: image.format.aspects(), ..part(image, range) };
            let shape = if range.layers > 1 { ViewShape::Layers } else { ViewShape::Flat };
            View::new(frame.image(id), range, shape)
        };
        let views = |attachment: &Attachment| {
            let resolve = attachment.resolve.as_ref().map(|resolve| view(resolve.image, resolve.range)).transpose()?;
            Ok::<_, Error>(AttachmentViews { attachment: view(attachment.image, attachment.range)?, resolve })
        };
        let color = scope.color.iter().map(views).collect::<Result<_, _>>()?;
        let depth = scope.depth.as_ref().map(views).transpose()?.map(Arc::new);
        let stencil = match (&scope.depth, &scope.stencil, &depth) {
            (Some(of_depth), Some(of_stencil), Some(of_both)) if shares(of_depth, of_stencil) => Some(of_both.clone()),
            (_, of_stencil, _) => of_stencil.as_ref().map(views).transpose()?.map(Arc::new),
        };
        Ok(ScopeViews { color, depth, stencil })
    }
}

/// Whether two attachments are planes of one image, and their resolve targets too.
fn shares(depth: &Attachment, stencil: &Attachment) -> bool {
    let target = |it: &Attachment| it.resolve.as_ref().map(|resolve| resolve.image);
    depth.image == stencil.image && (target(stencil).is_none() || target(depth) == target(stencil))
}

/// An attachment as Vulkan takes it. The views must live as long as it is used.
fn attachment(plan: &Plan, planned: &Attachment, views: &AttachmentViews) -> vk::RenderingAttachmentInfo<'static> {
    let info = vk::RenderingAttachmentInfo::default()
        .image_view(views.attachment.raw)
        .image_layout(convert::layout(planned.layout))
        .load_op(convert::load(planned.load))
        .store_op(convert::store(planned.store));
    let info = match (&planned.resolve, &views.resolve) {
        (Some(resolve), Some(view)) => info
            .resolve_mode(convert::resolve(resolve.mode))
            .resolve_image_view(view.raw)
            .resolve_image_layout(convert::layout(resolve.layout)),
        _ => info,
    };
    let format = plan.image(planned.image).format;
    match planned.clear {
        Some(value) if planned.load == LoadOp::Clear => info.clear_value(match planned.range.aspects {
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
