//! GLSL and HLSL to SPIR-V through shaderc.

use super::compile::{Includes, MAX_INCLUDES};
use crate::base::ShaderStage;
use crate::process::{CompileFailure, CompileJob, LARGEST_SPIRV};
use framewright_graph::shader::FileLanguage;
use shaderc::{
    CompileOptions, Compiler, EnvVersion, GlslProfile, OptimizationLevel, ResolvedInclude, ShaderKind, SourceLanguage,
    SpirvVersion, TargetEnv,
};
use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::sync::OnceLock;

/// A file may include others this deep.
const MAX_INCLUDE_DEPTH: usize = 16;

/// The compiler of this process. Its tables of GLSL's own functions take a quarter of a second to make, and are dropped with the
/// last compiler.
static COMPILER: OnceLock<Compiler> = OnceLock::new();

/// Not optimised: drivers do that themselves, and the optimiser would strip the names that binding by name needs. `lines`: the SPIR-V
/// tells the lines of its instructions.
///
/// # Errors
/// The compiler's messages, or that it failed itself.
pub(super) fn compile(
    CompileJob { stage, language, entry, shown, text, macros }: &CompileJob,
    includes: &mut Includes<'_>,
    lines: bool,
) -> Result<Vec<u32>, CompileFailure> {
    let compiler = compiler().map_err(|error| CompileFailure::Internal(format!("it doesn't start: {error}")))?;
    let (stage, includes) = (*stage, RefCell::new(includes));
    let included = Cell::new(0);
    let once = RefCell::new(BTreeSet::new());
    let mut options = CompileOptions::new().map_err(|error| CompileFailure::Internal(error.to_string()))?;
    match language {
        None => {
            options.set_source_language(SourceLanguage::GLSL);
            options.set_forced_version_profile(460, GlslProfile::Core);
        }
        Some(FileLanguage::Hlsl) => {
            options.set_source_language(SourceLanguage::HLSL);
            // What has no register gets a binding of its own.
            options.set_auto_bind_uniforms(true);
        }
        Some(_) => return Err(CompileFailure::NoCompiler),
    }
    options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_3 as u32);
    options.set_target_spirv(match language {
        // Its front end marks storage blocks as versions up to 1.3 do.
        Some(_) => SpirvVersion::V1_3,
        // From 1.6 on a workgroup's size is an `OpExecutionModeId`, which the reader of SPIR-V takes for a mistake.
        None if stage.facts().has_workgroups => SpirvVersion::V1_5,
        None => SpirvVersion::V1_6,
    });
    options.set_optimization_level(OptimizationLevel::Zero);
    options.set_suppress_warnings();
    if lines {
        options.set_generate_debug_info();
    }
    if stage.facts().writes_attachments {
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
        let file = (*includes.borrow_mut())(includer, requested)?;
        let again = file.once.is_some_and(|file| !once.borrow_mut().insert(file));
        Ok(ResolvedInclude { resolved_name: file.shown, content: if again { String::new() } else { file.text } })
    });
    let kind = match stage {
        ShaderStage::Vertex => ShaderKind::Vertex,
        ShaderStage::Fragment => ShaderKind::Fragment,
        ShaderStage::Compute => ShaderKind::Compute,
    };
    match compiler.compile_into_spirv(text, kind, shown, entry.as_deref().unwrap_or("main"), Some(&options)) {
        Ok(artifact) => bounded(artifact.as_binary(), LARGEST_SPIRV).map(<[u32]>::to_vec),
        Err(shaderc::Error::CompilationError(_, text)) => Err(CompileFailure::Messages(messages(&text))),
        Err(error) => Err(failed(&error)),
    }
}

/// The compiler of this process. If it doesn't start, the next stage tries again.
fn compiler() -> shaderc::Result<&'static Compiler> {
    match COMPILER.get() {
        Some(compiler) => Ok(compiler),
        None => Compiler::new().map(|compiler| COMPILER.get_or_init(|| compiler)),
    }
}

/// SPIR-V, unless it has more bytes than `most`.
fn bounded(words: &[u32], most: usize) -> Result<&[u32], CompileFailure> {
    match size_of_val(words) {
        bytes if bytes > most => Err(CompileFailure::TooLarge(bytes)),
        _ => Ok(words),
    }
}

/// A failure of the compiler itself. It has no words for an exception, and it throws none but for lack of memory.
fn failed(error: &shaderc::Error) -> CompileFailure {
    match error {
        shaderc::Error::InternalError(words) if words.is_empty() => CompileFailure::OutOfMemory,
        other => CompileFailure::Internal(other.to_string()),
    }
}

/// The messages in the compiler's text.
fn messages(text: &str) -> Vec<String> {
    text.lines().map(str::trim_end).filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spirv_is_taken_up_to_a_bound_and_no_further() {
        assert!(matches!(bounded(&[1, 2], 8), Ok([1, 2])));
        assert!(matches!(bounded(&[1, 2], 7), Err(CompileFailure::TooLarge(8))));
    }

    #[test]
    fn only_an_exception_of_the_compiler_is_lack_of_memory() {
        let failed = |error| failed(&error);
        assert!(matches!(failed(shaderc::Error::InternalError(String::new())), CompileFailure::OutOfMemory));
        let words = |error| match failed(error) {
            CompileFailure::Internal(words) => words,
            other => panic!("{other:?}"),
        };
        assert!(words(shaderc::Error::InternalError("its own words".to_owned())).contains("its own words"));
        assert!(words(shaderc::Error::InvalidStage("no stage".to_owned())).contains("no stage"));
    }
}
