//! The set that belongs to a pass: its images by the shader's names, and the block `params`.

use crate::caches::{AddressMode, LayoutBinding, SamplerDescriptor, TexelFilter};
use crate::convert;
use crate::descriptors::{DescriptorSet, Target};
use crate::device::Shared;
use crate::error::Error;
use crate::image::{Image, View, ViewShape};
use crate::memory::Kind;
use crate::resources::RawBuffer;
use ash::vk;
use framewright_graph::frame::ParamValue;
use framewright_graph::interface::{self, Block, Component, Dimension, ImageShape, PASS_SET};
use framewright_graph::plan;
use framewright_graph::vocabulary::{Aspects, Filter, Stages};
use std::sync::Arc;

/// Name of the block that holds a pass's parameters.
pub(crate) const PARAMS: &str = "params";

/// A pass's own descriptor set with all that it points to. Fields are dropped in this order.
pub(crate) struct PassSet {
    pub(crate) set: DescriptorSet,
    _views: Vec<View>,
    _params: Option<RawBuffer>,
}

impl PassSet {
    /// The set for `pass` and the interface of its shader.
    ///
    /// # Errors
    /// [`Error::Mismatch`] where the Plan and the shader don't name the same things.
    pub(crate) fn new(
        shared: &Arc<Shared>,
        images: &[Arc<Image>],
        pass: &plan::Pass,
        shader: &interface::ShaderInterface,
    ) -> Result<PassSet, Error> {
        let mismatch = |what: String| Error::Mismatch { pass: pass.name.to_string(), what };
        let own = || shader.bindings.iter().filter(|it| it.set == PASS_SET);
        if let Some(surplus) = pass.bindings.iter().find(|bound| own().all(|it| *it.name != *bound.name)) {
            return Err(mismatch(format!("the shader has no `{}`", surplus.name)));
        }
        let (mut bindings, mut views, mut params) = (Vec::new(), Vec::new(), None);
        for wanted in own() {
            let (ty, target) = match &wanted.kind {
                interface::BindingKind::UniformBlock(block) if wanted.name == PARAMS => {
                    let bytes = fill(block, &pass.params).map_err(mismatch)?;
                    let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
                    let mut buffer = RawBuffer::new(shared, PARAMS, bytes.len() as u64, usage, Kind::Upload)?;
                    buffer.fill(&bytes)?;
                    let raw = params.insert(buffer).raw;
                    (vk::DescriptorType::UNIFORM_BUFFER, Target::Buffer(raw))
                }
                interface::BindingKind::SampledImage(shape) | interface::BindingKind::StorageImage { shape, .. } => {
                    let bound = pass.bindings.iter().find(|it| *it.name == *wanted.name);
                    let bound = bound.ok_or_else(|| mismatch(format!("nothing is bound to `{}`", wanted.name)))?;
                    let (view, target) =
                        image(shared, images, bound, *shape, &wanted.kind).map_err(|error| match error {
                            Wrong::Shape(what) => mismatch(what),
                            Wrong::Vulkan(error) => error,
                        })?;
                    views.push(view);
                    let sampled = matches!(wanted.kind, interface::BindingKind::SampledImage(_));
                    let sampled_type = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
                    (if sampled { sampled_type } else { vk::DescriptorType::STORAGE_IMAGE }, target)
                }
                kind => return Err(mismatch(format!("`{}` can't be in set 0: {kind:?}", wanted.name))),
            };
            bindings.push((LayoutBinding { binding: wanted.binding, ty, stages: stages(wanted.stages) }, target));
        }
        let set = DescriptorSet::new(shared, &bindings)?;
        Ok(PassSet { set, _views: views, _params: params })
    }
}

/// Why an image can't be bound.
enum Wrong {
    Shape(String),
    Vulkan(Error),
}

/// A view of what is bound, in the shape that the shader declares.
fn image(
    shared: &Shared,
    images: &[Arc<Image>],
    bound: &plan::Binding,
    shape: ImageShape,
    kind: &interface::BindingKind,
) -> Result<(View, Target), Wrong> {
    let image = &images[bound.image.0 as usize];
    let sampled = matches!(kind, interface::BindingKind::SampledImage(_));
    if sampled != bound.filter.is_some() {
        return Err(Wrong::Shape(format!("`{}` is sampled by only one of Plan and shader", bound.name)));
    }
    if shape.multisampled != (image.descriptor.samples > 1) {
        let samples = image.descriptor.samples;
        return Err(Wrong::Shape(format!("`{}` has {samples} samples and another kind of sampler", bound.name)));
    }
    if sampled && shape.component != Component::of(image.descriptor.format) {
        let (wanted, format) = (shape.component, image.descriptor.format);
        return Err(Wrong::Shape(format!("the shader reads {wanted:?} from `{}`, which is {format}", bound.name)));
    }
    let view_shape = match (shape.dimension, shape.arrayed) {
        (Dimension::D2, false) if bound.range.layers == 1 => ViewShape::Flat,
        (Dimension::D2, true) => ViewShape::Layers,
        (Dimension::D3, false) => ViewShape::Volume,
        (Dimension::Cube, false) if bound.range.layers == 6 => ViewShape::Cube,
        _ => return Err(Wrong::Shape(format!("`{}` has another dimension than its image", bound.name))),
    };
    let mut range = bound.range;
    if range.aspects.contains(Aspects::DEPTH) {
        // A shader reads one plane at a time.
        range.aspects = Aspects::DEPTH;
    }
    let view = View::new(image, range, view_shape).map_err(Wrong::Vulkan)?;
    let sampler = match bound.filter {
        None => vk::Sampler::null(),
        Some(filter) => shared.sampler(sampler(filter)).map_err(Wrong::Vulkan)?,
    };
    let target = Target::Image(view.raw, convert::layout(bound.layout), sampler);
    Ok((view, target))
}

