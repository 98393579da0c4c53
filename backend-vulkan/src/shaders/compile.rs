//! GLSL to SPIR-V, and the validator's verdict on it.

use crate::process::{CompileFailure, CompileJob, CompilerAnswer, IncludedFile};

/// A shader may include this many files, repetitions counted.
pub(super) const MAX_INCLUDES: usize = 256;

/// Finds the file that the file of one name includes by another name.
pub(crate) type Includes<'a> = dyn FnMut(&str, &str) -> Result<IncludedFile, String> + 'a;

/// Compiles one stage: GLSL 4.60 to SPIR-V for Vulkan 1.3. Fragment stages have the macro `FRAMEWRIGHT_FRAGMENT` besides.
///
/// # Errors
/// The compiler's messages, or that it failed itself; [`CompileFailure::NoCompiler`] without the feature `shader-compiler`.
pub(crate) fn compile(job: &CompileJob, includes: &mut Includes<'_>) -> Result<CompilerAnswer, CompileFailure> {
    #[cfg(feature = "shader-compiler")]
    {
        use super::by_shaderc;
        use super::validator::judge;
        use crate::process::Verdict;
        let spirv = by_shaderc::compile(job, includes, false)?;
        let verdict = match judge(&spirv) {
            // SPIR-V has lines only if they are asked for. They cost time, and what is valid needs none.
            Verdict::Invalid(finding) => match by_shaderc::compile(job, includes, true).map(|spirv| judge(&spirv)) {
                Ok(Verdict::Invalid(with_lines)) if with_lines.place.is_some() => Verdict::Invalid(with_lines),
                _ => Verdict::Invalid(finding),
            },
            other => other,
        };
        Ok(CompilerAnswer { spirv, verdict })
    }
    #[cfg(not(feature = "shader-compiler"))]
    {
        let _ = (job, includes);
        Err(CompileFailure::NoCompiler)
    }
}
