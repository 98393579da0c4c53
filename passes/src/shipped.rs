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
    "bloom_grow.frag",
    "bloom_mix.frag",
    "bloom_shrink.frag",
    "blur.frag",
    "copy.frag",
    "deferred_lighting.frag",
    "downsample.frag",
    "encode_hdr10.frag",
    "expose.frag",
    "full_screen.vert",
    "g_buffer.frag",
    "g_buffer_masked.frag",
    "gauss.frag",
    "include/bloom.glsl",
    "include/cross_fade.glsl",
    "include/g_buffer.glsl",
    "include/g_buffer_surface.glsl",
    "include/hdr10.glsl",
    "include/lighting.glsl",
    "include/luminance.glsl",
    "include/material.glsl",
    "include/overlay.glsl",
    "include/radiance.glsl",
    "include/random.glsl",
    "include/scan.glsl",
    "include/scene.glsl",
    "include/snow.glsl",
    "include/surface.glsl",
    "include/texture.glsl",
    "include/tone_mapping.glsl",
    "lit.frag",
    "lit_masked.frag",
    "luminance_histogram.comp",
    "objects.vert",
    "overlay.frag",
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
