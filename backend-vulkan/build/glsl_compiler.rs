//! What the feature `shader-compiler` links. Debian's `libshaderc_combined.a` holds shaderc alone: where the distribution's glslang
//! and SPIRV-Tools archives lie beside it they are linked too. Elsewhere the `shaderc` crate finds or builds its own.

use std::path::Path;

const FOLDER: &str = "/usr/lib/x86_64-linux-gnu";

/// In the order in which each needs those behind it.
const ARCHIVES: [&str; 9] = [
    "glslang",
    "MachineIndependent",
    "GenericCodeGen",
    "OSDependent",
    "OGLCompiler",
    "HLSL",
    "SPIRV",
    "SPIRV-Tools-opt",
    "SPIRV-Tools",
];

pub(crate) fn link() {
    let present = |archive: &str| Path::new(FOLDER).join(format!("lib{archive}.a")).exists();
    if present("shaderc_combined") && ARCHIVES.into_iter().all(present) {
        println!("cargo:rustc-link-search=native={FOLDER}");
        for archive in ARCHIVES {
            println!("cargo:rustc-link-lib=static={archive}");
        }
        println!("cargo:rustc-link-lib=stdc++");
    }
}
