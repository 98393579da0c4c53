//! Contents of images and buffers, copied to the host.

use super::barriers::{barriers, memory_change, state_change};
use super::rotate_texels;
use super::transfer::{ImageSide, TransferSide, copy_between};
use crate::base::{Error, convert};
use crate::gpu::Gpu;
use crate::memory::{Image, MemoryUse, RawBuffer};
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::vulkan::{Accesses, Aspects, Format, Layout, Rotation, Stages, State, Subresources};
use std::sync::Arc;

/// Texels of one plane of one mip level of an image: of the upright picture, where the image holds a rotated one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Texels {
    /// The format of a texel. If it has depth and stencil, one plane is read: the depth takes 2 bytes for `D16_UNORM`, else 4; the
    /// stencil takes 1.
    pub format: Format,
    /// Width, height, depth.
    pub extent: [u32; 3],
    /// Array layers.
    pub layers: u32,
    /// Layer after layer, slice after slice, rows from the top, without padding; the machine's byte order.
    pub bytes: Vec<u8>,
}

/// The state of an image while it is copied from.
const COPIED: State =
    State { stages: Stages::COPY, accesses: Accesses::TRANSFER_READ, layout: Layout::TransferSrcOptimal };

/// A readback on its way: the device copies into it, and when that is done the host takes it out.
pub(crate) struct Readback {
    buffer: RawBuffer,
    bytes: u64,
    plane: Aspects,
    mip: u32,
    /// Width, height and depth that are read.
    extent: [u32; 3],
}

impl Readback {
    /// Room for one plane of one mip level of such an image, of which so much is read.
    pub(crate) fn of_image(
        gpu: &Arc<Gpu>,
        descriptor: &ImageDescriptor,
        plane: Aspects,
        (mip, extent): (u32, [u32; 3]),
    ) -> Result<Readback, Error> {
        let bytes = texels_bytes(descriptor, plane, extent);
        Ok(Readback { buffer: buffer(gpu, bytes)?, bytes, plane, mip, extent })
    }

    /// Reads so much of such an image from now on, at most what there is room for.
    pub(crate) fn read_as_far_as(&mut self, descriptor: &ImageDescriptor, extent: [u32; 3]) {
        (self.bytes, self.extent) = (texels_bytes(descriptor, self.plane, extent), extent);
    }

    /// Room for a buffer.
    pub(crate) fn of_buffer(gpu: &Arc<Gpu>, bytes: u64) -> Result<Readback, Error> {
        Ok(Readback { buffer: buffer(gpu, bytes)?, bytes, plane: Aspects::empty(), mip: 0, extent: [0; 3] })
    }

    /// Copies from `image`, which is in the state `state` and stays in it.
    pub(crate) fn record_image(&self, gpu: &Gpu, commands: vk::CommandBuffer, image: &Image, state: State) {
        let descriptor = image.descriptor;
        let whole = Subresources::all(descriptor.format, descriptor.mips, descriptor.layers);
        barriers(gpu, commands, &[], &[state_change(image.raw, whole, state, COPIED)]);
        let range = Subresources { aspects: self.plane, base_mip: self.mip, mips: 1, ..whole };
        let extent = convert::extent(self.extent);
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        let source = TransferSide::Image(ImageSide { image: image.raw, range, extent, layout });
        copy_between(gpu, commands, source, self.place());
        barriers(gpu, commands, &[to_host()], &[state_change(image.raw, whole, COPIED, state)]);
    }

    /// Copies from `buffer`, which is in the state `state` and stays in it.
    pub(crate) fn record_buffer(&self, gpu: &Gpu, commands: vk::CommandBuffer, buffer: &RawBuffer, state: State) {
        barriers(gpu, commands, &[memory_change(state, COPIED)], &[]);
        copy_between(gpu, commands, TransferSide::Buffer { buffer: buffer.raw, bytes: self.bytes }, self.place());
        barriers(gpu, commands, &[to_host(), memory_change(COPIED, state)], &[]);
    }

    fn place(&self) -> TransferSide {
        TransferSide::Buffer { buffer: self.buffer.raw, bytes: self.bytes }
    }

    /// The bytes. The copy must have been waited for.
    pub(crate) fn bytes(&self) -> Result<Vec<u8>, Error> {
        self.buffer.contents(usize::try_from(self.bytes).unwrap_or(usize::MAX)).map(<[u8]>::to_vec)
    }

    /// The texels of the upright picture that an image of this description holds, turned so. The copy must have been waited
    /// for.
    pub(crate) fn texels(&self, descriptor: &ImageDescriptor, rotation: Rotation) -> Result<Texels, Error> {
        let [width, height, depth] = self.extent;
        let (format, layers, mut bytes) = (descriptor.format, descriptor.layers, self.bytes()?);
        if rotation.turns() {
            let texel_bytes = usize::try_from(plane_bytes(format, self.plane)).unwrap_or(1);
            bytes = rotate_texels::upright(&bytes, [width, height], texel_bytes, rotation);
        }
        let [width, height] = rotation.extent([width, height]);
        Ok(Texels { format, extent: [width, height, depth], layers, bytes })
    }
}

fn buffer(gpu: &Arc<Gpu>, bytes: u64) -> Result<RawBuffer, Error> {
    RawBuffer::new(gpu, "readback", bytes, vk::BufferUsageFlags::TRANSFER_DST, MemoryUse::Readback)
}

/// From copies to the host.
pub(crate) fn to_host() -> vk::MemoryBarrier2<'static> {
    vk::MemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::COPY)
        .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
        .dst_stage_mask(vk::PipelineStageFlags2::HOST)
        .dst_access_mask(vk::AccessFlags2::HOST_READ)
}

/// Extent of a mip level.
pub(crate) fn mip_extent(descriptor: &ImageDescriptor, mip: u32) -> [u32; 3] {
    descriptor.extent.map(|side| side.unbounded_shr(mip).max(1))
}

/// Bytes of one plane of a mip level, all layers together.
pub(crate) fn level_bytes(descriptor: &ImageDescriptor, plane: Aspects, mip: u32) -> u64 {
    texels_bytes(descriptor, plane, mip_extent(descriptor, mip))
}

/// Bytes of one plane with this extent in texels, all layers together.
fn texels_bytes(descriptor: &ImageDescriptor, plane: Aspects, extent: [u32; 3]) -> u64 {
    let bytes = match plane {
        Aspects::COLOR => descriptor.format.bytes(extent),
        _ => extent.iter().fold(plane_bytes(descriptor.format, plane), |all, side| all.saturating_mul((*side).into())),
    };
    bytes.saturating_mul(descriptor.layers.into())
}

/// The plane that is read where nobody says which: colour or depth.
pub(crate) fn first_plane(format: Format) -> Aspects {
    if format.aspects().contains(Aspects::COLOR) { Aspects::COLOR } else { Aspects::DEPTH }
}

/// Bytes of a texel of one plane as copies to buffers write it.
pub(crate) fn plane_bytes(format: Format, plane: Aspects) -> u64 {
    match (plane, format) {
        (Aspects::STENCIL, _) => 1,
        (_, Format::D32_SFLOAT_S8_UINT | Format::D24_UNORM_S8_UINT) => 4,
        (_, format) => format.texel_bytes(),
    }
}
