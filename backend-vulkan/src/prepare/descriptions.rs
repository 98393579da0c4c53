//! The Plan's images and buffers as they are made on a device.

use framewright_graph::device::{BufferDescriptor, ImageDescriptor};
use framewright_graph::frame::EyeForm;
use framewright_graph::plan::{self, Role};
use framewright_graph::vulkan::{BufferUsage, Subresources, Usage};

/// The description of a Plan's image on this device. Images that outlive the frame can always be read back.
pub(crate) fn descriptor(image: &plan::Image) -> ImageDescriptor {
    let usage = match image.role {
        Role::Transient(_) => image.usage,
        Role::Persistent { .. } => image.usage | Usage::TRANSFER_SRC | Usage::TRANSFER_DST,
        Role::External { .. } => image.usage | Usage::TRANSFER_SRC,
    };
    let plan::Image { format, shape, mips, samples, sharing, .. } = *image;
    let layers = image.made_layers();
    ImageDescriptor { format, shape, extent: image.made(), mips, layers, samples, usage, sharing }
}

/// The description of a Plan's buffer on this device. What outlives the frame can be written and read back.
pub(crate) fn buffer_descriptor(buffer: &plan::Buffer) -> BufferDescriptor {
    let usage = match buffer.role {
        Role::Transient(_) => buffer.usage,
        Role::Persistent { .. } | Role::External { .. } => {
            buffer.usage | BufferUsage::TRANSFER_SRC | BufferUsage::TRANSFER_DST
        }
    };
    BufferDescriptor { bytes: buffer.bytes, usage, sharing: buffer.sharing }
}

/// `range` of `image` with its counts as numbers; of both eyes' layers both.
pub(crate) fn part(image: &plan::Image, range: Subresources) -> Subresources {
    let mips = range.mips.min(image.mips.saturating_sub(range.base_mip));
    match image.eyes {
        Some(EyeForm::Layers) => Subresources { mips, base_layer: 0, layers: image.made_layers(), ..range },
        Some(EyeForm::Halves) | None => {
            let layers = range.layers.min(image.layers.saturating_sub(range.base_layer));
            Subresources { mips, layers, ..range }
        }
    }
}

/// The images or buffers that `first` becomes, one frame after the other, until it is itself again. The role's `becomes` must
/// be a permutation.
pub(crate) fn cycle<'p>(first: u32, role: impl Fn(u32) -> &'p Role) -> impl Iterator<Item = u32> {
    let next = move |at: &u32| match role(*at) {
        Role::Persistent { becomes, .. } => Some(*becomes).filter(|next| *next != first),
        Role::Transient(_) | Role::External { .. } => None,
    };
    std::iter::successors(Some(first), next)
}
