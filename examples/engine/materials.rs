//! All textures of the engine in one table, a descriptor set of its own.

use crate::interface::ROOM;
use framewright::Device;
use framewright::graph::vulkan::Format;
use framewright::vulkan::ash::vk;
use framewright::vulkan::{RawSet, SamplerDescriptor, Texture};
use std::error::Error;

/// As many as there are.
pub(crate) const COUNT: u32 = 15;

/// The table, with its textures.
pub(crate) struct Materials {
    device: Device,
    layout: vk::DescriptorSetLayout,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    _textures: Vec<Texture>,
}

impl Materials {
    pub(crate) fn new(device: &Device) -> Result<Materials, Box<dyn Error>> {
        let raw = device.raw();
        let flags = [vk::DescriptorBindingFlags::PARTIALLY_BOUND, vk::DescriptorBindingFlags::empty()];
        let mut flags = vk::DescriptorSetLayoutBindingFlagsCreateInfo::default().binding_flags(&flags);
        let binding = |number, ty, count| {
            let binding = vk::DescriptorSetLayoutBinding::default().binding(number).descriptor_type(ty);
            binding.descriptor_count(count).stage_flags(vk::ShaderStageFlags::FRAGMENT)
        };
        let (images, sampler) = (vk::DescriptorType::SAMPLED_IMAGE, vk::DescriptorType::SAMPLER);
        let bindings = [binding(0, images, ROOM), binding(1, sampler, 1)];
        let layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings).push_next(&mut flags);
        let size = |ty, count| vk::DescriptorPoolSize::default().ty(ty).descriptor_count(count);
        let sizes = [size(images, ROOM), size(sampler, 1)];
        let pool = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        // SAFETY: the device lives, and has what the layout asks for: the pipeline had been refused otherwise.
        let (layout, pool, set) = unsafe {
            let layout = raw.create_descriptor_set_layout(&layout, None)?;
            let pool = raw.create_descriptor_pool(&pool, None)?;
            let layouts = [layout];
            let set = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            (layout, pool, raw.allocate_descriptor_sets(&set)?[0])
        };
        let textures = (0..COUNT).map(|number| texture(device, number)).collect::<Result<Vec<_>, _>>()?;
        let image = |texture: &Texture| {
            let image = vk::DescriptorImageInfo::default().image_view(texture.raw().0);
            image.image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)
        };
        let images: Vec<_> = textures.iter().map(image).collect();
        let sampler = [vk::DescriptorImageInfo::default().sampler(textures[0].raw().1)];
        let write = |binding| vk::WriteDescriptorSet::default().dst_set(set).dst_binding(binding);
        let writes = [
            write(0).descriptor_type(vk::DescriptorType::SAMPLED_IMAGE).image_info(&images),
            write(1).descriptor_type(vk::DescriptorType::SAMPLER).image_info(&sampler),
        ];
        // SAFETY: no frame is on its way, and the textures live as long as the set.
        unsafe { raw.update_descriptor_sets(&writes, &[]) };
        Ok(Materials { device: device.clone(), layout, pool, set, _textures: textures })
    }

    /// The set, for [`Renderer::bind_set`](framewright::Renderer::bind_set).
    pub(crate) fn set(&self) -> RawSet {
        // SAFETY: the set is of the layout that was told, and lives as long as frames that read it.
        unsafe { RawSet::new(self.set) }
    }
}

impl Drop for Materials {
    fn drop(&mut self) {
        // SAFETY: the frames were waited for.
        unsafe {
            self.device.raw().destroy_descriptor_pool(self.pool, None);
            self.device.raw().destroy_descriptor_set_layout(self.layout, None);
        }
    }
}

/// A texture of two colours, in squares or stripes.
fn texture(device: &Device, number: u32) -> Result<Texture, Box<dyn Error>> {
    const SIDE: u32 = 64;
    let shade = |channel: u32| 60 + (number * (37 + 29 * channel) + 80 * channel) % 190;
    let color = [0, 1, 2].map(shade);
    let texel = |at: u32| {
        let (x, y) = (at % SIDE / 8, at / SIDE / 8);
        let is_dark = if number.is_multiple_of(2) { (x + y) % 2 == 0 } else { x % 2 == 0 };
        let [red, green, blue] = color.map(|value| if is_dark { value / 3 } else { value } as u8);
        [red, green, blue, 255]
    };
    let texels: Vec<u8> = (0..SIDE * SIDE).flat_map(texel).collect();
    Ok(device.texture(SIDE, SIDE, Format::R8G8B8A8_SRGB, &texels, &SamplerDescriptor::default(), true)?)
}
