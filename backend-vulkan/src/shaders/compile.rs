//! GLSL to SPIR-V.

use crate::process::{CompileFailure, CompileJob, IncludedFile};

/// A shader may include this many files, repetitions counted.
pub(super) const MAX_INCLUDES: usize = 256;

/// Finds the file that the file of one name includes by another name.
pub(crate) type Includes<'a> = dyn FnMut(&str, &str) -> Result<IncludedFile, String> + 'a;

/// Compiles one stage: GLSL 4.60 to SPIR-V for Vulkan 1.3. Fragment stages have the macro `FRAMEWRIGHT_FRAGMENT` besides.
///
/// # Errors
/// The compiler's messages, or that it failed itself; [`CompileFailure::NoCompiler`] without the feature `shader-compiler`.
pub(crate) fn compile(job: &CompileJob, includes: &mut Includes<'_>) -> Result<Vec<u32>, CompileFailure> {
    #[cfg(feature = "shader-compiler")]
    return super::by_shaderc::compile(job, includes);
    #[cfg(not(feature = "shader-compiler"))]
    {
        let _ = (job, includes);
        Err(CompileFailure::NoCompiler)
    }
}