/// Images of a frame end at their edges and are read at one level.
fn sampler(filter: Filter) -> SamplerDescriptor {
    let filter = match filter {
        Filter::Nearest => TexelFilter::Nearest,
        Filter::Linear => TexelFilter::Linear,
    };
    SamplerDescriptor {
        magnify: filter,
        minify: filter,
        mip: TexelFilter::Nearest,
        address: [AddressMode::ClampToEdge; 2],
    }
}

/// Shader stages have other values than pipeline stages.
fn stages(stages: Stages) -> vk::ShaderStageFlags {
    let mut flags = vk::ShaderStageFlags::empty();
    if stages.contains(Stages::VERTEX_SHADER) {
        flags |= vk::ShaderStageFlags::VERTEX;
    }
    if stages.contains(Stages::FRAGMENT_SHADER) {
        flags |= vk::ShaderStageFlags::FRAGMENT;
    }
    flags
}

/// The bytes of a parameter block.
///
/// # Errors
/// In words: a member without value, a value without member, or one that the member's type can't hold.
fn fill(block: &Block, params: &[plan::Param]) -> Result<Vec<u8>, String> {
    if let Some(surplus) = params.iter().find(|param| block.members.iter().all(|it| *it.name != *param.name)) {
        return Err(format!("the block `{PARAMS}` has no member `{}`", surplus.name));
    }
    let mut bytes = vec![0; block.bytes.max(16) as usize];
    for member in &block.members {
        let param = params.iter().find(|it| *it.name == *member.name);
        let param = param.ok_or_else(|| format!("`{}` of the block `{PARAMS}` has no value", member.name))?;
        let value = value(&member.ty, param.value)
            .ok_or_else(|| format!("`{}` is a {}, and {:?} is none", member.name, member.ty, param.value))?;
        let at = member.offset as usize;
        bytes
            .get_mut(at..at + value.len())
            .ok_or_else(|| format!("`{}` lies outside its block", member.name))?
            .copy_from_slice(&value);
    }
    Ok(bytes)
}

/// A value as a member of type `ty` holds it; `None` if it can't.
fn value(ty: &str, value: ParamValue) -> Option<[u8; 4]> {
    let number = match value {
        ParamValue::Bool(value) => f64::from(u8::from(value)),
        // Beyond 2^53 no 32-bit type holds it anyway.
        ParamValue::Integer(value) => {
            i32::try_from(value).map(f64::from).or_else(|_| u32::try_from(value).map(f64::from)).ok()?
        }
        ParamValue::Number(value) => value,
    };
    match ty {
        "float" => {
            #[allow(clippy::cast_possible_truncation, reason = "shaders compute in 32 bits")]
            let narrowed = number as f32;
            narrowed.is_finite().then(|| narrowed.to_ne_bytes())
        }
        "int" if number.fract() == 0.0 && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&number) => {
            #[allow(clippy::cast_possible_truncation, reason = "the range was checked")]
            let whole = number as i32;
            Some(whole.to_ne_bytes())
        }
        "uint" if number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number) => {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range was checked")]
            let whole = number as u32;
            Some(whole.to_ne_bytes())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framewright_graph::interface::Member;

    fn member(name: &str, offset: u32, ty: &str) -> Member {
        Member { name: name.to_owned(), offset, ty: ty.to_owned() }
    }

    fn param(name: &str, value: ParamValue) -> plan::Param {
        plan::Param { name: name.into(), value }
    }

    #[test]
    fn parameters_land_at_their_members_offsets_in_their_members_types() {
        let members = vec![member("white", 0, "float"), member("steps", 4, "int"), member("on", 12, "uint")];
        let block = Block { bytes: 16, members };
        let params = [
            param("on", ParamValue::Bool(true)),
            param("white", ParamValue::Integer(3)),
            param("steps", ParamValue::Number(-2.0)),
        ];
        let mut expected = Vec::new();
        expected.extend(3.0_f32.to_ne_bytes());
        expected.extend((-2_i32).to_ne_bytes());
        expected.extend([0; 4]);
        expected.extend(1_u32.to_ne_bytes());
        assert_eq!(fill(&block, &params), Ok(expected));
    }

    #[test]
    fn parameters_that_do_not_fit_are_named() {
        let block = Block { bytes: 16, members: vec![member("steps", 0, "int")] };
        let message = |params: &[plan::Param]| fill(&block, params).err().unwrap_or_default();
        assert_eq!(message(&[]), "`steps` of the block `params` has no value");
        assert_eq!(message(&[param("steps", ParamValue::Number(0.5))]), "`steps` is a int, and Number(0.5) is none");
        let two = [param("steps", ParamValue::Integer(1)), param("speed", ParamValue::Integer(1))];
        assert_eq!(message(&two), "the block `params` has no member `speed`");
    }
}
