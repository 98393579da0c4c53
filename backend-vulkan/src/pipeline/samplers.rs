//! Samplers, one for each description.

use crate::base::Error;
use crate::gpu::{AddressMode, Gpu, SamplerDescriptor, TexelFilter};
use ash::vk;
use framewright_graph::vulkan::{self, Filter, Sampler};

impl Gpu {
    /// The sampler of this description.
    pub(crate) fn sampler(&self, descriptor: SamplerDescriptor) -> Result<vk::Sampler, Error> {
        let filter = |filter| match filter {
            TexelFilter::Nearest => vk::Filter::NEAREST,
            TexelFilter::Linear => vk::Filter::LINEAR,
        };
        let address = |mode| match mode {
            AddressMode::Repeat => vk::SamplerAddressMode::REPEAT,
            AddressMode::MirroredRepeat => vk::SamplerAddressMode::MIRRORED_REPEAT,
            AddressMode::ClampToEdge => vk::SamplerAddressMode::CLAMP_TO_EDGE,
        };
        self.caches.samplers.get(descriptor, |it| {
            let info = vk::SamplerCreateInfo::default()
                .mag_filter(filter(it.magnify))
                .min_filter(filter(it.minify))
                .mipmap_mode(match it.mip {
                    TexelFilter::Nearest => vk::SamplerMipmapMode::NEAREST,
                    TexelFilter::Linear => vk::SamplerMipmapMode::LINEAR,
                })
                .address_mode_u(address(it.address[0]))
                .address_mode_v(address(it.address[1]))
                .address_mode_w(address(it.address[2]))
                .max_lod(vk::LOD_CLAMP_NONE);
            // SAFETY: the device lives.
            unsafe { self.raw.create_sampler(&info, None) }.map_err(Error::vulkan("creating a sampler"))
        })
    }
}

impl From<Sampler> for SamplerDescriptor {
    fn from(sampler: Sampler) -> SamplerDescriptor {
        let texel_filter = |filter| match filter {
            Filter::Nearest => TexelFilter::Nearest,
            Filter::Linear => TexelFilter::Linear,
        };
        let address = match sampler.address {
            vulkan::AddressMode::ClampToEdge => AddressMode::ClampToEdge,
            vulkan::AddressMode::Repeat => AddressMode::Repeat,
            vulkan::AddressMode::MirroredRepeat => AddressMode::MirroredRepeat,
        };
        let filter = texel_filter(sampler.filter);
        SamplerDescriptor { magnify: filter, minify: filter, mip: texel_filter(sampler.mips), address: [address; 3] }
    }
}
