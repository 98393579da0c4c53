//! Compiled stages, and how a vertex and a fragment stage go together.

use super::reflect::StageInterface;
use super::text::RefusedStage;
use framewright_graph::shader::{PASS_SET, ProgramResource, ShaderInterface};
use std::sync::Arc;

/// SPIR-V of one stage, with the entry point `main`.
pub type Spirv = Arc<[u32]>;

/// One stage of a shader.
pub(super) struct CompiledStage {
    pub(super) file: String,
    /// Whether it is one of those that are shipped.
    pub(super) shipped: bool,
    pub(super) spirv: Spirv,
    pub(super) reflected: StageInterface,
}

/// Whether a fragment stage leaves depth as it would be without one.
pub(super) fn changes_nothing(fragment: &ShaderInterface) -> bool {
    let decides = fragment.discards || fragment.masks_samples || fragment.writes_depth;
    let writes = fragment.bindings.iter().any(|binding| binding.kind.is_written());
    !decides && !writes && !fragment.program.iter().any(|it| it.writable)
}

/// The interface of both stages together.
///
/// # Errors
/// What of the fragment stage doesn't fit.
pub(super) fn join(vertex: &CompiledStage, fragment: &CompiledStage) -> Result<ShaderInterface, RefusedStage> {
    // An input that isn't used is left out of the stage.
    for input in fragment.reflected.inputs.iter().filter(|input| input.used) {
        let mut handed = vertex.reflected.outputs.iter().filter(|output| output.used);
        let handed = handed.find(|output| (output.location, output.component) == (input.location, input.component));
        if handed.is_none_or(|output| output.ty != input.ty) {
            let found = handed.map_or("nothing".to_owned(), |output| format!("`{} {}`", output.ty, output.name));
            let component = match input.component {
                0 => String::new(),
                component => format!(", component {component}"),
            };
            let what = format!(
                "it reads `{} {}` at location {}{component}, where {} hands over {found}",
                input.ty, input.name, input.location, vertex.file
            );
            return Err(RefusedStage::named(&input.name, what));
        }
    }
    let mut joined = fragment.reflected.interface.clone();
    joined.vertex_inputs.clone_from(&vertex.reflected.interface.vertex_inputs);
    joined.sees_alike.clone_from(&vertex.reflected.interface.sees_alike);
    joined.point_size = vertex.reflected.interface.point_size;
    for binding in &vertex.reflected.interface.bindings {
        match joined.bindings.iter_mut().find(|it| (it.set, it.binding) == (binding.set, binding.binding)) {
            None => joined.bindings.push(binding.clone()),
            Some(same) if (&same.name, &same.kind, same.length) == (&binding.name, &binding.kind, binding.length) => {
                same.stages |= binding.stages;
                same.adapts &= binding.adapts;
            }
            Some(same)
                if same.name == binding.name
                    && same.separate
                    && binding.separate
                    && same.kind.sampled() == binding.kind.sampled() =>
            {
                same.stages |= binding.stages;
                same.kind.compare_as(&binding.kind);
            }
            Some(same) if same.name == binding.name && same.kind.is_sampler() && binding.kind.is_sampler() => {
                same.stages |= binding.stages;
                same.kind.join_sampler(&binding.kind);
            }
            Some(other) => {
                let what = format!(
                    "it declares `{}` at set {}, binding {}, where {} declares `{}`, or the same in another form",
                    other.name, binding.set, binding.binding, vertex.file, binding.name
                );
                return Err(RefusedStage::named(&other.name, what));
            }
        }
    }
    for resource in &vertex.reflected.interface.program {
        let same = |it: &&mut ProgramResource| {
            (it.set, it.binding, &it.name, it.kind, it.count)
                == (resource.set, resource.binding, &resource.name, resource.kind, resource.count)
        };
        match joined.program.iter_mut().find(same) {
            Some(same) => {
                same.stages |= resource.stages;
                same.writable |= resource.writable;
            }
            None => joined.program.push(resource.clone()),
        }
    }
    joined.pushed.extend(vertex.reflected.interface.pushed.iter().cloned());
    joined.pushed_misfits.extend(vertex.reflected.interface.pushed_misfits.iter().cloned());
    joined.unturned.extend(
        vertex.reflected.interface.unturned.iter().filter(|it| !fragment.reflected.interface.unturned.contains(it)),
    );
    joined.unturned.sort_unstable();
    for need in &vertex.reflected.interface.needs {
        if !joined.needs.contains(need) {
            joined.needs.push(need.clone());
        }
    }
    let of_vertices = vertex.reflected.interface.constants.iter();
    let others: Vec<_> = of_vertices.filter(|constant| !joined.constants.contains(constant)).cloned().collect();
    joined.constants.extend(others);
    joined.bindings.sort_by_key(|it| (it.set, it.binding));
    // Each stage that samples an image must ask.
    let [mut others, seen] = [&vertex, &fragment].map(|stage| stage.reflected.interface.clone());
    let silent = |stage: &ShaderInterface, name: &String| {
        stage.bindings.iter().any(|it| it.set == PASS_SET && it.name == *name) && !stage.asks_part.contains(name)
    };
    joined.asks_part.retain(|name| !silent(&others, name));
    others.asks_part.retain(|name| !silent(&seen, name) && !joined.asks_part.contains(name));
    joined.asks_part.append(&mut others.asks_part);
    Ok(joined)
}
