//! A simulation by a compute pipeline of the engine's own, recorded in a custom pass.

use framewright::vulkan::ash::vk;
use framewright::{CustomRecorder, Device};
use std::error::Error;

/// `sparks.comp`, compiled: a whole number of 32-bit words.
const SPIRV: &[u8] = include_bytes!("sparks.spv");

/// The pipeline, and a descriptor set for each frame that may be on its way.
pub(crate) struct Sparks {
    device: Device,
    sets_layout: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    pool: vk::DescriptorPool,
    sets: Vec<vk::DescriptorSet>,
}

impl Sparks {
    pub(crate) fn new(device: &Device, frames: usize) -> Result<Sparks, Box<dyn Error>> {
        let raw = device.raw();
        let kind = vk::DescriptorType::STORAGE_BUFFER;
        let bindings = [vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::COMPUTE)];
        let sets_layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let sizes = [vk::DescriptorPoolSize::default().ty(kind).descriptor_count(frames as u32)];
        let pool = vk::DescriptorPoolCreateInfo::default().max_sets(frames as u32).pool_sizes(&sizes);
        let constants = [vk::PushConstantRange::default().stage_flags(vk::ShaderStageFlags::COMPUTE).size(4)];
        let (words, rest) = SPIRV.as_chunks();
        assert!(rest.is_empty(), "SPIR-V is a whole number of words");
        let words: Vec<u32> = words.iter().map(|word| u32::from_le_bytes(*word)).collect();
        // SAFETY: the device lives, all that is pointed to outlives the calls, and the SPIR-V comes from a compiler.
        unsafe {
            let sets_layout = raw.create_descriptor_set_layout(&sets_layout, None)?;
            let layouts = vec![sets_layout; frames];
            let layout = vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts[..1]);
            let layout = raw.create_pipeline_layout(&layout.push_constant_ranges(&constants), None)?;
            let pool = raw.create_descriptor_pool(&pool, None)?;
            let sets = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
            let sets = raw.allocate_descriptor_sets(&sets)?;
            let module = raw.create_shader_module(&vk::ShaderModuleCreateInfo::default().code(&words), None)?;
            let stage = vk::PipelineShaderStageCreateInfo::default().stage(vk::ShaderStageFlags::COMPUTE);
            let info =
                vk::ComputePipelineCreateInfo::default().stage(stage.module(module).name(c"main")).layout(layout);
            let pipelines = raw.create_compute_pipelines(vk::PipelineCache::null(), &[info], None);
            raw.destroy_shader_module(module, None);
            let pipeline = pipelines.map_err(|(_, error)| error)?[0];
            Ok(Sparks { device: device.clone(), sets_layout, layout, pipeline, pool, sets })
        }
    }

    /// Records the dispatch. The Plan has the barriers around it, for what the pass declares.
    pub(crate) fn record(&self, recorder: &mut CustomRecorder<'_>, seconds: f32) {
        let Some(buffer) = recorder.buffer("sparks") else { return };
        let set = self.sets[recorder.frame() as usize % self.sets.len()];
        let commands = recorder.raw();
        let raw = self.device.raw();
        let whole = [vk::DescriptorBufferInfo::default().buffer(buffer).range(vk::WHOLE_SIZE)];
        let write = vk::WriteDescriptorSet::default().dst_set(set).descriptor_type(vk::DescriptorType::STORAGE_BUFFER);
        let stage = vk::PipelineBindPoint::COMPUTE;
        // SAFETY: the frame that read this set last was waited for; the commands are being recorded outside of a rendering scope.
        unsafe {
            raw.update_descriptor_sets(&[write.buffer_info(&whole)], &[]);
            raw.cmd_bind_pipeline(commands, stage, self.pipeline);
            raw.cmd_bind_descriptor_sets(commands, stage, self.layout, 0, &[set], &[]);
            let seconds = seconds.to_ne_bytes();
            raw.cmd_push_constants(commands, self.layout, vk::ShaderStageFlags::COMPUTE, 0, &seconds);
            raw.cmd_dispatch(commands, 1, 1, 1);
        }
    }
}

impl Drop for Sparks {
    fn drop(&mut self) {
        let raw = self.device.raw();
        // SAFETY: the frames were waited for.
        unsafe {
            raw.destroy_pipeline(self.pipeline, None);
            raw.destroy_pipeline_layout(self.layout, None);
            raw.destroy_descriptor_pool(self.pool, None);
            raw.destroy_descriptor_set_layout(self.sets_layout, None);
        }
    }
}
