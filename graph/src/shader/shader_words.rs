//! What languages of shaders call what mistakes speak of. `None` is GLSL everywhere.

use super::{FileLanguage, UnturnedPart};

/// The shipped function that finds that position in the upright picture, and its file; `None`: the language has none.
#[must_use]
pub(crate) const fn upright_position(language: Option<FileLanguage>) -> Option<[&'static str; 2]> {
    match language {
        None => Some(["frag_coord()", "include/rotation.glsl"]),
        Some(FileLanguage::Hlsl | FileLanguage::Slang) => Some(["frag_coord(position)", "include/rotation.hlsl"]),
        Some(FileLanguage::Spirv | FileLanguage::Wgsl) => None,
    }
}

/// How a shader in a language finds its eye's half, where it has no shipped files to include.
#[must_use]
pub(crate) fn without_halves(language: &str) -> String {
    format!("{language} isn't told of halves: draw in a mode with layers, or by `multi-pass`")
}

/// What the shader of this text does that goes wrong where its picture is turned.
#[must_use]
pub(crate) fn unturned(shader: &str, part: UnturnedPart) -> String {
    match part {
        UnturnedPart::Vertices => match FileLanguage::of_vertices(shader) {
            None | Some(FileLanguage::Hlsl | FileLanguage::Slang) => {
                "places vertices without `rotate_clip()`".to_owned()
            }
            Some(FileLanguage::Spirv | FileLanguage::Wgsl) => "places vertices".to_owned(),
        },
        UnturnedPart::FragCoord => {
            let language = FileLanguage::of_shader(shader);
            let reads = format!("reads `{}`", FileLanguage::place(language));
            match upright_position(language) {
                Some([function, _]) => format!("{reads} without `{function}`"),
                None => reads,
            }
        }
        UnturnedPart::Derivatives => match FileLanguage::of_shader(shader) {
            None => "takes `dFdx` or `dFdy` without `ddx()` or `ddy()`".to_owned(),
            Some(FileLanguage::Hlsl | FileLanguage::Slang) => "takes `ddx` or `ddy`".to_owned(),
            Some(FileLanguage::Spirv | FileLanguage::Wgsl) => "takes derivatives".to_owned(),
        },
    }
}

/// What the shader of this text could use to draw a turned picture.
#[must_use]
pub(crate) fn for_turned_pictures(shader: &str) -> &'static str {
    match FileLanguage::of_shader(shader) {
        None => "use `frag_coord()`, `ddx()`, `ddy()` and `rotate_clip()` of `include/rotation.glsl`",
        Some(FileLanguage::Hlsl | FileLanguage::Slang) => {
            "use `frag_coord(position)` and `rotate_clip()` of `include/rotation.hlsl`; for derivatives choose `ddx` or `ddy` \
             and the sign by its `framewright_rotation`, 0 to 3 quarters clockwise"
        }
        Some(FileLanguage::Spirv) => {
            "let the source of the SPIR-V use `include/rotation.glsl` or `include/rotation.hlsl`"
        }
        Some(FileLanguage::Wgsl) => "WGSL isn't told of rotation: write the shader in GLSL or HLSL",
    }
}
