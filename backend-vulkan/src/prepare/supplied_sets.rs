//! The sets of a pipeline from 1 on, which belong to the draw source and the program.

use crate::base::Error;
use crate::gpu::Gpu;
use crate::resources::{offset_alignments, program_layout, supplied_layout};
use crate::shaders::ShaderLibrary;
use ash::vk;
use framewright_graph::shader::{Binding, Block, DrawInterface, PASS_SET, ProgramSet, ShaderInterface};

/// The sets of a pipeline that the draw source provides, or the program binds itself.
#[derive(Default)]
pub(crate) struct SuppliedSets {
    pub(crate) layout: vk::PipelineLayout,
    /// From 1 on.
    pub(crate) sets: Vec<SuppliedSet>,
}

/// A set that the draw source provides, or the program binds itself.
pub(crate) struct SuppliedSet {
    pub(crate) layout: vk::DescriptorSetLayout,
    /// Whether the shader reads any of it.
    pub(crate) is_read: bool,
    /// The uniform blocks that the shader declares in it.
    pub(crate) blocks: Vec<SuppliedBlock>,
    /// Of a set that the program binds itself, what each of its dynamic offsets must be a multiple of; `None`: a bind group is bound.
    pub(crate) program: Option<Vec<u64>>,
}

/// A uniform block that a shader declares.
pub(crate) struct SuppliedBlock {
    pub(crate) binding: u32,
    pub(crate) name: String,
    pub(crate) bytes: u32,
}

impl SuppliedSets {
    /// The layout of a pipeline whose pass has a set of the layout `own`, and to which the draw source brings `brought`. Sets of the
    /// program's are in it if the shader reads them.
    pub(super) fn new(
        gpu: &Gpu,
        own: vk::DescriptorSetLayout,
        shader: &ShaderInterface,
        brought: &DrawInterface,
        shaders: &ShaderLibrary,
    ) -> Result<SuppliedSets, Error> {
        let read = |set: u32| shader.program.iter().any(|it| it.set == set);
        let program: Vec<_> = shaders.draws().sets().iter().filter(|set| read(set.set)).collect();
        let numbers = brought.supplied.iter().map(|it| it.set).chain(program.iter().map(|it| it.set));
        let sets = (PASS_SET + 1..=numbers.max().unwrap_or(PASS_SET)).map(|set| {
            match program.iter().find(|it| it.set == set) {
                Some(of_program) => SuppliedSet::of_program(gpu, of_program, shaders),
                None => SuppliedSet::of_source(gpu, set, shader, brought),
            }
        });
        let sets = sets.collect::<Result<Vec<_>, Error>>()?;
        let pushed = if shader.pushed.is_empty() { 0 } else { brought.pushed_bytes() };
        let layouts = [own].into_iter().chain(sets.iter().map(|set| set.layout)).collect();
        let layout = gpu.pipeline_layout(layouts, pushed)?;
        Ok(SuppliedSets { layout, sets })
    }

    /// Whether the shader reads any that the draw source provides.
    pub(crate) fn are_read(&self) -> bool {
        self.sets.iter().any(|set| set.is_read && set.program.is_none())
    }

    /// Whether the shader reads any that the program binds itself.
    pub(crate) fn has_program_sets(&self) -> bool {
        self.sets.iter().any(|set| set.program.is_some())
    }
}

impl SuppliedSet {
    fn of_program(gpu: &Gpu, set: &ProgramSet, shaders: &ShaderLibrary) -> Result<SuppliedSet, Error> {
        let layout = match shaders.set_layouts().of(set.set) {
            Some(own) => own,
            None => program_layout(gpu, set)?,
        };
        Ok(SuppliedSet { layout, is_read: true, blocks: Vec::new(), program: Some(offset_alignments(gpu, set)) })
    }

    fn of_source(gpu: &Gpu, set: u32, shader: &ShaderInterface, brought: &DrawInterface) -> Result<SuppliedSet, Error> {
        let of_set = shader.bindings.iter().filter(|it| it.set == set);
        let block = |it: &Binding| {
            let Block { bytes, .. } = it.kind.uniform_block()?;
            Some(SuppliedBlock { binding: it.binding, name: it.name.clone(), bytes: *bytes })
        };
        let (layout, is_read) = (supplied_layout(gpu, brought, set)?, of_set.clone().next().is_some());
        Ok(SuppliedSet { layout, is_read, blocks: of_set.filter_map(block).collect(), program: None })
    }
}
