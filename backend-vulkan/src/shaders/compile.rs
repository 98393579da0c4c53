//! GLSL to SPIR-V through shaderc.

use super::files::{Found, ShaderFiles};
use shaderc::{
    CompileOptions, Compiler, EnvVersion, GlslProfile, OptimizationLevel, ResolvedInclude, ShaderKind, SourceLanguage,
    SpirvVersion, TargetEnv,
};
use std::cell::{Cell, RefCell};
use std::collections::HashMap;

/// A file may include others this deep.
const MAX_INCLUDE_DEPTH: usize = 16;
/// A shader may include this many files, repetitions counted.
pub(super) const MAX_INCLUDES: usize = 256;

/// A shader stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Stage {
    /// Vertex shading.
    Vertex,
    /// Fragment shading.
    Fragment,
    /// Compute shading.
    Compute,
}

/// Compiles one stage: GLSL 4.60 to SPIR-V for Vulkan 1.3.
///
/// `text` is that of `source`, or made of it; `macros` are names with what they stand for; fragment stages have the macro
/// `FRAMEWRIGHT_FRAGMENT` besides. Not optimised: drivers do that themselves, and the optimiser would strip the names that binding by
/// name needs.
///
/// # Errors
/// The compiler's messages, each with the file and line that it is about.
pub(super) fn compile(
    compiler: &Compiler,
    stage: Stage,
    source: &Found,
    text: &str,
    files: &ShaderFiles,
    macros: &[(String, String)],
) -> Result<Vec<u32>, Vec<String>> {
    let included = Cell::new(0);
    // Files that were included, by the names that the compiler knows them by.
    let known = RefCell::new(HashMap::from([(source.shown.clone(), source.path.clone())]));
    let mut options = CompileOptions::new().map_err(|error| vec![error.to_string()])?;
    options.set_source_language(SourceLanguage::GLSL);
    options.set_forced_version_profile(460, GlslProfile::Core);
    options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_3 as u32);
    // From 1.6 on a workgroup's size is an `OpExecutionModeId`, which the reader of SPIR-V takes for a mistake.
    options.set_target_spirv(if stage == Stage::Compute { SpirvVersion::V1_5 } else { SpirvVersion::V1_6 });
    options.set_optimization_level(OptimizationLevel::Zero);
    options.set_suppress_warnings();
    if stage == Stage::Fragment {
        options.add_macro_definition("FRAMEWRIGHT_FRAGMENT", None);
    }
    for (name, value) in macros {
        options.add_macro_definition(name, Some(value));
    }
    options.set_include_callback(|requested, _, includer, depth| {
        included.set(included.get() + 1);
        if depth > MAX_INCLUDE_DEPTH || included.get() > MAX_INCLUDES {
            return Err(format!("more than {MAX_INCLUDE_DEPTH} includes deep or {MAX_INCLUDES} in all: a circle?"));
        }
        let from = known.borrow().get(includer).unwrap_or(&source.path).clone();
        match files.included(&from, requested)? {
            Some(Found { path, shown, text }) => {
                known.borrow_mut().insert(shown.clone(), path);
                Ok(ResolvedInclude { resolved_name: shown, content: text })
            }
            None => Err(format!("looked for it in {}", files.places(&from).join(", "))),
        }
    });
    let kind = match stage {
        Stage::Vertex => ShaderKind::Vertex,
        Stage::Fragment => ShaderKind::Fragment,
        Stage::Compute => ShaderKind::Compute,
    };
    match compiler.compile_into_spirv(text, kind, &source.shown, "main", Some(&options)) {
        Ok(artifact) => Ok(artifact.as_binary().to_vec()),
        Err(shaderc::Error::CompilationError(_, text)) => Err(lines(&text)),
        Err(error) => Err(vec![format!("{}: {error}", source.shown)]),
    }
}

/// The messages in the compiler's text.
fn lines(text: &str) -> Vec<String> {
    text.lines().map(str::trim_end).filter(|line| !line.is_empty()).map(str::to_owned).collect()
}
