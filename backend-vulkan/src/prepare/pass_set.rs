//! The set that belongs to a pass: its images and buffers by the shader's names, and the block `params`.

use super::descriptions::part;
use super::frame::{Frame, FrameClock};
use super::param_block::ParamBlock;
use super::rings::RingCache;
use crate::base::{Error, convert, stage_flags};
use crate::gpu::{Gpu, LayoutBinding};
use crate::memory::{Image, RawBuffer, ViewShape};
use crate::pipeline::{DescriptorSet, DescriptorTarget};
use ash::vk;
use framewright_graph::frame::EyeForm;
use framewright_graph::plan::{self, BindingKind, BufferId, ImageId, Plan, Resource};
use framewright_graph::shader::{self, Block, PARAMS, PASS_SET, declared_name};
use framewright_graph::vulkan::{
    Accesses, Aspects, Component, Dimension, Filter, ImageShape, Sampler, Stages, Subresources, name_of,
};
use std::sync::Arc;

/// A pass's own descriptor sets with their bindings. Each frame's set points to the images and buffers of that frame.
pub(crate) struct PassSets {
    pub(crate) layout: vk::DescriptorSetLayout,
    /// With what is bound to each of their elements.
    bindings: Vec<(LayoutBinding, Vec<BoundResource>)>,
    /// `None` before the first frame.
    made: Option<RingCache<PassSet>>,
    /// The sets point to it, so it is dropped after them.
    params: Option<(Block, ParamBlock)>,
}

/// The block, buffer or image that is bound to one name.
enum BoundResource {
    Params,
    Buffer(BufferId),
    Sampler(Sampler),
    Image { image: ImageId, range: Subresources, shape: ViewShape, layout: vk::ImageLayout, sampler: Option<Sampler> },
}

/// The sets of a pass that were made, for frames on their way that read them.
pub(crate) struct MadeSets(#[expect(dead_code, reason = "it is kept until it is dropped")] RingCache<PassSet>);

/// A pass's own descriptor set with all that it points to. Fields are dropped in this order.
struct PassSet {
    set: DescriptorSet,
    _images: Vec<Arc<Image>>,
    _buffers: Vec<Arc<RawBuffer>>,
}

impl PassSets {
    /// The sets for `pass` and the bindings of its shader. `frames`: how many may be in flight.
    ///
    /// # Errors
    /// [`Error::Mismatch`] where the Plan and the shader don't name the same things.
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        plan: &Plan,
        pass: &plan::Pass,
        shader: &[shader::Binding],
        frames: u32,
    ) -> Result<PassSets, Error> {
        let mismatch = |what: String| Error::Mismatch { pass: pass.name.to_string(), what };
        let own = || shader.iter().filter(|it| it.set == PASS_SET);
        let bound = pass.accesses.iter().filter_map(|it| it.binding.as_ref()).map(|it| &it.name);
        let buffers = pass.buffers.iter().filter_map(|it| it.binding.as_ref());
        if let Some(surplus) = bound.chain(buffers).find(|bound| !own().any(|it| it.takes(bound))) {
            return Err(mismatch(format!("the shader has no `{surplus}`")));
        }
        let (mut bindings, mut params) = (Vec::new(), None);
        for wanted in own() {
            let (ty, bound) = match &wanted.kind {
                shader::BindingKind::UniformBlock(block)
                    if wanted.name == PARAMS && buffer_of(pass, PARAMS).is_none() =>
                {
                    params = Some((block.clone(), ParamBlock::new(gpu, block, pass, frames)?));
                    (vk::DescriptorType::UNIFORM_BUFFER, vec![BoundResource::Params])
                }
                shader::BindingKind::UniformBlock(_) | shader::BindingKind::StorageBlock { .. } => {
                    let (ty, bound) = block(plan, pass, wanted).map_err(mismatch)?;
                    (ty, vec![bound])
                }
                shader::BindingKind::Sampler { images, compares } => {
                    let sampler = separate_sampler(pass, &wanted.name, images, *compares).map_err(mismatch)?;
                    (vk::DescriptorType::SAMPLER, vec![BoundResource::Sampler(sampler)])
                }
                shader::BindingKind::SampledImage(_)
                | shader::BindingKind::ComparedDepth(_)
                | shader::BindingKind::StorageImage { .. }
                | shader::BindingKind::InputAttachment { .. }
                | shader::BindingKind::Other(_) => images(gpu, plan, pass, wanted).map_err(mismatch)?,
            };
            let (binding, count, stages) = (wanted.binding, wanted.count(), stage_flags(wanted.stages));
            bindings.push((
                LayoutBinding { binding, ty, count, stages, flags: vk::DescriptorBindingFlags::empty() },
                bound,
            ));
        }
        let layout = gpu.set_layout(bindings.iter().map(|(binding, _)| *binding).collect())?;
        Ok(PassSets { layout, bindings, made: None, params })
    }

    /// Sets without bindings.
    pub(crate) fn empty(gpu: &Gpu) -> Result<PassSets, Error> {
        Ok(PassSets { layout: gpu.set_layout(Vec::new())?, bindings: Vec::new(), made: None, params: None })
    }

    /// The block `params` with the values that `pass` has now, for [`PassSets::take`]; `None`: the shader has none.
    pub(crate) fn params_of(
        &self,
        gpu: &Arc<Gpu>,
        pass: &plan::Pass,
        frames: u32,
    ) -> Result<Option<ParamBlock>, Error> {
        self.params.as_ref().map(|(block, _)| ParamBlock::new(gpu, block, pass, frames)).transpose()
    }

    /// Whether each frame has values of its own.
    pub(super) fn has_frame_values(&self) -> bool {
        self.params.as_ref().is_some_and(|(_, params)| params.has_frame_values())
    }

    /// After how many frames the same block `params` is read again.
    pub(super) fn params_period(&self) -> u64 {
        self.params.as_ref().map_or(1, |(_, params)| params.period())
    }

    /// Writes the values of a frame. The frame that took its place in flight before must have been waited for.
    pub(super) fn write_frame_values(&mut self, frame: u64, clock: FrameClock) -> Result<(), Error> {
        self.params.as_mut().map_or(Ok(()), |(_, params)| params.write(frame, clock))
    }

    /// Fills the sets with other parameters. Those that they had so far must not be in use.
    pub(crate) fn take(&mut self, filled: ParamBlock) {
        self.forget();
        if let Some((_, params)) = &mut self.params {
            *params = filled;
        }
    }

    /// Forgets all sets: other images or buffers stand for the Plan's now. None may be in use.
    pub(super) fn forget(&mut self) {
        self.made = None;
    }

    /// Forgets all sets if they point to this one, for which another stands now, and returns them.
    pub(super) fn replace(&mut self, resource: Resource) -> Option<MadeSets> {
        let points = resources(&self.bindings).any(|it| it == resource);
        self.made.take_if(|_| points).map(MadeSets)
    }

    /// The set for a frame; `None` if it would be empty.
    pub(super) fn prepare(&mut self, frame: &Frame<'_>) -> Result<Option<vk::DescriptorSet>, Error> {
        if self.bindings.is_empty() {
            return Ok(None);
        }
        let (bindings, params) = (&self.bindings, self.params.as_ref().map(|(_, params)| params));
        let params_period = params.map_or(1, ParamBlock::period);
        let period = || frame.physical.period(resources(bindings)).and_every(params_period);
        let made = self.made.get_or_insert_with(|| RingCache::new(period()));
        made.prepare(frame.turn(), || PassSet::new(frame, bindings, params)).map(|made| Some(made.set.raw))
    }
}

