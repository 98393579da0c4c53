//! Whether the device has and allows what a shader and its resources need.

use crate::gpu::Gpu;
use framewright_graph::device::Abilities;
use framewright_graph::shader::{ShaderInterface, Supplied, resource_needs};

/// Checks a shader against the device's features and limits, with the resources that the draw source brings along, whether the shader
/// reads them or not, and the number of its pass's targets.
pub(crate) fn check_needs<'s>(
    gpu: &Gpu,
    shader: &ShaderInterface,
    brought: impl Iterator<Item = &'s Supplied> + Clone,
    targets: usize,
) -> Result<(), String> {
    let limits = gpu.shader_limits();
    let abilities = Abilities { device: "this device", limits: Some(&limits), has: &|name| gpu.features.has(name) };
    let of_resources = resource_needs(shader, brought, targets);
    let unmet = shader.needs.iter().chain(&of_resources).find_map(|need| need.unmet(&abilities));
    unmet.map_or(Ok(()), Err)
}
