//! The shipped shaders, pipelines and scenes, carried within the binary.

use framewright_graph::language::ShippedFiles;
use std::path::Path;

macro_rules! carried {
    ($folder:literal: $($file:literal),* $(,)?) => {
        &[$(($file, include_str!(concat!("../", $folder, "/", $file)))),*]
    };
}

/// Name, as a pipeline file or an `#include` says it, and GLSL text of each shipped shader.
pub const SHADERS: ShippedFiles = carried!(
    "shaders":
    "accumulate.frag",
    "adapt_exposure.comp",
    "ambient_occlusion.frag",
    "ambient_occlusion_blur.frag",
    "average_frames.frag",
    "bloom_grow.frag",
    "bloom_mix.frag",
    "bloom_shrink.frag",
    "blur.frag",
    "blur_tent.frag",
    "casters.frag",
    "casters_masked.frag",
    "color_grade.frag",
    "copy.frag",
    "corner.frag",
    "count_frames.comp",
    "deferred_lighting.frag",
    "depth_of_field.frag",
    "depth_resolve_average.frag",
    "depth_resolve_max.frag",
    "depth_resolve_min.frag",
    "depth_resolve_zero.frag",
    "depth_stripes.frag",
    "depth_stripes_copy.frag",
    "downsample.frag",
    "encode_hdr10.frag",
    "expose.frag",
    "film_grain.frag",
    "full_screen.vert",
    "fxaa.frag",
    "g_buffer.frag",
    "g_buffer_masked.frag",
    "gauss.frag",
    "include/alpha_coverage.glsl",
    "include/ambient_occlusion.glsl",
    "include/bloom.glsl",
    "include/cross_fade.glsl",
    "include/depth_of_field.glsl",
    "include/depth_samples.glsl",
    "include/depth_stripes.glsl",
    "include/distance.glsl",
    "include/film_grain.glsl",
    "include/g_buffer.glsl",
    "include/g_buffer_surface.glsl",
    "include/grading.glsl",
    "include/hdr10.glsl",
    "include/levels.glsl",
    "include/lighting.glsl",
    "include/luminance.glsl",
    "include/material.glsl",
    "include/motion.glsl",
    "include/overlay.glsl",
    "include/part.glsl",
    "include/part.hlsl",
    "include/point_lights.glsl",
    "include/radiance.glsl",
    "include/random.glsl",
    "include/rotation.glsl",
    "include/rotation.hlsl",
    "include/scale.glsl",
    "include/scan.glsl",
    "include/scene.glsl",
    "include/snow.glsl",
    "include/stereo.glsl",
    "include/stereo.hlsl",
    "include/sun_shadow.glsl",
    "include/surface.glsl",
    "include/temporal.glsl",
    "include/texture.glsl",
    "include/texture.hlsl",
    "include/tone_mapping.glsl",
    "include/weighted_resolve.glsl",
    "lit.frag",
    "lit_masked.frag",
    "luminance_histogram.comp",
    "motion.frag",
    "motion.vert",
    "motion_masked.frag",
    "motion_masked.vert",
    "motion_sky.frag",
    "objects.vert",
    "over_bright.frag",
    "overlay.frag",
    "reinhard.frag",
    "resolve_weighted.frag",
    "resolve_zero_sint.frag",
    "resolve_zero_uint.frag",
    "scale_area.frag",
    "scale_catmull_rom.frag",
    "sky.frag",
    "sky.vert",
    "snow.frag",
    "snow.vert",
    "snow_fall.comp",
    "snow_gather.comp",
    "soft_focus.frag",
    "taa.frag",
    "tone_map.frag",
    "tone_map_operator.frag",
    "vignette.frag",
);

/// The files in `examples/pipelines`: pipelines, and in folders what they are made of.
pub const PIPELINES: ShippedFiles = carried!(
    "pipelines":
    "auto_exposure.ron",
    "deferred.ron",
    "deferred_mobile.ron",
    "dynamic_resolution.ron",
    "forward.ron",
    "forward_overlay.ron",
    "image_quality.ron",
    "library/ambient_occlusion.ron",
    "library/bloom.ron",
    "library/blur.ron",
    "library/color_grading.ron",
    "library/depth_of_field.ron",
    "library/depth_stripes.ron",
    "library/film.ron",
    "library/fxaa.ron",
    "library/motion.ron",
    "library/over_bright.ron",
    "library/overlay.ron",
    "library/resolve.ron",
    "library/scale.ron",
    "library/sun_shadow.ron",
    "library/taa.ron",
    "library/tone_mapping.ron",
    "library/upscaler.ron",
    "post.ron",
    "shadows.ron",
    "snow.ron",
    "soft_focus.ron",
    "temporal.ron",
);

/// The scenes in `examples/scenes`.
pub const SCENES: ShippedFiles = carried!("scenes": "courtyard.ron", "passing.ron", "spheres_and_cubes.ron");

/// Names by which shipped files are asked for, without their ending. Files in folders have none.
pub fn names(files: ShippedFiles) -> impl Iterator<Item = &'static str> {
    files.iter().filter_map(|(file, _)| name(file))
}

/// File name and text of the shipped file that `path` asks for: by name or file name, in no folder.
#[must_use]
pub fn find(files: ShippedFiles, path: &Path) -> Option<(&'static str, &'static str)> {
    let called = |file: &str| name(file).is_some_and(|name| path == Path::new(name) || path == Path::new(file));
    files.iter().find(|(file, _)| called(file)).copied()
}

fn name(file: &str) -> Option<&str> {
    file.strip_suffix(".ron").filter(|name| !name.contains('/'))
}
