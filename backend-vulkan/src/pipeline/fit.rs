//! Whether a shader fits what its pass and its draw source give it, and the device.

use crate::base::by;
use crate::gpu::{Gpu, VertexAttribute};
use ash::vk;
use framewright_graph::plan::{self, Plan};
use framewright_graph::shader::{DrawInterface, PASS_SET, ShaderInterface, Supplied, VertexInput};
use framewright_graph::vulkan::Component;

/// The device must have the features that the shader needs.
pub(crate) fn check_features(gpu: &Gpu, shader: &ShaderInterface) -> Result<(), String> {
    match shader.features.iter().find(|name| !gpu.features.has(name)) {
        None => Ok(()),
        Some(name) => Err(format!("its shader needs the feature {name}, which this device doesn't have")),
    }
}

/// Sets from 1 on: what the shader reads must be what the draw brings along.
pub(crate) fn check_supplied(shader: &ShaderInterface, brought: &DrawInterface) -> Result<(), String> {
    for read in shader.bindings.iter().filter(|it| it.set != PASS_SET) {
        let found = brought.supplied.iter().find(|it| (it.set, it.binding) == (read.set, read.binding));
        if found.is_none_or(|it| !it.is(read)) {
            return Err(format!(
                "the shader reads `{}` at set {}, binding {}, where this kind of draw brings along {}",
                array_words(&read.name, read.length),
                read.set,
                read.binding,
                found.map_or("nothing".to_owned(), |it| format!("`{}`, {}", it.name, in_words(it))),
            ));
        }
    }
    Ok(())
}

/// A name as it is declared: of an array with its length.
fn array_words(name: &str, length: Option<u32>) -> String {
    length.map_or_else(|| name.to_owned(), |length| format!("{name}[{length}]"))
}

/// What a draw source brings along.
fn in_words(supplied: &Supplied) -> String {
    match (supplied.count, supplied.kind.words()) {
        (1, kind) => kind.to_owned(),
        (count, kind) => format!("an array of {count}, each {kind}"),
    }
}

/// Every colour attachment of the pass, by location, must be written in its own type: what a shader leaves out has undefined
/// colour.
pub(crate) fn check_outputs(
    shader: &ShaderInterface,
    plan: &Plan,
    attachments: &[&plan::Attachment],
) -> Result<(), String> {
    for (location, attachment) in (0..).zip(attachments) {
        let output = shader.outputs.iter().find(|it| it.location == location);
        let output = output.ok_or_else(|| format!("the shader writes no colour at location {location}"))?;
        let image = plan.image(attachment.image);
        if output.component != Component::of(image.format) {
            let (name, format) = (&image.name, image.format);
            return Err(format!("the shader writes {} to `{name}`, which is {format}", output.component.words()));
        }
    }
    Ok(())
}

/// Checks that Vulkan can bind the vertices and bindings that the draw source provides.
pub(crate) fn check_brought(brought: &DrawInterface) -> Result<(), String> {
    brought.faults().into_iter().next().map_or(Ok(()), |fault| Err(fault.message))
}

/// The vertex attributes by the shader's locations, from one buffer that the draw source provides.
pub(crate) fn brought_attributes(
    shader: &ShaderInterface,
    brought: &DrawInterface,
) -> Result<Vec<VertexAttribute>, String> {
    let attribute = |input: &VertexInput| {
        let found = brought.attributes.iter().find(|it| it.name == *input.name);
        let found = found.ok_or_else(|| format!("vertices of this kind of draw have no `{}`", input.name))?;
        if !input.is_float() {
            let (name, ty) = (&input.name, &input.ty);
            return Err(format!("the vertex attribute `{name}` is a {ty}, and floats are brought along"));
        }
        let format = attribute_format('f', found.components);
        Ok(VertexAttribute { location: input.location, binding: 0, format, offset: found.offset })
    };
    shader.vertex_inputs.iter().map(attribute).collect()
}

/// The vertex attributes from the pass's own vertex buffers, with the bytes from vertex to vertex of each: out of one
/// buffer all attributes of a vertex, in the order of their locations and without gaps; out of several, one attribute each.
/// Components are 32 bits wide and of the type that the shader declares.
pub(crate) fn own_attributes(
    shader: &ShaderInterface,
    buffers: usize,
) -> Result<(Vec<VertexAttribute>, Vec<u32>), String> {
    let mut inputs: Vec<&VertexInput> = shader.vertex_inputs.iter().collect();
    inputs.sort_by_key(|it| it.location);
    if buffers != 1 && buffers != inputs.len() {
        let wanted = inputs.len();
        return Err(format!(
            "it has {buffers} vertex buffers for {wanted} vertex attributes: one buffer, or one for each"
        ));
    }
    let (mut attributes, mut strides) = (Vec::new(), vec![0; buffers]);
    for (number, input) in (0_u32..).zip(inputs) {
        let (kind, components) = match input.ty.as_str() {
            "float" => ('f', 1),
            "int" => ('i', 1),
            "uint" => ('u', 1),
            ty => {
                let kind = ty.strip_prefix("vec").map(|n| ('f', n)).or(ty.strip_prefix("ivec").map(|n| ('i', n)));
                let kind = kind.or(ty.strip_prefix("uvec").map(|n| ('u', n)));
                let parsed = kind.and_then(|(kind, count)| Some((kind, count.parse().ok()?)));
                parsed.ok_or_else(|| format!("the vertex attribute `{}` is a {ty}", input.name))?
            }
        };
        let binding = if buffers == 1 { 0 } else { number };
        let stride: &mut u32 = &mut strides[binding as usize];
        let format = attribute_format(kind, components);
        attributes.push(VertexAttribute { location: input.location, binding, format, offset: *stride });
        *stride += 4 * components;
    }
    Ok((attributes, strides))
}

/// The format of an attribute of floats (`f`), signed (`i`) or unsigned integers (`u`).
fn attribute_format(kind: char, components: u32) -> vk::Format {
    use vk::Format as F;
    let formats = match kind {
        'i' => [F::R32_SINT, F::R32G32_SINT, F::R32G32B32_SINT, F::R32G32B32A32_SINT],
        'u' => [F::R32_UINT, F::R32G32_UINT, F::R32G32B32_UINT, F::R32G32B32A32_UINT],
        _ => [F::R32_SFLOAT, F::R32G32_SFLOAT, F::R32G32B32_SFLOAT, F::R32G32B32A32_SFLOAT],
    };
    formats[(components.clamp(1, 4) - 1) as usize]
}

/// A workgroup must fit the device.
pub(crate) fn check_workgroup(gpu: &Gpu, size: [u32; 3]) -> Result<(), String> {
    let limits = &gpu.limits;
    let invocations = size.iter().fold(1_u64, |all, axis| all.saturating_mul(u64::from(*axis)));
    let fits = size.iter().zip(limits.max_compute_work_group_size).all(|(axis, most)| *axis <= most)
        && invocations <= u64::from(limits.max_compute_work_group_invocations);
    if fits {
        return Ok(());
    }
    let (most, in_all) = (by(limits.max_compute_work_group_size), limits.max_compute_work_group_invocations);
    Err(format!("workgroups of {} invocations: this device allows {most}, and {in_all} in all", by(size)))
}
