//! Descriptor sets: those that whoever draws brings along, and the plain set underneath.

use crate::caches::LayoutBinding;
use crate::device::{Device, Shared};
use crate::error::Error;
use crate::resources::{Buffer, Texture};
use crate::shader_fit::check_brought;
use ash::vk;
use framewright_graph::shader::{DrawInterface, PASS_SET, SuppliedKind};
use std::sync::Arc;

/// A descriptor set in a pool of its own.
pub(crate) struct DescriptorSet {
    shared: Arc<Shared>,
    pool: vk::DescriptorPool,
    pub(crate) raw: vk::DescriptorSet,
    pub(crate) layout: vk::DescriptorSetLayout,
}

/// What a descriptor points to.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Target {
    /// A whole buffer.
    Buffer(vk::Buffer),
    /// A view, in the layout in which it will be, with a sampler or (storage images) without.
    Image(vk::ImageView, vk::ImageLayout, vk::Sampler),
}

impl DescriptorSet {
    /// A set of these bindings. What they point to must outlive the set's use.
    pub(crate) fn new(shared: &Arc<Shared>, bindings: &[(LayoutBinding, Target)]) -> Result<DescriptorSet, Error> {
        const DOING: &str = "creating a descriptor set";
        let layout = shared.set_layout(bindings.iter().map(|(binding, _)| *binding).collect())?;
        let sizes: Vec<_> = bindings
            .iter()
            .map(|(binding, _)| vk::DescriptorPoolSize { ty: binding.ty, descriptor_count: 1 })
            .collect();
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        // SAFETY: the device lives.
        let pool = unsafe { shared.raw.create_descriptor_pool(&info, None) }.map_err(Error::vulkan(DOING))?;
        let mut set = DescriptorSet { shared: shared.clone(), pool, raw: vk::DescriptorSet::null(), layout };
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
        // SAFETY: the pool was made for exactly this set.
        let sets = unsafe { shared.raw.allocate_descriptor_sets(&info) }.map_err(Error::vulkan(DOING))?;
        set.raw = sets.first().copied().unwrap_or_default();
        for (binding, target) in bindings {
            set.write(*binding, *target);
        }
        Ok(set)
    }

    /// Whether this device made it.
    pub(crate) fn is_of(&self, shared: &Shared) -> bool {
        std::ptr::eq(Arc::as_ptr(&self.shared), shared)
    }

    fn write(&self, binding: LayoutBinding, target: Target) {
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.raw)
            .dst_binding(binding.binding)
            .descriptor_type(binding.ty)
            .descriptor_count(1);
        match target {
            Target::Buffer(buffer) => {
                let info = [vk::DescriptorBufferInfo { buffer, offset: 0, range: vk::WHOLE_SIZE }];
                // SAFETY: the set is new, has this binding, and the buffer lives.
                unsafe { self.shared.raw.update_descriptor_sets(&[write.buffer_info(&info)], &[]) };
            }
            Target::Image(image_view, image_layout, sampler) => {
                let info = [vk::DescriptorImageInfo { sampler, image_view, image_layout }];
                // SAFETY: the set is new, has this binding, and view and sampler live.
                unsafe { self.shared.raw.update_descriptor_sets(&[write.image_info(&info)], &[]) };
            }
        }
    }
}

impl Drop for DescriptorSet {
    fn drop(&mut self) {
        if !self.shared.is_abandoned() {
            // SAFETY: every submission is waited for, so the set isn't in use.
            unsafe { self.shared.raw.destroy_descriptor_pool(self.pool, None) };
        }
    }
}

/// Something that can be bound.
#[derive(Clone, Copy)]
pub enum Resource<'r> {
    /// For a uniform or storage block.
    Buffer(&'r Buffer),
    /// For a sampled image.
    Texture(&'r Texture),
}

/// A descriptor set from 1 on, filled with what whoever draws brings along. Clones share it; it keeps what it holds.
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
        check_brought(&self.shared, interface).map_err(bad)?;
        let supplied: Vec<_> = interface.supplied.iter().filter(|it| it.set == set).collect();
        if let Some((binding, _)) =
            resources.iter().find(|(binding, _)| supplied.iter().all(|it| it.binding != *binding))
        {
            return Err(bad(format!("the draw interface has no binding {binding}")));
        }
        let is_own = |resource: &Resource<'_>| match resource {
            Resource::Buffer(buffer) => buffer.0.is_of(&self.shared),
            Resource::Texture(texture) => texture.0.view.is_of(&self.shared),
        };
        if !resources.iter().all(|(_, resource)| is_own(resource)) {
            return Err(bad("a resource belongs to another device".to_owned()));
        }
        let mut bindings = Vec::new();
        let (mut buffers, mut textures) = (Vec::new(), Vec::new());
        for wanted in supplied {
            let name = wanted.name;
            let given = resources.iter().filter(|(binding, _)| *binding == wanted.binding).map(|(_, given)| given);
            let given: Vec<_> = given.collect();
            let target = match (wanted.kind, &given[..]) {
                (SuppliedKind::UniformBlock, [Resource::Buffer(it)]) if it.is(vk::BufferUsageFlags::UNIFORM_BUFFER) => {
                    buffers.push((*it).clone());
                    Target::Buffer(it.0.raw)
                }
                (SuppliedKind::StorageBlock, [Resource::Buffer(it)]) if it.is(vk::BufferUsageFlags::STORAGE_BUFFER) => {
                    buffers.push((*it).clone());
                    Target::Buffer(it.0.raw)
                }
                (SuppliedKind::SampledImage, [Resource::Texture(it)]) => {
                    textures.push((*it).clone());
                    Target::Image(it.0.view.raw, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL, it.0.sampler)
                }
                (kind, [_]) => return Err(bad(format!("`{name}` is a {kind:?}, and something else was given"))),
                (_, given) => return Err(bad(format!("`{name}` is needed once and was given {} times", given.len()))),
            };
            bindings.push((layout_binding(wanted.binding, wanted.kind), target));
        }
        let set = DescriptorSet::new(&self.shared, &bindings)?;
        Ok(BindGroup(Arc::new(RawBindGroup { set, _buffers: buffers, _textures: textures })))
    }
}

impl Buffer {
    fn is(&self, usage: vk::BufferUsageFlags) -> bool {
        self.0.usage.contains(usage)
    }
}

/// Every set from 1 on is visible in both stages, so that all shaders of a kind of draw share its layout.
fn layout_binding(binding: u32, kind: SuppliedKind) -> LayoutBinding {
    let ty = match kind {
        SuppliedKind::UniformBlock => vk::DescriptorType::UNIFORM_BUFFER,
        SuppliedKind::StorageBlock => vk::DescriptorType::STORAGE_BUFFER,
        SuppliedKind::SampledImage => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
    };
    LayoutBinding { binding, ty, stages: vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT }
}

/// The layouts of the sets from 1 on that `interface` brings along, without gaps.
pub(crate) fn supplied_layouts(
    shared: &Shared,
    interface: &DrawInterface,
) -> Result<Vec<vk::DescriptorSetLayout>, Error> {
    let last = interface.supplied.iter().map(|it| it.set).max().unwrap_or(PASS_SET);
    (PASS_SET + 1..=last)
        .map(|set| {
            let of_set = interface.supplied.iter().filter(|it| it.set == set);
            shared.set_layout(of_set.map(|it| layout_binding(it.binding, it.kind)).collect())
        })
        .collect()
}
