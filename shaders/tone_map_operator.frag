#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"
#include "include/tone_mapping.glsl"

// Radiance.
layout(set = 0, binding = 0) uniform TEXTURE_source source;
layout(set = 0, binding = 1) uniform Params {
    // What radiance is multiplied by first.
    float exposure;
    // Which curve, by its number in include/tone_mapping.glsl.
    int operator;
    // For WHITE_POINT: the radiance after exposure that becomes white, at least 1.
    float white_point;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Tone mapping by one of several curves. Given `Samples("color")` it is the resolve too: each sample is tone-mapped, and
// what would be shown of them is averaged, so that no single bright sample drowns the others.
void main() {
    vec3 sum = vec3(0.0);
    for (int number = 0; number < samples_of(source); ++number) {
        const vec3 radiance = guard_radiance(guard_radiance(found_in(source, source_st, uv, 0, number).rgb) * params.exposure);
        sum += tone_mapped(radiance, params.operator, params.white_point);
    }
    color = vec4(guard_radiance(sum / float(samples_of(source))), 1.0);
}
