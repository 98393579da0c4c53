//! The sets of a pipeline from 1 on, which belong to the draw source.

use crate::base::Error;
use crate::gpu::Gpu;
use crate::resources::supplied_layouts;
use ash::vk;
use framewright_graph::shader::{Binding, Block, DrawInterface, PASS_SET, ShaderInterface};

/// The sets of a pipeline that the draw source provides.
#[derive(Default)]
pub(crate) struct SuppliedSets {
    pub(crate) layout: vk::PipelineLayout,
    /// From 1 on.
    pub(crate) sets: Vec<SuppliedSet>,
}

/// A set that the draw source provides.
pub(crate) struct SuppliedSet {
    pub(crate) layout: vk::DescriptorSetLayout,
    /// Whether the shader reads any of it.
    pub(crate) is_read: bool,
    /// The uniform blocks that the shader declares in it.
    pub(crate) blocks: Vec<SuppliedBlock>,
}

/// A uniform block that a shader declares.
pub(crate) struct SuppliedBlock {
    pub(crate) binding: u32,
    pub(crate) name: String,
    pub(crate) bytes: u32,
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
        let sets = (PASS_SET + 1..).zip(supplied).map(|(set, layout)| {
            let of_set = shader.bindings.iter().filter(|it| it.set == set);
            let block = |it: &Binding| {
                let Block { bytes, .. } = it.kind.uniform_block()?;
                Some(SuppliedBlock { binding: it.binding, name: it.name.clone(), bytes: *bytes })
            };
            let is_read = of_set.clone().next().is_some();
            SuppliedSet { layout, is_read, blocks: of_set.filter_map(block).collect() }
        });
        Ok(SuppliedSets { layout, sets: sets.collect() })
    }

    /// Whether the shader reads any of them.
    pub(crate) fn are_read(&self) -> bool {
        self.sets.iter().any(|set| set.is_read)
    }
}
