//! Samplers, one for each description.

use crate::base::{Error, convert};
use crate::gpu::{Gpu, SamplerDescriptor};
use ash::vk;
use framewright_graph::vulkan::{AddressMode, Filter, Sampler};

impl Gpu {
    /// The sampler of a texture.
    pub(crate) fn texture_sampler(&self, descriptor: SamplerDescriptor) -> Result<vk::Sampler, Error> {
        self.made(descriptor, Sampler::new(descriptor.magnify))
    }

    /// The sampler that a pass says.
    pub(crate) fn sampler(&self, sampler: Sampler) -> Result<vk::Sampler, Error> {
        let Sampler { filter, mips, address, .. } = sampler;
        let descriptor = SamplerDescriptor { magnify: filter, minify: filter, mip: mips, address: [address; 3] };
        self.made(descriptor, sampler)
    }

    /// `state`: what the descriptor doesn't say.
    fn made(&self, descriptor: SamplerDescriptor, state: Sampler) -> Result<vk::Sampler, Error> {
        self.caches.samplers.get(&(descriptor, state), |(it, state)| {
            let mut reduction = vk::SamplerReductionModeCreateInfo::default()
                .reduction_mode(convert::sampler_reduction(state.reduction));
            let mut info = vk::SamplerCreateInfo::default()
                .mag_filter(convert::filter(it.magnify))
                .min_filter(convert::filter(it.minify))
                .mipmap_mode(match it.mip {
                    Filter::Nearest => vk::SamplerMipmapMode::NEAREST,
                    Filter::Linear => vk::SamplerMipmapMode::LINEAR,
                })
                .address_mode_u(address(it.address[0]))
                .address_mode_v(address(it.address[1]))
                .address_mode_w(address(it.address[2]))
                .compare_enable(state.compare.is_some())
                .compare_op(state.compare.map_or(vk::CompareOp::NEVER, convert::compare))
                .mip_lod_bias(state.lod_bias.into())
                .min_lod(state.min_lod.into())
                .max_lod(state.max_lod.map_or(vk::LOD_CLAMP_NONE, f32::from));
            if let Some(border) = state.border {
                info = info.border_color(convert::border_color(border));
            }
            if state.anisotropy > 1 {
                #[allow(clippy::cast_precision_loss, reason = "it is at most 16")]
                let most = state.anisotropy as f32;
                info = info.anisotropy_enable(true).max_anisotropy(most);
            }
            if state.reduces() {
                info = info.push_next(&mut reduction);
            }
            // SAFETY: the device lives, and what is chained outlives the call.
            unsafe { self.raw.create_sampler(&info, None) }.map_err(Error::vulkan("creating a sampler"))
        })
    }
}

fn address(mode: AddressMode) -> vk::SamplerAddressMode {
    match mode {
        AddressMode::Repeat => vk::SamplerAddressMode::REPEAT,
        AddressMode::MirroredRepeat => vk::SamplerAddressMode::MIRRORED_REPEAT,
        AddressMode::ClampToEdge => vk::SamplerAddressMode::CLAMP_TO_EDGE,
        AddressMode::ClampToBorder => vk::SamplerAddressMode::CLAMP_TO_BORDER,
        AddressMode::MirrorClampToEdge => vk::SamplerAddressMode::MIRROR_CLAMP_TO_EDGE,
    }
}