/// The images and buffers that are bound.
fn resources(bindings: &[(LayoutBinding, Vec<BoundResource>)]) -> impl Iterator<Item = Resource> {
    bindings.iter().flat_map(|(_, elements)| elements).filter_map(|bound| match *bound {
        BoundResource::Params | BoundResource::Sampler(_) => None,
        BoundResource::Buffer(buffer) => Some(Resource::Buffer(buffer)),
        BoundResource::Image { image, .. } => Some(Resource::Image(image)),
    })
}

impl PassSet {
    fn new(
        frame: &Frame<'_>,
        bindings: &[(LayoutBinding, Vec<BoundResource>)],
        params: Option<&ParamBlock>,
    ) -> Result<PassSet, Error> {
        let (mut images, mut buffers, mut targets) = (Vec::new(), Vec::new(), Vec::new());
        for (binding, elements) in bindings {
            let mut pointed_to = Vec::with_capacity(elements.len());
            for bound in elements {
                pointed_to.push(match bound {
                    BoundResource::Params => {
                        let Some(params) = params else { continue };
                        DescriptorTarget::Buffer(params.buffer(frame.number))
                    }
                    BoundResource::Buffer(buffer) => {
                        let buffer = frame.buffer(*buffer);
                        buffers.push(buffer.clone());
                        DescriptorTarget::Buffer(buffer.raw)
                    }
                    BoundResource::Sampler(sampler) => DescriptorTarget::Sampler(frame.gpu.sampler(*sampler)?),
                    BoundResource::Image { image, range, shape, layout, sampler } => {
                        let image = frame.image(*image);
                        images.push(image.clone());
                        let sampler = sampler.map(|it| frame.gpu.sampler(it)).transpose()?;
                        DescriptorTarget::Image(image.view(*range, *shape)?, *layout, sampler.unwrap_or_default())
                    }
                });
            }
            targets.push((*binding, pointed_to));
        }
        let set = DescriptorSet::new(frame.gpu, &targets)?;
        Ok(PassSet { set, _images: images, _buffers: buffers })
    }
}

