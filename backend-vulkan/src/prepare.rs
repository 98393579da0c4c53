//! From a Plan to the objects that executing it needs: images in heaps, views, pipelines, descriptor sets.

use crate::descriptors::supplied_layouts;
use crate::device::Shared;
use crate::error::Error;
use crate::image::{Image, View, ViewShape};
use crate::memory::{Kind, Memory};
use crate::pass_set::PassSet;
use crate::pipeline::{PipelineDescriptor, VertexAttribute};
use crate::recorder::PassState;
use crate::shaders::{CompiledShader, ShaderLibrary};
use ash::vk;
use framewright_graph::device::ImageDescriptor;
use framewright_graph::frame::Draw;
use framewright_graph::interface::{
    Binding, BindingKind, Component, Dimension, DrawInterface, ImageShape, PASS_SET, ShaderInterfaces, SuppliedKind,
};
use framewright_graph::plan::{self, Plan, RenderScope, Role, Subresources, Work};
use framewright_graph::vocabulary::Usage;
use std::sync::Arc;

/// Everything that a Plan needs on a device.
pub(crate) struct Prepared {
    /// By image id.
    pub(crate) images: Vec<Arc<Image>>,
    /// By step; `None` for steps without rendering scope.
    pub(crate) scopes: Vec<Option<Scope>>,
}

/// A rendering scope's objects.
pub(crate) struct Scope {
    /// Each colour attachment with its resolve target.
    pub(crate) color: Vec<Views>,
    pub(crate) depth: Option<Views>,
    pub(crate) passes: Vec<Pass>,
}

/// An attachment's view and that of its resolve target.
pub(crate) struct Views {
    pub(crate) attachment: View,
    pub(crate) resolve: Option<View>,
}

/// A pass's objects.
pub(crate) struct Pass {
    pub(crate) draw: Draw,
    pub(crate) pipeline: vk::Pipeline,
    pub(crate) own: PassSet,
    pub(crate) state: PassState,
}

/// The description of a Plan's image on this device. Outputs can be read back whatever the Plan says.
pub(crate) fn descriptor(image: &plan::Image) -> ImageDescriptor {
    let usage = match image.role {
        Role::Transient(_) => image.usage,
        Role::Output { .. } => image.usage | Usage::TRANSFER_SRC,
    };
    let plan::Image { format, extent, mips, layers, samples, .. } = *image;
    ImageDescriptor { format, extent, mips, layers, samples, usage }
}

impl Prepared {
    /// Makes everything. The Plan must have passed [`crate::check`].
    pub(crate) fn new(shared: &Arc<Shared>, plan: &Plan, shaders: &mut ShaderLibrary) -> Result<Prepared, Error> {
        let images = images(shared, plan)?;
        let mut scopes = Vec::new();
        for step in &plan.steps {
            scopes.push(match &step.work {
                Work::Render(scope) => Some(self::scope(shared, plan, &images, scope, shaders)?),
                _ => None,
            });
        }
        Ok(Prepared { images, scopes })
    }
}

/// Heaps, and the images in them; outputs get memory of their own.
fn images(shared: &Arc<Shared>, plan: &Plan) -> Result<Vec<Arc<Image>>, Error> {
    let mut heaps = Vec::new();
    for (index, heap) in plan.heaps.iter().enumerate() {
        let lazy = if heap.lazily_allocated { lazy_types(shared) } else { u32::MAX };
        let requirements = vk::MemoryRequirements {
            size: heap.bytes.max(1),
            alignment: heap.alignment.max(1),
            memory_type_bits: heap.type_bits & lazy,
        };
        heaps.push(Arc::new(Memory::new(shared, &format!("heap {index}"), requirements, Kind::Images)?));
    }
    plan.images
        .iter()
        .map(|image| {
            let descriptor = descriptor(image);
            let made = match &image.role {
                Role::Transient(place) => {
                    Image::new(shared, &image.name, &descriptor, heaps[place.heap as usize].clone(), place.offset)
                }
                Role::Output { .. } => Image::with_own_memory(shared, &image.name, &descriptor),
            };
            made.map(Arc::new)
        })
        .collect()
}

/// The memory types that are allocated lazily, one bit each.
fn lazy_types(shared: &Shared) -> u32 {
    // SAFETY: the physical device belongs to the instance.
    let memory = unsafe { shared.instance.raw.get_physical_device_memory_properties(shared.physical) };
    let lazy = |ty: &vk::MemoryType| ty.property_flags.contains(vk::MemoryPropertyFlags::LAZILY_ALLOCATED);
    (0..).zip(memory.memory_types_as_slice()).filter(|(_, ty)| lazy(ty)).fold(0, |bits, (bit, _)| bits | 1 << bit)
}

