//! Samplers, one for each description.

use crate::base::{Error, convert};
use crate::gpu::{Gpu, SamplerDescriptor};
use ash::vk;
use framewright_graph::vulkan::{AddressMode, CompareOp, Filter, Sampler};

impl Gpu {
    /// The sampler of this description. `compare`: it compares depth.
    pub(crate) fn sampler(
        &self,
        descriptor: SamplerDescriptor,
        compare: Option<CompareOp>,
    ) -> Result<vk::Sampler, Error> {
        let address = |mode| match mode {
            AddressMode::Repeat => vk::SamplerAddressMode::REPEAT,
            AddressMode::MirroredRepeat => vk::SamplerAddressMode::MIRRORED_REPEAT,
            AddressMode::ClampToEdge => vk::SamplerAddressMode::CLAMP_TO_EDGE,
        };
        self.caches.samplers.get(&(descriptor, compare), |(it, compare)| {
            let info = vk::SamplerCreateInfo::default()
                .mag_filter(convert::filter(it.magnify))
                .min_filter(convert::filter(it.minify))
                .mipmap_mode(match it.mip {
                    Filter::Nearest => vk::SamplerMipmapMode::NEAREST,
                    Filter::Linear => vk::SamplerMipmapMode::LINEAR,
                })
                .address_mode_u(address(it.address[0]))
                .address_mode_v(address(it.address[1]))
                .address_mode_w(address(it.address[2]))
                .compare_enable(compare.is_some())
                .compare_op(compare.map_or(vk::CompareOp::NEVER, convert::compare))
                .max_lod(vk::LOD_CLAMP_NONE);
            // SAFETY: the device lives.
            unsafe { self.raw.create_sampler(&info, None) }.map_err(Error::vulkan("creating a sampler"))
        })
    }
}

impl From<Sampler> for SamplerDescriptor {
    fn from(Sampler { filter, mips, address, .. }: Sampler) -> SamplerDescriptor {
        SamplerDescriptor { magnify: filter, minify: filter, mip: mips, address: [address; 3] }
    }
}