/// The access to the buffer that is bound to `name`.
fn buffer_of<'p>(pass: &'p plan::Pass, name: &str) -> Option<&'p plan::BufferAccess> {
    pass.buffers.iter().find(|it| it.binding.as_deref() == Some(name))
}

/// The buffer behind a block.
fn block(
    plan: &Plan,
    pass: &plan::Pass,
    wanted: &shader::Binding,
) -> Result<(vk::DescriptorType, BoundResource), String> {
    let name = &wanted.name;
    let access = buffer_of(pass, name).ok_or_else(|| format!("nothing is bound to `{name}`"))?;
    in_stages(wanted, access.stages)?;
    let buffer = &plan.buffers[access.buffer.0 as usize];
    let bound = BoundResource::Buffer(access.buffer);
    let is_uniform = access.accesses.contains(Accesses::UNIFORM_READ);
    match (wanted.kind.uniform_block(), wanted.kind.storage_block()) {
        (Some(block), _) if is_uniform => {
            long_enough(name, block.bytes, buffer.bytes.next_multiple_of(16), buffer.bytes)?;
            Ok((vk::DescriptorType::UNIFORM_BUFFER, bound))
        }
        (_, Some((writable, bytes))) if !is_uniform => {
            only_read(name, writable, access.accesses)?;
            long_enough(name, bytes, buffer.bytes, buffer.bytes)?;
            Ok((vk::DescriptorType::STORAGE_BUFFER, bound))
        }
        _ => Err(format!("`{name}` is a uniform block to only one of Plan and shader")),
    }
}

/// Checks that a block fits its buffer. `held`: bytes that the device may read, padding included; `there`: bytes of the buffer itself.
fn long_enough(name: &str, bytes: u32, held: u64, there: u64) -> Result<(), String> {
    if u64::from(bytes) > held {
        return Err(format!("the block `{name}` takes {bytes} bytes, and its buffer holds {there}"));
    }
    Ok(())
}

/// The Plan's barriers wait for the stages that it names, and for no others.
fn in_stages(wanted: &shader::Binding, planned: Stages) -> Result<(), String> {
    if planned.contains(wanted.stages) || planned.contains(Stages::ALL_COMMANDS) {
        return Ok(());
    }
    let (name, stages, planned) = (&wanted.name, name_of(&wanted.stages), name_of(&planned));
    Err(format!("the shader uses `{name}` in {stages}, and the Plan has it used in {planned}"))
}

/// A shader that may write what the Plan takes to be only read would race with others.
fn only_read(name: &str, writable: bool, accesses: Accesses) -> Result<(), String> {
    if writable && !accesses.contains(Accesses::SHADER_STORAGE_WRITE) {
        return Err(format!("the Plan only reads `{name}`: declare it `readonly` in the shader"));
    }
    Ok(())
}

/// The parts of images that are bound: one, or one for each element of an array.
fn images(
    gpu: &Gpu,
    plan: &Plan,
    pass: &plan::Pass,
    wanted: &shader::Binding,
) -> Result<(vk::DescriptorType, Vec<BoundResource>), String> {
    let (mut ty, mut bound) = (vk::DescriptorType::default(), Vec::new());
    for element in 0..wanted.count() {
        let (of_element, resource) = image(gpu, plan, pass, wanted, &wanted.element(element))?;
        ty = of_element;
        bound.push(resource);
    }
    Ok((ty, bound))
}

/// The state of a sampler by itself: that of the images that it samples, which are given alike.
fn separate_sampler(pass: &plan::Pass, name: &str, images: &[String], compares: bool) -> Result<Sampler, String> {
    let given = pass.accesses.iter().filter_map(|it| it.binding.as_ref());
    let mut states = given.filter_map(|it| match it.kind {
        BindingKind::Sampled(sampler) if images.iter().any(|image| *image == declared_name(&it.name)) => {
            Some(sampler.comparing(compares))
        }
        BindingKind::Sampled(_) | BindingKind::Storage | BindingKind::InputAttachment => None,
    });
    let first = states.next().unwrap_or(Sampler::new(Filter::Nearest));
    match states.all(|state| state == first) {
        true => Ok(first),
        false => Err(format!("the sampler `{name}` samples images that the Plan samples in different ways")),
    }
}