fn scope(
    shared: &Arc<Shared>,
    plan: &Plan,
    images: &[Arc<Image>],
    scope: &RenderScope,
    shaders: &mut ShaderLibrary,
) -> Result<Scope, Error> {
    let view = |image: plan::ImageId, range: Subresources| {
        let shape = if range.layers > 1 { ViewShape::Layers } else { ViewShape::Flat };
        View::new(&images[image.0 as usize], range, shape)
    };
    let views = |attachment: &plan::Attachment| {
        let resolve = attachment.resolve.as_ref().map(|resolve| view(resolve.image, resolve.range)).transpose()?;
        Ok::<_, Error>(Views { attachment: view(attachment.image, attachment.range)?, resolve })
    };
    let color = scope.color.iter().map(views).collect::<Result<_, _>>()?;
    let depth = scope.depth.as_ref().map(views).transpose()?;
    let mut passes = Vec::new();
    for pass in &scope.passes {
        passes.push(self::pass(shared, plan, images, scope, pass, shaders)?);
    }
    Ok(Scope { color, depth, passes })
}

fn pass(
    shared: &Arc<Shared>,
    plan: &Plan,
    images: &[Arc<Image>],
    scope: &RenderScope,
    pass: &plan::Pass,
    shaders: &mut ShaderLibrary,
) -> Result<Pass, Error> {
    let mismatch = |what: String| Error::Mismatch { pass: pass.name.to_string(), what };
    let draw = pass.draw.ok_or_else(|| mismatch("a rendering scope holds a dispatch".to_owned()))?;
    let shader = shaders
        .compiled(&pass.shader, draw)
        .map_err(|problem| Error::Shader { name: pass.shader.to_string(), problem })?;
    let brought = shaders.brought_along(draw);
    check_brought(shared, &brought).map_err(mismatch)?;
    check_limits(shared, &shader, &brought).map_err(mismatch)?;
    check_supplied(&shader, &brought).map_err(mismatch)?;
    check_outputs(&shader, plan, scope).map_err(mismatch)?;
    let attributes = attributes(&shader, &brought).map_err(mismatch)?;
    let own = PassSet::new(shared, images, pass, &shader.interface)?;
    let supplied = supplied_layouts(shared, &brought)?;
    let layout = shared.pipeline_layout([own.set.layout].into_iter().chain(supplied.iter().copied()).collect())?;
    let reads = |set| shader.interface.bindings.iter().any(|it| it.set == set);
    let vertex_stride = if attributes.is_empty() { 0 } else { brought.vertex_stride };
    let format = |attachment: &plan::Attachment| plan.image(attachment.image).format;
    let descriptor = PipelineDescriptor {
        vertex: shader.vertex.clone(),
        fragment: shader.fragment.clone(),
        layout,
        vertex_stride,
        attributes,
        color: scope.color.iter().map(format).zip(pass.blend.iter().copied()).collect(),
        depth_format: scope.depth.as_ref().map(format),
        depth: pass.depth,
        samples: scope.samples,
    };
    let pipeline = shared.pipeline(&pass.name, descriptor)?;
    let supplied = (PASS_SET + 1..).zip(supplied).map(|(set, layout)| (layout, reads(set))).collect();
    Ok(Pass { draw, pipeline, own, state: PassState { layout, supplied, vertex_stride } })
}

/// A stage may be given so many resources of a kind and read so large a block, and no more. What is brought along counts
/// whether it is read or not.
fn check_limits(shared: &Shared, shader: &CompiledShader, brought: &DrawInterface) -> Result<(), String> {
    let limits = &shared.limits;
    let bindings = &shader.interface.bindings;
    let count = |own: fn(&BindingKind) -> bool, supplied: Option<SuppliedKind>| {
        bindings.iter().filter(|it| it.set == PASS_SET && own(&it.kind)).count()
            + brought.supplied.iter().filter(|it| Some(it.kind) == supplied).count()
    };
    let sampled = limits.max_per_stage_descriptor_samplers.min(limits.max_per_stage_descriptor_sampled_images);
    let counts = [
        (
            "sampled images",
            count(|it| matches!(it, BindingKind::SampledImage(_)), Some(SuppliedKind::SampledImage)),
            sampled,
        ),
        (
            "storage images",
            count(|it| matches!(it, BindingKind::StorageImage { .. }), None),
            limits.max_per_stage_descriptor_storage_images,
        ),
        (
            "uniform blocks",
            count(|it| matches!(it, BindingKind::UniformBlock(_)), Some(SuppliedKind::UniformBlock)),
            limits.max_per_stage_descriptor_uniform_buffers,
        ),
        (
            "storage blocks",
            count(|_| false, Some(SuppliedKind::StorageBlock)),
            limits.max_per_stage_descriptor_storage_buffers,
        ),
    ];
    if let Some((what, count, most)) = counts.into_iter().find(|(_, count, most)| *count > *most as usize) {
        return Err(format!("{count} {what} are bound, and this device allows {most}"));
    }
    let block = bindings.iter().find_map(|it| match &it.kind {
        BindingKind::UniformBlock(block) if block.bytes > limits.max_uniform_buffer_range => {
            Some((&it.name, block.bytes))
        }
        _ => None,
    });
    block.map_or(Ok(()), |(name, bytes)| {
        Err(format!("the block `{name}` takes {bytes} bytes, more than this device allows"))
    })
}

