//! The planes that can be in each layout, and the usages of which an image in it must have one.

use crate::plan::Image;
use crate::vulkan::{Aspects, Layout, Usage, name_of};

/// Why these planes of an image can't be in a layout; `None`: they can.
pub(super) fn problem(image: &Image, of: Aspects, layout: Layout) -> Option<String> {
    let all = image.format.aspects();
    let of_both = matches!(layout, Layout::DepthStencilAttachmentOptimal | Layout::DepthStencilReadOnlyOptimal);
    // Work outside of the frame may name both planes at once.
    let both = of_both && all.contains(Aspects::DEPTH);
    if !both && !planes(layout, all).contains(of) {
        return Some(format!("{}, which not all of its planes can be in", name_of(&layout)));
    }
    let usable = image.usage.intersects(usage_for(layout));
    (!usable).then(|| format!("{}, for which it has no usage", name_of(&layout)))
}

/// The planes, of an image that has `planes`, that can be in a layout: where there are depth and stencil each has its own.
pub(super) fn planes(layout: Layout, planes: Aspects) -> Aspects {
    let both = Aspects::DEPTH | Aspects::STENCIL;
    match layout {
        Layout::ColorAttachmentOptimal | Layout::PresentSrcKhr | Layout::FragmentShadingRateAttachmentOptimalKhr => {
            planes & Aspects::COLOR
        }
        Layout::DepthStencilAttachmentOptimal | Layout::DepthStencilReadOnlyOptimal if planes == both => {
            Aspects::empty()
        }
        Layout::DepthStencilAttachmentOptimal | Layout::DepthStencilReadOnlyOptimal => planes & both,
        Layout::DepthAttachmentOptimal | Layout::DepthReadOnlyOptimal if planes != both => Aspects::empty(),
        Layout::StencilAttachmentOptimal | Layout::StencilReadOnlyOptimal if planes != both => Aspects::empty(),
        Layout::DepthAttachmentOptimal | Layout::DepthReadOnlyOptimal => Aspects::DEPTH,
        Layout::StencilAttachmentOptimal | Layout::StencilReadOnlyOptimal => Aspects::STENCIL,
        Layout::Undefined
        | Layout::General
        | Layout::ShaderReadOnlyOptimal
        | Layout::TransferSrcOptimal
        | Layout::TransferDstOptimal
        | Layout::RenderingLocalReadKhr => planes,
    }
}

/// The usages of which an image must have one to be in a layout.
fn usage_for(layout: Layout) -> Usage {
    match layout {
        Layout::ColorAttachmentOptimal => Usage::COLOR_ATTACHMENT,
        Layout::DepthStencilAttachmentOptimal | Layout::DepthAttachmentOptimal | Layout::StencilAttachmentOptimal => {
            Usage::DEPTH_STENCIL_ATTACHMENT
        }
        Layout::DepthStencilReadOnlyOptimal | Layout::DepthReadOnlyOptimal | Layout::StencilReadOnlyOptimal => {
            Usage::DEPTH_STENCIL_ATTACHMENT
        }
        Layout::ShaderReadOnlyOptimal => Usage::SAMPLED | Usage::INPUT_ATTACHMENT,
        Layout::TransferSrcOptimal => Usage::TRANSFER_SRC,
        Layout::TransferDstOptimal => Usage::TRANSFER_DST,
        Layout::RenderingLocalReadKhr => Usage::INPUT_ATTACHMENT,
        Layout::FragmentShadingRateAttachmentOptimalKhr => Usage::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR,
        Layout::Undefined | Layout::General | Layout::PresentSrcKhr => Usage::all(),
    }
}