/// The part of an image that is bound to `name`, in the shape that the shader declares.
fn image(
    gpu: &Gpu,
    plan: &Plan,
    pass: &plan::Pass,
    wanted: &shader::Binding,
    name: &str,
) -> Result<(vk::DescriptorType, BoundResource), String> {
    let bound = pass.accesses.iter().find_map(|it| {
        let binding = it.binding.as_ref().filter(|binding| *binding.name == *name)?;
        Some((it, binding.kind))
    });
    let (access, kind) = bound.ok_or_else(|| format!("nothing is bound to `{name}`"))?;
    in_stages(wanted, access.stages)?;
    let image = plan.image(access.image);
    if wanted.length.is_some() && image.eyes.is_some() {
        return Err(format!("`{name}` holds both eyes' parts, and no element of an array can"));
    }
    let mut range = part(image, access.range);
    if let (Some(EyeForm::Layers), Some(eye)) = (image.eyes, access.eye) {
        range = Subresources { base_layer: eye as u32, layers: 1, ..range };
    }
    if image.format.aspects().contains(Aspects::DEPTH | Aspects::STENCIL) && range.aspects != Aspects::STENCIL {
        // A shader reads one plane at a time.
        range.aspects = Aspects::DEPTH;
    }
    let component = if range.aspects == Aspects::STENCIL { Component::Uint } else { Component::of(image.format) };
    let read = |wanted: Component| {
        if wanted == component {
            return Ok(());
        }
        Err(format!("the shader reads {} from `{name}`, which is {}", wanted.words(), image.format))
    };
    let samples = |multisampled: bool| {
        if multisampled == (image.samples > 1) {
            return Ok(());
        }
        Err(format!("`{name}` has {} samples and another kind of sampler", image.samples))
    };
    let layout = convert::layout(access.layout);
    let whole = |shape, sampler| BoundResource::Image { image: access.image, range, shape, layout, sampler };
    if let Some(other) = wanted.kind.unbindable() {
        return Err(format!("`{name}` can't be in set 0: {}", other.what));
    }
    let otherwise =
        |bound| Err(format!("`{name}` is bound as {bound}, and the shader declares {}", wanted.kind.words()));
    match kind {
        BindingKind::Sampled(sampler) => {
            let Some(shape) = wanted.kind.sampled() else { return otherwise("a sampled image") };
            if wanted.kind.is_compared() != sampler.compare.is_some() {
                return Err(format!("`{name}` is compared with a depth by only one of Plan and shader"));
            }
            samples(shape.multisampled)?;
            read(shape.component)?;
            let arrayed = shape.arrayed || range.layers > 1 && image.eyes.is_some();
            let shape = view_shape(gpu, name, ImageShape { arrayed, ..shape }, image, range)?;
            Ok(match wanted.separate {
                true => (vk::DescriptorType::SAMPLED_IMAGE, whole(shape, None)),
                false => (vk::DescriptorType::COMBINED_IMAGE_SAMPLER, whole(shape, Some(sampler))),
            })
        }
        BindingKind::Storage => {
            let Some((shape, format)) = wanted.kind.storage_image() else { return otherwise("a storage image") };
            samples(shape.multisampled)?;
            only_read(name, wanted.kind.is_written(), access.accesses)?;
            match format {
                Some(declared) if declared != image.format => {
                    return Err(format!("the shader declares `{name}` with {declared}, and it is {}", image.format));
                }
                // Without a format it may have any with such components.
                _ => read(shape.component)?,
            }
            let shape = view_shape(gpu, name, shape, image, range)?;
            Ok((vk::DescriptorType::STORAGE_IMAGE, whole(shape, None)))
        }
        BindingKind::InputAttachment => {
            let Some((multisampled, component)) = wanted.kind.input_attachment() else {
                return otherwise("an input attachment");
            };
            samples(multisampled)?;
            read(component)?;
            let shape = if range.layers > 1 { ViewShape::Layers } else { ViewShape::Flat };
            Ok((vk::DescriptorType::INPUT_ATTACHMENT, whole(shape, None)))
        }
    }
}

/// The view that a shader's declaration needs.
fn view_shape(
    gpu: &Gpu,
    name: &str,
    shape: ImageShape,
    image: &plan::Image,
    range: Subresources,
) -> Result<ViewShape, String> {
    let deep = image.shape == framewright_graph::vulkan::Shape::D3;
    let cubic = image.shape == framewright_graph::vulkan::Shape::Cube;
    match (shape.dimension, shape.arrayed) {
        (Dimension::D2, false) if range.layers == 1 && !deep => Ok(ViewShape::Flat),
        (Dimension::D2, true) if !deep => Ok(ViewShape::Layers),
        (Dimension::D3, false) if deep => Ok(ViewShape::Volume),
        (Dimension::Cube, false) if cubic && range.layers == 6 => Ok(ViewShape::Cube),
        (Dimension::Cube, true) if !gpu.features.cube_arrays() => {
            Err(format!("`{name}`: this device has no arrays of cubes"))
        }
        (Dimension::Cube, true) if cubic && range.layers.is_multiple_of(6) => Ok(ViewShape::Cubes),
        _ => Err(format!("`{name}` has another dimension than its image")),
    }
}
