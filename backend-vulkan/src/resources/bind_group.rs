//! Bind groups: the descriptor sets that a draw source brings along.

use super::texture::{Buffer, Texture};
use crate::base::Error;
use crate::gpu::{Device, Gpu, LayoutBinding};
use crate::pipeline::{DescriptorSet, DescriptorTarget, check_brought};
use ash::vk;
use framewright_graph::shader::{DrawInterface, PASS_SET, SuppliedKind};
use std::sync::Arc;

/// The stages that see what a draw source brings along.
const SUPPLIED_STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::VERTEX.as_raw()
        | vk::ShaderStageFlags::FRAGMENT.as_raw()
        | vk::ShaderStageFlags::COMPUTE.as_raw(),
);

/// Something that can be bound.
#[derive(Clone, Copy)]
pub enum Resource<'r> {
    /// For a uniform or storage block.
    Buffer(&'r Buffer),
    /// For a sampled image.
    Texture(&'r Texture),
}

/// A descriptor set from 1 on, filled with what the draw source provides. Clones share it; it keeps what it holds.
#[derive(Clone)]
pub struct BindGroup(pub(crate) Arc<RawBindGroup>);

/// A bind group's parts. Fields are dropped in this order.
pub(crate) struct RawBindGroup {
    pub(crate) set: DescriptorSet,
    _buffers: Vec<Buffer>,
    _textures: Vec<Texture>,
}

impl Device {
    /// The set number `set` of `interface`, filled with `resources` by binding number.
    ///
    /// # Errors
    /// [`Error::BadResource`] if a binding is missing, surplus, or of another kind.
    pub fn bind_group(
        &self,
        interface: &DrawInterface,
        set: u32,
        resources: &[(u32, Resource<'_>)],
    ) -> Result<BindGroup, Error> {
        let bad = |what: String| Error::BadResource { what: format!("bind group for set {set}: {what}") };
        if set == PASS_SET {
            return Err(bad("it belongs to the pass".to_owned()));
        }
        check_brought(interface).map_err(bad)?;
        let supplied: Vec<_> = interface.supplied.iter().filter(|it| it.set == set).collect();
        if let Some((binding, _)) =
            resources.iter().find(|(binding, _)| supplied.iter().all(|it| it.binding != *binding))
        {
            return Err(bad(format!("the draw interface has no binding {binding}")));
        }
        let is_own = |resource: &Resource<'_>| match resource {
            Resource::Buffer(buffer) => buffer.0.is_of(&self.gpu),
            Resource::Texture(texture) => texture.0.image.is_of(&self.gpu),
        };
        if !resources.iter().all(|(_, resource)| is_own(resource)) {
            return Err(bad("a resource belongs to another device".to_owned()));
        }
        let mut bindings = Vec::new();
        let (mut buffers, mut textures) = (Vec::new(), Vec::new());
        for wanted in supplied {
            let name = &wanted.name;
            let given = resources.iter().filter(|(binding, _)| *binding == wanted.binding).map(|(_, given)| given);
            let given: Vec<_> = given.collect();
            let target = match (wanted.kind, &given[..]) {
                (SuppliedKind::UniformBlock, [Resource::Buffer(it)]) if it.is(vk::BufferUsageFlags::UNIFORM_BUFFER) => {
                    buffers.push((*it).clone());
                    DescriptorTarget::Buffer(it.0.raw)
                }
                (SuppliedKind::StorageBlock, [Resource::Buffer(it)]) if it.is(vk::BufferUsageFlags::STORAGE_BUFFER) => {
                    buffers.push((*it).clone());
                    DescriptorTarget::Buffer(it.0.raw)
                }
                (SuppliedKind::SampledImage, [Resource::Texture(it)]) => {
                    textures.push((*it).clone());
                    DescriptorTarget::Image(it.0.view, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL, it.0.sampler)
                }
                (kind, [_]) => return Err(bad(format!("`{name}` is a {kind:?}, and something else was given"))),
                (_, given) => return Err(bad(format!("`{name}` is needed once and was given {} times", given.len()))),
            };
            bindings.push((layout_binding(wanted.binding, wanted.kind), target));
        }
        let set = DescriptorSet::new(&self.gpu, &bindings)?;
        Ok(BindGroup(Arc::new(RawBindGroup { set, _buffers: buffers, _textures: textures })))
    }
}

impl Buffer {
    fn is(&self, usage: vk::BufferUsageFlags) -> bool {
        self.0.usage.contains(usage)
    }
}

/// Every set from 1 on is visible in all stages, so that all shaders of a kind of draw share its layout, and kinds that bring the
/// same share bind groups.
fn layout_binding(binding: u32, kind: SuppliedKind) -> LayoutBinding {
    let ty = match kind {
        SuppliedKind::UniformBlock => vk::DescriptorType::UNIFORM_BUFFER,
        SuppliedKind::StorageBlock => vk::DescriptorType::STORAGE_BUFFER,
        SuppliedKind::SampledImage => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
    };
    LayoutBinding { binding, ty, stages: SUPPLIED_STAGES }
}

/// The layouts of the sets from 1 on that `interface` brings along, without gaps.
pub(crate) fn supplied_layouts(gpu: &Gpu, interface: &DrawInterface) -> Result<Vec<vk::DescriptorSetLayout>, Error> {
    let last = interface.supplied.iter().map(|it| it.set).max().unwrap_or(PASS_SET);
    (PASS_SET + 1..=last)
        .map(|set| {
            let of_set = interface.supplied.iter().filter(|it| it.set == set);
            gpu.set_layout(of_set.map(|it| layout_binding(it.binding, it.kind)).collect())
        })
        .collect()
}
