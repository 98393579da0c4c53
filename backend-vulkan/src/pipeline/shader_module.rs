//! Shader modules.

use crate::base::Error;
use crate::gpu::Gpu;
use ash::vk;

/// A shader module, needed only while a pipeline is created.
pub(super) struct ShaderModule<'d> {
    gpu: &'d Gpu,
    raw: vk::ShaderModule,
}

impl<'d> ShaderModule<'d> {
    pub(super) fn new(gpu: &'d Gpu, spirv: &[u32]) -> Result<ShaderModule<'d>, Error> {
        let info = vk::ShaderModuleCreateInfo::default().code(spirv);
        // SAFETY: the SPIR-V comes from the shader compiler, for Vulkan 1.3, or was built for it.
        let raw =
            unsafe { gpu.raw.create_shader_module(&info, None) }.map_err(Error::vulkan("creating a shader module"))?;
        Ok(ShaderModule { gpu, raw })
    }

    /// It as a stage of a pipeline.
    pub(super) fn stage(&self, stage: vk::ShaderStageFlags) -> vk::PipelineShaderStageCreateInfo<'static> {
        vk::PipelineShaderStageCreateInfo::default().stage(stage).module(self.raw).name(c"main")
    }
}

impl Drop for ShaderModule<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines don't need their modules any more.
        unsafe { self.gpu.raw.destroy_shader_module(self.raw, None) };
    }
}
