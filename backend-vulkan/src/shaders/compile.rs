//! GLSL to SPIR-V through shaderc.

use serde::{Deserialize, Serialize};
use shaderc::{
    CompileOptions, Compiler, EnvVersion, GlslProfile, OptimizationLevel, ResolvedInclude, ShaderKind, SourceLanguage,
    SpirvVersion, TargetEnv,
};
use std::cell::{Cell, RefCell};

/// A file may include others this deep.
const MAX_INCLUDE_DEPTH: usize = 16;
/// A shader may include this many files, repetitions counted.
pub(super) const MAX_INCLUDES: usize = 256;
/// Most bytes of SPIR-V of one stage: usual ones have some ten thousand. What it uses is read from it in the program's own process.
pub(crate) const LARGEST_SPIRV: usize = 16 << 20;

/// A shader stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(crate) enum Stage {
    /// Vertex shading.
    Vertex,
    /// Fragment shading.
    Fragment,
    /// Compute shading.
    Compute,
}

/// One stage to compile.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Job {
    /// Which stage.
    pub(crate) stage: Stage,
    /// The name of its file that messages show.
    pub(crate) shown: String,
    /// The text of that file, or one made of it.
    pub(crate) text: String,
    /// Macros with what they stand for.
    pub(crate) macros: Vec<(String, String)>,
}

/// A file that a shader includes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct IncludedFile {
    /// The name that messages show.
    pub(crate) shown: String,
    /// GLSL.
    pub(crate) text: String,
}

/// Why a stage doesn't compile.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) enum Failure {
    /// The compiler's messages, each with the file and line that it is about.
    Messages(Vec<String>),
    /// The compiler ran out of memory.
    OutOfMemory,
    /// The compiler failed itself, in its own words.
    Internal(String),
    /// The bytes of its SPIR-V, which are more than [`LARGEST_SPIRV`].
    TooLarge(usize),
}

/// Finds the file that the file of one name includes by another name.
pub(crate) type Includes<'a> = dyn FnMut(&str, &str) -> Result<IncludedFile, String> + 'a;

/// Compiles one stage: GLSL 4.60 to SPIR-V for Vulkan 1.3.
///
/// Fragment stages have the macro `FRAMEWRIGHT_FRAGMENT` besides. Not optimised: drivers do that themselves, and the optimiser
/// would strip the names that binding by name needs.
///
/// # Errors
/// What the compiler says.
pub(crate) fn compile(
    compiler: &Compiler,
    Job { stage, shown, text, macros }: &Job,
    includes: &mut Includes<'_>,
) -> Result<Vec<u32>, Failure> {
    let (stage, includes) = (*stage, RefCell::new(includes));
    let included = Cell::new(0);
    let mut options = CompileOptions::new().map_err(|error| Failure::Internal(error.to_string()))?;
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
        let IncludedFile { shown, text } = (*includes.borrow_mut())(includer, requested)?;
        Ok(ResolvedInclude { resolved_name: shown, content: text })
    });
    let kind = match stage {
        Stage::Vertex => ShaderKind::Vertex,
        Stage::Fragment => ShaderKind::Fragment,
        Stage::Compute => ShaderKind::Compute,
    };
    match compiler.compile_into_spirv(text, kind, shown, "main", Some(&options)) {
        Ok(artifact) => bounded(artifact.as_binary(), LARGEST_SPIRV).map(<[u32]>::to_vec),
        Err(shaderc::Error::CompilationError(_, text)) => Err(Failure::Messages(lines(&text))),
        Err(error) => Err(failed(&error)),
    }
}

/// SPIR-V, unless it has more bytes than `most`.
fn bounded(words: &[u32], most: usize) -> Result<&[u32], Failure> {
    match size_of_val(words) {
        bytes if bytes > most => Err(Failure::TooLarge(bytes)),
        _ => Ok(words),
    }
}

/// A failure of the compiler itself. It has no words for an exception, and it throws none but for lack of memory.
fn failed(error: &shaderc::Error) -> Failure {
    match error {
        shaderc::Error::InternalError(words) if words.is_empty() => Failure::OutOfMemory,
        other => Failure::Internal(other.to_string()),
    }
}

/// The messages in the compiler's text.
fn lines(text: &str) -> Vec<String> {
    text.lines().map(str::trim_end).filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spirv_is_taken_up_to_a_bound_and_no_further() {
        assert!(matches!(bounded(&[1, 2], 8), Ok([1, 2])));
        assert!(matches!(bounded(&[1, 2], 7), Err(Failure::TooLarge(8))));
    }

    #[test]
    fn only_an_exception_of_the_compiler_is_lack_of_memory() {
        let failed = |error| failed(&error);
        assert!(matches!(failed(shaderc::Error::InternalError(String::new())), Failure::OutOfMemory));
        let words = |error| match failed(error) {
            Failure::Internal(words) => words,
            other => panic!("{other:?}"),
        };
        assert!(words(shaderc::Error::InternalError("its own words".to_owned())).contains("its own words"));
        assert!(words(shaderc::Error::InvalidStage("no stage".to_owned())).contains("no stage"));
    }
}
