//! The shipped shaders, carried within the binary.

macro_rules! shaders {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../shaders/", $name)))),*]
    };
}

/// Name, as a pipeline file or an `#include` says it, and GLSL text of each shipped shader.
pub const SHADERS: &[(&str, &str)] = shaders![
    "accumulate.frag",
    "adapt_exposure.comp",
    "blur.frag",
    "copy.frag",
    "downsample.frag",
    "expose.frag",
    "full_screen.vert",
    "include/cross_fade.glsl",
    "include/lighting.glsl",
    "include/luminance.glsl",
    "include/material.glsl",
    "include/radiance.glsl",
    "include/random.glsl",
    "include/scan.glsl",
    "include/scene.glsl",
    "include/snow.glsl",
    "include/surface.glsl",
    "include/tone_mapping.glsl",
    "lit.frag",
    "lit_masked.frag",
    "luminance_histogram.comp",
    "objects.vert",
    "reinhard.frag",
    "sky.frag",
    "sky.vert",
    "snow.frag",
    "snow.vert",
    "snow_fall.comp",
    "snow_gather.comp",
    "soft_focus.frag",
    "tone_map.frag",
];
