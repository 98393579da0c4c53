//! Objects that are made once for each description and live as long as the device. A key is the whole description.

use crate::device::Shared;
use crate::error::Error;
use ash::vk;
use framewright_graph::shader::MOST_PARTS;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Mutex, PoisonError};

/// Every stage may ask which part of an image is in use.
pub(crate) const PARTS_STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::VERTEX.as_raw()
        | vk::ShaderStageFlags::FRAGMENT.as_raw()
        | vk::ShaderStageFlags::COMPUTE.as_raw(),
);
/// Bytes of push constants that tell it: four numbers each.
const PARTS_BYTES: u32 = 16 * MOST_PARTS as u32;

/// The caches of a device.
#[derive(Default)]
pub(crate) struct Caches {
    pub(crate) samplers: Cache<SamplerDescriptor, vk::Sampler>,
    pub(crate) set_layouts: Cache<Vec<LayoutBinding>, vk::DescriptorSetLayout>,
    pub(crate) pipeline_layouts: Cache<Vec<vk::DescriptorSetLayout>, vk::PipelineLayout>,
    pub(crate) pipelines: Cache<crate::pipeline::PipelineDescriptor, vk::Pipeline>,
    pub(crate) compute_pipelines: Cache<(crate::shaders::Spirv, vk::PipelineLayout), vk::Pipeline>,
}

/// One kind of object by its description.
pub(crate) struct Cache<K, V>(Mutex<HashMap<K, V>>);

impl<K, V> Default for Cache<K, V> {
    fn default() -> Self {
        Cache(Mutex::default())
    }
}

impl<K: Hash + Eq, V: Copy> Cache<K, V> {
    /// The object for `key`, made by `make` if there is none yet.
    pub(crate) fn get(&self, key: K, make: impl FnOnce(&K) -> Result<V, Error>) -> Result<V, Error> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known.get(&key) {
            return Ok(*found);
        }
        let made = make(&key)?;
        known.insert(key, made);
        Ok(made)
    }

    fn drain(&self) -> Vec<V> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).drain().map(|(_, made)| made).collect()
    }
}

/// How a texture is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct SamplerDescriptor {
    /// Filter where the texture is shown enlarged.
    pub magnify: TexelFilter,
    /// Filter where it is shown reduced.
    pub minify: TexelFilter,
    /// Filter between mip levels.
    pub mip: TexelFilter,
    /// What lies beyond the edges, horizontally, vertically and in depth.
    pub address: [AddressMode; 3],
}

/// How a value between texels is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TexelFilter {
    /// The nearest texel.
    Nearest,
    /// Weighted mean of the neighbours.
    #[default]
    Linear,
}

/// What lies beyond a texture's edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum AddressMode {
    /// The texture again.
    #[default]
    Repeat,
    /// The texture mirrored.
    MirroredRepeat,
    /// The edge's texels.
    ClampToEdge,
}

/// One binding of a set layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct LayoutBinding {
    pub(crate) binding: u32,
    pub(crate) ty: vk::DescriptorType,
    pub(crate) stages: vk::ShaderStageFlags,
}

impl Shared {
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

    /// The set layout with these bindings, in any order.
    pub(crate) fn set_layout(&self, mut bindings: Vec<LayoutBinding>) -> Result<vk::DescriptorSetLayout, Error> {
        bindings.sort();
        self.caches.set_layouts.get(bindings, |bindings| {
            let bindings: Vec<_> = bindings
                .iter()
                .map(|it| {
                    vk::DescriptorSetLayoutBinding::default()
                        .binding(it.binding)
                        .descriptor_type(it.ty)
                        .descriptor_count(1)
                        .stage_flags(it.stages)
                })
                .collect();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: the device lives.
            unsafe { self.raw.create_descriptor_set_layout(&info, None) }
                .map_err(Error::vulkan("creating a descriptor set layout"))
        })
    }

    /// The pipeline layout with these set layouts, and room for the parts of images that passes use.
    pub(crate) fn pipeline_layout(&self, sets: Vec<vk::DescriptorSetLayout>) -> Result<vk::PipelineLayout, Error> {
        self.caches.pipeline_layouts.get(sets, |sets| {
            let parts = [vk::PushConstantRange { stage_flags: PARTS_STAGES, offset: 0, size: PARTS_BYTES }];
            let info = vk::PipelineLayoutCreateInfo::default().set_layouts(sets).push_constant_ranges(&parts);
            // SAFETY: the set layouts live as long as the device.
            unsafe { self.raw.create_pipeline_layout(&info, None) }.map_err(Error::vulkan("creating a pipeline layout"))
        })
    }
}

impl Caches {
    /// Destroys everything.
    ///
    /// # Safety
    /// Nothing that uses any of it may be in use, now or later.
    pub(crate) unsafe fn destroy(&self, device: &ash::Device) {
        // SAFETY: the caller's promise.
        unsafe {
            self.pipelines.drain().into_iter().for_each(|it| device.destroy_pipeline(it, None));
            self.compute_pipelines.drain().into_iter().for_each(|it| device.destroy_pipeline(it, None));
            self.pipeline_layouts.drain().into_iter().for_each(|it| device.destroy_pipeline_layout(it, None));
            self.set_layouts.drain().into_iter().for_each(|it| device.destroy_descriptor_set_layout(it, None));
            self.samplers.drain().into_iter().for_each(|it| device.destroy_sampler(it, None));
        }
    }
}