/// Sets from 1 on: what the shader reads must be what the draw brings along.
fn check_supplied(shader: &CompiledShader, brought: &DrawInterface) -> Result<(), String> {
    let same_kind = |binding: &Binding, kind| {
        matches!(
            (&binding.kind, kind),
            (BindingKind::UniformBlock(_), SuppliedKind::UniformBlock)
                | (BindingKind::StorageBlock { writable: false }, SuppliedKind::StorageBlock)
                | (BindingKind::SampledImage(PLAIN), SuppliedKind::SampledImage)
        )
    };
    for read in shader.interface.bindings.iter().filter(|it| it.set != PASS_SET) {
        let found = brought.supplied.iter().find(|it| (it.set, it.binding) == (read.set, read.binding));
        if found.is_none_or(|it| it.name != read.name || !same_kind(read, it.kind)) {
            return Err(format!(
                "the shader reads `{}` at set {}, binding {}, where this kind of draw brings along {}",
                read.name,
                read.set,
                read.binding,
                found.map_or("nothing".to_owned(), |it| format!("`{}`, a {:?}", it.name, it.kind)),
            ));
        }
    }
    Ok(())
}

/// Every colour attachment must be written, in its own type: what a shader leaves out has undefined colour.
fn check_outputs(shader: &CompiledShader, plan: &Plan, scope: &RenderScope) -> Result<(), String> {
    for (location, attachment) in (0..).zip(&scope.color) {
        let output = shader.interface.outputs.iter().find(|it| it.location == location);
        let output = output.ok_or_else(|| format!("the shader writes no colour at location {location}"))?;
        let image = plan.image(attachment.image);
        if output.component != Component::of(image.format) {
            let (name, format) = (&image.name, image.format);
            return Err(format!("the shader writes {:?} to `{name}`, which is {format}", output.component));
        }
    }
    Ok(())
}

/// What an image is that whoever draws brings along.
const PLAIN: ImageShape =
    ImageShape { dimension: Dimension::D2, arrayed: false, multisampled: false, component: Component::Float };

/// What whoever draws brings along must be something that Vulkan can bind.
pub(crate) fn check_brought(shared: &Shared, brought: &DrawInterface) -> Result<(), String> {
    let limits = &shared.limits;
    let stride = brought.vertex_stride;
    if stride > limits.max_vertex_input_binding_stride {
        return Err(format!("vertices of {stride} bytes are more than this device allows"));
    }
    for attribute in &brought.attributes {
        let end = attribute.components.checked_mul(4).and_then(|bytes| attribute.offset.checked_add(bytes));
        let fits = (1..=4).contains(&attribute.components)
            && attribute.offset <= limits.max_vertex_input_attribute_offset
            && end.is_some_and(|end| end <= stride);
        if !fits || !attribute.offset.is_multiple_of(4) || !stride.is_multiple_of(4) {
            return Err(format!("the vertex attribute `{}` doesn't fit vertices of {stride} bytes", attribute.name));
        }
    }
    for (at, one) in brought.supplied.iter().enumerate() {
        if one.set == PASS_SET || one.set >= limits.max_bound_descriptor_sets {
            return Err(format!("`{}` can't be brought along in set {}", one.name, one.set));
        }
        if brought.supplied[..at].iter().any(|other| (other.set, other.binding) == (one.set, one.binding)) {
            return Err(format!("`{}` is brought along where something else is", one.name));
        }
    }
    Ok(())
}

/// The vertex attributes by the shader's locations.
fn attributes(shader: &CompiledShader, brought: &DrawInterface) -> Result<Vec<VertexAttribute>, String> {
    shader
        .interface
        .vertex_inputs
        .iter()
        .map(|input| {
            let found = brought.attributes.iter().find(|it| it.name == input.name);
            let found = found.ok_or_else(|| format!("vertices of this kind of draw have no `{}`", input.name))?;
            if !matches!(input.ty.as_str(), "float" | "vec2" | "vec3" | "vec4") {
                return Err(format!(
                    "the vertex attribute `{}` is a {}, and floats are brought along",
                    input.name, input.ty
                ));
            }
            Ok(VertexAttribute { location: input.location, components: found.components, offset: found.offset })
        })
        .collect()
}
