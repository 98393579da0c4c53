//! The shipped shaders, carried within the binary.

macro_rules! shaders {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../shaders/", $name)))),*]
    };
}

/// Name, as a pipeline file or an `#include` says it, and GLSL text of each shipped shader.
pub const SHADERS: &[(&str, &str)] = shaders![
    "blur.frag",
    "copy.frag",
    "downsample.frag",
    "full_screen.vert",
    "include/lighting.glsl",
    "include/material.glsl",
    "include/radiance.glsl",
    "include/scene.glsl",
    "include/surface.glsl",
    "include/tone_mapping.glsl",
    "lit.frag",
    "lit_masked.frag",
    "objects.vert",
    "reinhard.frag",
    "sky.frag",
    "sky.vert",
    "soft_focus.frag",
    "tone_map.frag",
];
