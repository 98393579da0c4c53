//! Whether a shader fits what its pass, its draw source and the device give it.

use crate::gpu::{Gpu, VertexAttribute, VertexBinding};
use ash::vk;
use framewright_graph::device::Abilities;
use framewright_graph::plan::{self, Plan};
use framewright_graph::shader::{
    DrawInterface, DrawInterfaces, LocationLayout, PASS_SET, ProgramResource, ProgramSet, ShaderInterface,
    SuppliedResource, VertexLayout, VertexRate, needs_in_pass,
};
use framewright_graph::vulkan::Component;

/// Checks a shader against the device's features and limits, with the vertices that it reads and the resources that the draw source brings
/// along, whether the shader reads those or not, the program's sets of which it reads anything, and the number of its pass's targets.
pub(crate) fn check_needs(
    gpu: &Gpu,
    shader: &ShaderInterface,
    brought: &DrawInterface,
    sets: &[ProgramSet],
    targets: usize,
) -> Result<(), String> {
    let limits = gpu.shader_limits();
    let abilities = Abilities {
        device: "this device",
        limits: Some(&limits),
        has: &|name| gpu.features.has(name),
        reads_vertices: &|format| gpu.reads_vertices(format),
    };
    let needs = needs_in_pass(shader, Some(brought), sets, targets);
    needs.iter().find_map(|need| need.unmet(&abilities)).map_or(Ok(()), Err)
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

/// Push constants: what the shader reads must be what the draw brings along, and no part of an image is told beside it.
pub(crate) fn check_pushed(shader: &ShaderInterface, brought: &DrawInterface, parts: bool) -> Result<(), String> {
    let misfit = shader.pushed.iter().find_map(|block| brought.pushed_misfit(block));
    let beside = shader.pushed.first().filter(|_| parts).map(|block| {
        format!("push constants `{}` beside parts of images, which are told by push constants too", block.name)
    });
    misfit.or(beside).map_or(Ok(()), |misfit| Err(format!("the shader reads {misfit}")))
}

/// Sets of the program's: what the shader reads of them must be what they are.
pub(crate) fn check_program(shader: &ShaderInterface, draws: &DrawInterfaces) -> Result<(), String> {
    if shader.program.is_empty() {
        return Ok(());
    }
    if let Some(fault) = draws.set_faults().into_iter().next() {
        return Err(fault.message);
    }
    let misfit = |used: &ProgramResource| {
        let set = draws.sets().iter().find(|set| set.set == used.set)?;
        Some(format!("the shader uses {}: {}", used.words(), set.misfit(used)?))
    };
    shader.program.iter().find_map(misfit).map_or(Ok(()), Err)
}

/// A name as it is declared: of an array with its length.
fn array_words(name: &str, length: Option<u32>) -> String {
    length.map_or_else(|| name.to_owned(), |length| format!("{name}[{length}]"))
}

/// What a draw source brings along.
fn in_words(supplied: &SuppliedResource) -> String {
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

/// The vertex attributes by the shader's locations, from the buffers of a draw source, and those of the buffers that are read.
pub(crate) fn brought_attributes(
    shader: &ShaderInterface,
    brought: &DrawInterface,
) -> Result<(Vec<VertexAttribute>, Vec<VertexBinding>), String> {
    let mut attributes = Vec::new();
    for input in &shader.vertex_inputs {
        let (name, ty) = (&input.name, &input.ty);
        let locations = brought.locations(input).map_err(|misfit| match misfit.help(input) {
            None => format!("vertices of this kind of draw have no `{name}`"),
            Some(help) => format!("the shader declares the vertex attribute `{name}` as {ty}: {help}"),
        })?;
        attributes.extend(locations.map(|it| {
            let format = vk::Format::from_raw(it.format.vulkan());
            VertexAttribute { location: it.location, binding: it.buffer, format, offset: it.offset }
        }));
    }
    let is_read = |binding: &u32| attributes.iter().any(|it| it.binding == *binding);
    let buffers = (0..).zip(&brought.vertex_buffers).filter(|(binding, _)| is_read(binding));
    let buffers = buffers.map(|(binding, buffer)| VertexBinding { binding, stride: buffer.stride, rate: buffer.rate });
    let buffers = buffers.collect();
    Ok((attributes, buffers))
}

/// The vertex attributes from the pass's own vertex buffers, and those buffers.
pub(crate) fn own_attributes(
    shader: &ShaderInterface,
    buffers: usize,
) -> Result<(Vec<VertexAttribute>, Vec<VertexBinding>), String> {
    let VertexLayout { locations, strides } =
        VertexLayout::of(&shader.vertex_inputs, buffers).map_err(|fault| fault.message)?;
    let attribute = |it: &LocationLayout| VertexAttribute {
        location: it.location,
        binding: it.buffer as u32,
        format: attribute_format(it.kind, it.components),
        offset: it.offset,
    };
    let buffer = |(binding, stride)| VertexBinding { binding, stride, rate: VertexRate::Vertex };
    Ok((locations.iter().map(attribute).collect(), (0..).zip(strides).map(buffer).collect()))
}

/// The format of an attribute of 32-bit components.
fn attribute_format(kind: Component, components: u32) -> vk::Format {
    use vk::Format as F;
    let formats = match kind {
        Component::Int => [F::R32_SINT, F::R32G32_SINT, F::R32G32B32_SINT, F::R32G32B32A32_SINT],
        Component::Uint => [F::R32_UINT, F::R32G32_UINT, F::R32G32B32_UINT, F::R32G32B32A32_UINT],
        Component::Float => [F::R32_SFLOAT, F::R32G32_SFLOAT, F::R32G32B32_SFLOAT, F::R32G32B32A32_SFLOAT],
    };
    formats[(components.clamp(1, 4) - 1) as usize]
}
