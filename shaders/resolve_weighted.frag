#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"
#include "include/weighted_resolve.glsl"

// Radiance.
layout(set = 0, binding = 0) uniform TEXTURE_source source;
layout(set = 0, binding = 1) uniform Params {
    // Whether the mean is taken back to radiance; else it is left tone-mapped, 0 to 1.
    bool invert;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// A resolve that bright samples don't drown. For `Samples("color")`: each sample is tone-mapped before they are averaged.
// The inverse of the mean, mean / (1 − largest channel of the mean), is the weighted mean wherever one channel is the
// largest in all samples; dividing by the weights gives the same and avoids cancellation.
void main() {
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int number = 0; number < samples_of(source); ++number) {
        const vec4 found = guard_color(found_in(source, source_st, uv, 0, number));
        const float weight = resolve_weight(found.rgb);
        sum += vec4(found.rgb * weight, found.a);
        weights += weight;
    }
    const float count = float(samples_of(source));
    color = guard_color(vec4(sum.rgb / (params.invert ? weights : count), sum.a / count));
}
