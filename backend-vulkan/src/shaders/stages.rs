//! Compiled stages, and how a vertex and a fragment stage go together.

use super::reflect::StageInterface;
use super::text::RefusedStage;
use framewright_graph::shader::{FileLanguage, PASS_SET, ProgramResource, ShaderInterface};
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

/// What mends that a fragment stage reads what the vertex stage doesn't hand over.
const fn hand_over(language: Option<FileLanguage>) -> Option<&'static str> {
    match language {
        None => None,
        Some(FileLanguage::Hlsl | FileLanguage::Slang) => Some(
            "leave it out, or name a vertex stage that hands it over; semantics of HLSL count for nothing, inputs have locations \
             in their order",
        ),
        Some(FileLanguage::Spirv | FileLanguage::Wgsl) => {
            Some("leave it out, or name a vertex stage that hands it over")
        }
    }
}

/// A type that SPIR-V has, as HLSL writes it: `float4`. Matrices keep the name that GLSL has for them.
fn in_hlsl(ty: &str) -> String {
    let vectors = [("vec", "float"), ("ivec", "int"), ("uvec", "uint"), ("bvec", "bool"), ("dvec", "double")];
    let vector = vectors.iter().find_map(|(glsl, hlsl)| Some(format!("{hlsl}{}", ty.strip_prefix(glsl)?)));
    vector.unwrap_or_else(|| ty.to_owned())
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
            let language = FileLanguage::of_file(&fragment.file);
            let shown = |ty: &str| match language {
                Some(FileLanguage::Hlsl | FileLanguage::Slang) => in_hlsl(ty),
                Some(FileLanguage::Spirv | FileLanguage::Wgsl) | None => ty.to_owned(),
            };
            let found =
                handed.map_or("nothing".to_owned(), |output| format!("`{} {}`", shown(&output.ty), output.name));
            let component = match input.component {
                0 => String::new(),
                component => format!(", component {component}"),
            };
            let what = format!(
                "it reads `{} {}` at location {}{component}, where {} hands over {found}",
                shown(&input.ty),
                input.name,
                input.location,
                vertex.file
            );
            // The text has the last word of `i.color` alone.
            let word = input.name.rsplit('.').next().unwrap_or(&input.name);
            return Err(RefusedStage::named(word, what).mended(hand_over));
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
