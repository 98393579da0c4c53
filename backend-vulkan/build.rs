//! What is linked beside Rust's own code: the archives that the feature `shader-compiler` needs, and the validator of the feature
//! `spirv-validator`, which is compiled here.

use std::env::var_os;

mod build {
    #[cfg(feature = "shader-compiler")]
    pub(crate) mod glsl_compiler;
    #[cfg(feature = "spirv-validator")]
    pub(crate) mod validator;
}

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=build");
    println!("cargo:rustc-check-cfg=cfg(spirv_validator)");
    // Both are of this machine's system: cross builds have neither Debian's archives nor the validator.
    if var_os("HOST") != var_os("TARGET") {
        return;
    }
    #[cfg(feature = "shader-compiler")]
    build::glsl_compiler::link();
    #[cfg(feature = "spirv-validator")]
    build::validator::build();
}
