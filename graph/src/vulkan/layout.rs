//! The table of layouts: what happens in each, and which images can be left in it.

use super::access::AccessKind;
use super::{Accesses, Aspects, Layout, Usage};

/// What a layout allows: a row for each.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LayoutRow {
    pub(crate) layout: Layout,
    /// Vulkan's name.
    pub(crate) name: &'static str,
    /// Images that can be left in it.
    pub(crate) holds: LayoutImages,
    /// What happens in it; the usage for the first is what the layout needs. Everything can happen in `GENERAL`.
    pub(crate) kinds: &'static [AccessKind],
    /// Whether the writes of these kinds happen too, and not only their reads.
    pub(crate) written: bool,
}

/// The images that a frame can take over or leave in a layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LayoutImages {
    /// All.
    Any,
    /// Colour.
    Color,
    /// Colour with one sample.
    ColorOfOneSample,
    /// Depth, with stencil or without.
    Depth,
    /// Depth without stencil.
    DepthAlone,
    /// None: only one plane is in it, or a part of a frame.
    None,
}

/// The rows, in the order of [`Layout`].
pub(crate) const LAYOUTS: &[LayoutRow] = {
    use AccessKind::{
        ColorAttachment, DepthAttachment, InputAttachment, Present, Sampled, ShadingRate, TransferSource,
        TransferTarget,
    };
    const fn row(
        layout: Layout,
        name: &'static str,
        holds: LayoutImages,
        kinds: &'static [AccessKind],
        written: bool,
    ) -> LayoutRow {
        LayoutRow { layout, name, holds, kinds, written }
    }
    const READ_ONLY_DEPTH: &[AccessKind] = &[DepthAttachment, Sampled, InputAttachment];
    &[
        row(Layout::Undefined, "UNDEFINED", LayoutImages::Any, &[], false),
        row(Layout::General, "GENERAL", LayoutImages::Any, &[], true),
        row(Layout::ColorAttachmentOptimal, "COLOR_ATTACHMENT_OPTIMAL", LayoutImages::Color, &[ColorAttachment], true),
        row(
            Layout::DepthStencilAttachmentOptimal,
            "DEPTH_STENCIL_ATTACHMENT_OPTIMAL",
            LayoutImages::Depth,
            &[DepthAttachment],
            true,
        ),
        row(
            Layout::DepthStencilReadOnlyOptimal,
            "DEPTH_STENCIL_READ_ONLY_OPTIMAL",
            LayoutImages::Depth,
            READ_ONLY_DEPTH,
            false,
        ),
        row(
            Layout::DepthAttachmentOptimal,
            "DEPTH_ATTACHMENT_OPTIMAL",
            LayoutImages::DepthAlone,
            &[DepthAttachment],
            true,
        ),
        row(Layout::DepthReadOnlyOptimal, "DEPTH_READ_ONLY_OPTIMAL", LayoutImages::DepthAlone, READ_ONLY_DEPTH, false),
        row(
            Layout::StencilAttachmentOptimal,
            "STENCIL_ATTACHMENT_OPTIMAL",
            LayoutImages::None,
            &[DepthAttachment],
            true,
        ),
        row(Layout::StencilReadOnlyOptimal, "STENCIL_READ_ONLY_OPTIMAL", LayoutImages::None, READ_ONLY_DEPTH, false),
        row(
            Layout::ShaderReadOnlyOptimal,
            "SHADER_READ_ONLY_OPTIMAL",
            LayoutImages::Any,
            &[Sampled, InputAttachment],
            false,
        ),
        row(Layout::TransferSrcOptimal, "TRANSFER_SRC_OPTIMAL", LayoutImages::Any, &[TransferSource], false),
        row(Layout::TransferDstOptimal, "TRANSFER_DST_OPTIMAL", LayoutImages::Any, &[TransferTarget], true),
        row(Layout::PresentSrcKhr, "PRESENT_SRC_KHR", LayoutImages::ColorOfOneSample, &[Present], false),
        row(Layout::RenderingLocalReadKhr, "RENDERING_LOCAL_READ_KHR", LayoutImages::None, &[InputAttachment], false),
        row(
            Layout::FragmentShadingRateAttachmentOptimalKhr,
            "FRAGMENT_SHADING_RATE_ATTACHMENT_OPTIMAL_KHR",
            LayoutImages::ColorOfOneSample,
            &[ShadingRate],
            false,
        ),
    ]
};

impl Layout {
    pub(crate) const fn row(self) -> &'static LayoutRow {
        &LAYOUTS[self as usize]
    }

    /// The usage that an image must have to be in it.
    pub(crate) const fn usage(self) -> Usage {
        match self.row().kinds {
            [first, ..] => first.usage(),
            [] => Usage::empty(),
        }
    }

    /// Whether these planes of an image that has the planes `all` can be in it while work uses them. Where there are depth and stencil
    /// each plane has a layout of its own.
    pub(crate) fn is_of_planes(self, planes: Aspects, all: Aspects) -> bool {
        let both = all.contains(Aspects::DEPTH.union(Aspects::STENCIL));
        match self {
            Layout::Undefined | Layout::PresentSrcKhr | Layout::RenderingLocalReadKhr => false,
            Layout::General
            | Layout::ShaderReadOnlyOptimal
            | Layout::TransferSrcOptimal
            | Layout::TransferDstOptimal => true,
            Layout::ColorAttachmentOptimal | Layout::FragmentShadingRateAttachmentOptimalKhr => {
                planes == Aspects::COLOR
            }
            Layout::DepthStencilAttachmentOptimal | Layout::DepthStencilReadOnlyOptimal => {
                !both && !planes.intersects(Aspects::COLOR)
            }
            Layout::DepthAttachmentOptimal | Layout::DepthReadOnlyOptimal => both && planes == Aspects::DEPTH,
            Layout::StencilAttachmentOptimal | Layout::StencilReadOnlyOptimal => both && planes == Aspects::STENCIL,
        }
    }

    /// The accesses that happen in it, `GENERAL` apart.
    pub(crate) fn accesses(self) -> Accesses {
        let LayoutRow { kinds, written, .. } = self.row();
        kinds.iter().fold(Accesses::empty(), |all, kind| all | kind.accesses(true, *written))
    }
}

/// The rows stand in the order of the layouts.
const _: () = {
    let mut row = 0;
    while row < LAYOUTS.len() {
        assert!(LAYOUTS[row].layout as usize == row);
        row += 1;
    }
    assert!(Layout::FragmentShadingRateAttachmentOptimalKhr as usize + 1 == LAYOUTS.len());
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vulkan::name_of;

    #[test]
    fn layouts_have_the_names_that_plans_have() {
        for row in LAYOUTS {
            assert_eq!(row.name, name_of(&row.layout));
        }
    }
}
