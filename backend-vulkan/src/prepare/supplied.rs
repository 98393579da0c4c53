//! The sets of a pipeline from 1 on, which belong to the draw source.

use crate::base::Error;
use crate::gpu::Gpu;
use crate::resources::supplied_layouts;
use ash::vk;
use framewright_graph::shader::{DrawInterface, PASS_SET, ShaderInterface};

/// The sets of a pipeline that the draw source provides.
#[derive(Default)]
pub(crate) struct SuppliedSets {
    pub(crate) layout: vk::PipelineLayout,
    /// Layouts of the sets from 1 on, and whether the shader reads them.
    pub(crate) sets: Vec<(vk::DescriptorSetLayout, bool)>,
}

impl SuppliedSets {
    /// The layout of a pipeline whose pass has a set of the layout `own`, and to which the draw source brings `brought`.
    pub(super) fn new(
        gpu: &Gpu,
        own: vk::DescriptorSetLayout,
        shader: &ShaderInterface,
        brought: &DrawInterface,
    ) -> Result<SuppliedSets, Error> {
        let supplied = supplied_layouts(gpu, brought)?;
        let layout = gpu.pipeline_layout([own].into_iter().chain(supplied.iter().copied()).collect())?;
        let reads = |set| shader.bindings.iter().any(|it| it.set == set);
        let sets = (PASS_SET + 1..).zip(supplied).map(|(set, layout)| (layout, reads(set))).collect();
        Ok(SuppliedSets { layout, sets })
    }

    /// Whether the shader reads any of them.
    pub(crate) fn are_read(&self) -> bool {
        self.sets.iter().any(|(_, needed)| *needed)
    }
}
