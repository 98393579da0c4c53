//! Bind groups: the descriptor sets that a draw source brings along.

use super::dynamic_buffer::DynamicBuffer;
use super::program_resource::{ProgramBuffer, ProgramView};
use super::texture::{Buffer, Texture};
use crate::base::{Error, ShaderStage};
use crate::gpu::{Device, Gpu, LayoutBinding};
use crate::memory::RawBuffer;
use crate::pipeline::{DescriptorSet, DescriptorTarget, check_brought, check_needs};
use ash::vk;
use framewright_graph::shader::{DrawInterface, PASS_SET, ShaderInterface, SuppliedKind, SuppliedResource};
use std::sync::{Arc, Mutex, PoisonError};

/// Something that can be bound.
#[derive(Clone, Copy)]
pub enum Resource<'r> {
    /// For a uniform or storage block.
    Buffer(&'r Buffer),
    /// For a uniform or storage block whose contents change: those that were written last when the group is bound.
    Dynamic(&'r DynamicBuffer),
    /// For a sampled image.
    Texture(&'r Texture),
    /// For an array of sampled images: as many as the draw interface says.
    Textures(&'r [Texture]),
    /// For a uniform or storage block: a part of a buffer of the program's own.
    ProgramBuffer(ProgramBuffer),
    /// For a sampled image, or an array of them: views of the program's own, as many as the draw interface says.
    ProgramViews(&'r [ProgramView]),
}

impl<'r> Resource<'r> {
    /// Its textures, if it is some.
    const fn textures(&self) -> &'r [Texture] {
        match self {
            Resource::Texture(one) => std::slice::from_ref(*one),
            Resource::Textures(all) => all,
            Resource::Buffer(_) | Resource::Dynamic(_) | Resource::ProgramBuffer(_) | Resource::ProgramViews(_) => &[],
        }
    }
}

/// A descriptor set from 1 on, filled with what the draw source provides. Clones share it; it keeps what it holds.
#[derive(Clone)]
pub struct BindGroup(pub(crate) Arc<RawBindGroup>);

/// A bind group's parts. Fields are dropped in this order.
pub(crate) struct RawBindGroup {
    gpu: Arc<Gpu>,
    pub(crate) layout: vk::DescriptorSetLayout,
    /// Bindings of buffers, and how many bytes each buffer holds.
    bytes: Vec<(u32, u64)>,
    sets: Sets,
    _textures: Vec<Texture>,
}

/// The descriptor sets of a bind group.
enum Sets {
    /// One, for contents that stay.
    One { set: DescriptorSet, _buffers: Vec<Buffer> },
    /// Some, each for copies of its dynamic buffers. One that no frame in flight reads is written anew.
    Each { bindings: Vec<(LayoutBinding, Bound)>, made: Mutex<Vec<SetOfCopies>>, _buffers: Vec<Buffer> },
}

/// A descriptor set, and the copies of dynamic buffers that it points to, in the order of bindings.
struct SetOfCopies {
    copies: Vec<vk::Buffer>,
    set: Arc<DescriptorSet>,
}

/// What a binding of a group points to.
enum Bound {
    /// One target for each element.
    Targets(Vec<DescriptorTarget>),
    Dynamic(DynamicBuffer),
}

impl RawBindGroup {
    /// Whether this device made it.
    pub(crate) fn is_of(&self, gpu: &Gpu) -> bool {
        std::ptr::eq(Arc::as_ptr(&self.gpu), gpu)
    }

    /// How many bytes the buffer holds that is bound to `binding`, if a buffer is.
    pub(crate) fn bytes_of(&self, binding: u32) -> Option<u64> {
        self.bytes.iter().find(|(number, _)| *number == binding).map(|(_, bytes)| *bytes)
    }

    /// Its dynamic buffers, in the order of bindings.
    pub(crate) fn dynamic_buffers(&self) -> impl Iterator<Item = &DynamicBuffer> {
        let bindings = match &self.sets {
            Sets::One { .. } => &[][..],
            Sets::Each { bindings, .. } => bindings,
        };
        bindings.iter().filter_map(|(_, bound)| match bound {
            Bound::Targets(_) => None,
            Bound::Dynamic(buffer) => Some(buffer),
        })
    }

    /// The descriptor set for these copies of its dynamic buffers, which `hold` keeps from being written anew.
    ///
    /// # Errors
    /// No memory for another set.
    pub(crate) fn set(
        &self,
        copies: &[Arc<RawBuffer>],
        hold: impl FnOnce(&Arc<DescriptorSet>),
    ) -> Result<vk::DescriptorSet, Error> {
        let (bindings, made) = match &self.sets {
            Sets::One { set, .. } => return Ok(set.raw),
            Sets::Each { bindings, made, .. } => (bindings, made),
        };
        let mut made = made.lock().unwrap_or_else(PoisonError::into_inner);
        let has_these = |it: &SetOfCopies| it.copies.iter().eq(copies.iter().map(|copy| &copy.raw));
        let found = match made.iter().position(has_these) {
            Some(found) => found,
            None => match made.iter_mut().position(|it| it.rewrite(bindings, copies)) {
                Some(free) => free,
                None => {
                    made.push(SetOfCopies::new(&self.gpu, bindings, copies)?);
                    made.len() - 1
                }
            },
        };
        hold(&made[found].set);
        Ok(made[found].set.raw)
    }
}

impl SetOfCopies {
    fn new(
        gpu: &Arc<Gpu>,
        bindings: &[(LayoutBinding, Bound)],
        copies: &[Arc<RawBuffer>],
    ) -> Result<SetOfCopies, Error> {
        let copies: Vec<_> = copies.iter().map(|copy| copy.raw).collect();
        let mut left = copies.iter();
        let bindings = bindings.iter().map(|(binding, bound)| match bound {
            Bound::Targets(targets) => (*binding, targets.clone()),
            Bound::Dynamic(_) => (*binding, vec![DescriptorTarget::Buffer(left.next().copied().unwrap_or_default())]),
        });
        let set = Arc::new(DescriptorSet::new(gpu, &bindings.collect::<Vec<_>>())?);
        Ok(SetOfCopies { copies, set })
    }

    /// Has it point to other copies, unless a frame in flight reads it. Allocates nothing.
    fn rewrite(&mut self, bindings: &[(LayoutBinding, Bound)], copies: &[Arc<RawBuffer>]) -> bool {
        let Some(set) = Arc::get_mut(&mut self.set) else { return false };
        let dynamic = bindings.iter().filter(|(_, bound)| matches!(bound, Bound::Dynamic(_)));
        for (((binding, _), copy), kept) in dynamic.zip(copies).zip(&mut self.copies) {
            *kept = copy.raw;
            set.write(*binding, 0, DescriptorTarget::Buffer(copy.raw));
        }
        true
    }
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
        let of_set = supplied.iter().copied().cloned().collect();
        let of_set = DrawInterface { supplied: of_set, ..DrawInterface::default() };
        check_needs(&self.gpu, &ShaderInterface::default(), &of_set, &[], 0).map_err(bad)?;
        if let Some((binding, _)) =
            resources.iter().find(|(binding, _)| supplied.iter().all(|it| it.binding != *binding))
        {
            return Err(bad(format!("the draw interface has no binding {binding}")));
        }
        let is_own = |resource: &Resource<'_>| match resource {
            Resource::Buffer(buffer) => buffer.0.is_of(&self.gpu),
            Resource::Dynamic(buffer) => buffer.0.is_of(&self.gpu),
            Resource::Texture(texture) => texture.0.image.is_of(&self.gpu),
            Resource::Textures(textures) => textures.iter().all(|it| it.0.image.is_of(&self.gpu)),
            // The program's word.
            Resource::ProgramBuffer(_) | Resource::ProgramViews(_) => true,
        };
        if !resources.iter().all(|(_, resource)| is_own(resource)) {
            return Err(bad("a resource belongs to another device".to_owned()));
        }
        let (mut bindings, mut bytes) = (Vec::new(), Vec::new());
        let (mut buffers, mut textures) = (Vec::new(), Vec::new());
        for wanted in supplied {
            let name = &wanted.name;
            let given = resources.iter().filter(|(binding, _)| *binding == wanted.binding).map(|(_, given)| given);
            let given: Vec<_> = given.collect();
            let flags = match wanted.kind {
                SuppliedKind::UniformBlock => Some(vk::BufferUsageFlags::UNIFORM_BUFFER),
                SuppliedKind::StorageBlock => Some(vk::BufferUsageFlags::STORAGE_BUFFER),
                SuppliedKind::SampledImage => None,
            };
            let bound = match (wanted.kind, &given[..]) {
                (_, [Resource::Buffer(it)]) if flags.is_some_and(|flags| it.0.usage.contains(flags)) => {
                    buffers.push((*it).clone());
                    bytes.push((wanted.binding, it.bytes()));
                    Bound::Targets(vec![DescriptorTarget::Buffer(it.0.raw)])
                }
                (_, [Resource::Dynamic(it)]) if flags.is_some_and(|flags| it.0.flags.contains(flags)) => {
                    bytes.push((wanted.binding, it.bytes()));
                    Bound::Dynamic((*it).clone())
                }
                (kind, [Resource::ProgramBuffer(it)]) if flags.is_some() => {
                    if let Some(misfit) = it.misfit(&self.gpu, kind) {
                        return Err(bad(format!("`{name}`: {misfit}")));
                    }
                    bytes.push((wanted.binding, it.bytes));
                    Bound::Targets(vec![DescriptorTarget::BufferPart(it.buffer, it.offset, it.bytes)])
                }
                (SuppliedKind::SampledImage, [Resource::ProgramViews(views)]) => {
                    if views.len() as u64 != u64::from(wanted.count) {
                        let (count, given) = (wanted.count, views.len());
                        return Err(bad(format!("`{name}` takes {count} views and was given {given}")));
                    }
                    let is_null =
                        |it: &ProgramView| it.view == vk::ImageView::null() || it.sampler == vk::Sampler::null();
                    if views.iter().any(is_null) {
                        return Err(bad(format!("a view or sampler of `{name}` is VK_NULL_HANDLE")));
                    }
                    let target = |it: &ProgramView| DescriptorTarget::Image(it.view, it.layout, it.sampler);
                    Bound::Targets(views.iter().map(target).collect())
                }
                (SuppliedKind::SampledImage, [it @ (Resource::Texture(_) | Resource::Textures(_))]) => {
                    let these = it.textures();
                    if these.len() as u64 != u64::from(wanted.count) {
                        let (count, given) = (wanted.count, these.len());
                        return Err(bad(format!("`{name}` takes {count} textures and was given {given}")));
                    }
                    textures.extend_from_slice(these);
                    let layout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
                    let target = |it: &Texture| DescriptorTarget::Image(it.0.view, layout, it.0.sampler);
                    Bound::Targets(these.iter().map(target).collect())
                }
                (kind, [_]) => return Err(bad(format!("`{name}` is {}, and something else was given", kind.words()))),
                (_, given) => return Err(bad(format!("`{name}` is needed once and was given {} times", given.len()))),
            };
            bindings.push((layout_binding(wanted), bound));
        }
        let layout = self.gpu.set_layout(bindings.iter().map(|(binding, _)| *binding).collect())?;
        let fixed: Option<Vec<_>> =
            bindings.iter().map(|(binding, bound)| bound.targets().map(|it| (*binding, it.to_vec()))).collect();
        let sets = match fixed {
            Some(fixed) => Sets::One { set: DescriptorSet::new(&self.gpu, &fixed)?, _buffers: buffers },
            None => Sets::Each { bindings, made: Mutex::default(), _buffers: buffers },
        };
        Ok(BindGroup(Arc::new(RawBindGroup { gpu: self.gpu.clone(), layout, bytes, sets, _textures: textures })))
    }
}

impl Bound {
    /// What it always points to.
    fn targets(&self) -> Option<&[DescriptorTarget]> {
        match self {
            Bound::Targets(targets) => Some(targets),
            Bound::Dynamic(_) => None,
        }
    }
}

/// Every set from 1 on is visible in all stages, so that all shaders of a kind of draw share its layout, and kinds that bring the
/// same share bind groups.
fn layout_binding(supplied: &SuppliedResource) -> LayoutBinding {
    let ty = match supplied.kind {
        SuppliedKind::UniformBlock => vk::DescriptorType::UNIFORM_BUFFER,
        SuppliedKind::StorageBlock => vk::DescriptorType::STORAGE_BUFFER,
        SuppliedKind::SampledImage => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
    };
    let flags = vk::DescriptorBindingFlags::empty();
    LayoutBinding { binding: supplied.binding, ty, count: supplied.count, stages: ShaderStage::FLAGS, flags }
}

/// The layout of a set from 1 on that `interface` brings along; without bindings if it brings nothing in it.
pub(crate) fn supplied_layout(
    gpu: &Gpu,
    interface: &DrawInterface,
    set: u32,
) -> Result<vk::DescriptorSetLayout, Error> {
    gpu.set_layout(interface.supplied.iter().filter(|it| it.set == set).map(layout_binding).collect())
}
