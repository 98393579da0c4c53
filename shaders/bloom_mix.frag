#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/bloom.glsl"
#include "include/texture.glsl"

// What is in focus.
layout(set = 0, binding = 0) uniform sampler2D sharp;
// The largest level of the chain, grown; needs a linear filter.
layout(set = 0, binding = 1) uniform sampler2D bloom;
layout(set = 0, binding = 2) uniform Params {
    // Of the tent, in texels of `bloom`.
    float radius;
    // The share of all light that is scattered, 0 to 1.
    float strength;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// A sharp image with its bloom. It interpolates, so no light is added: what a lens scatters is missing where it
// was. Alpha stays that of the sharp image.
void main() {
    const vec4 focused = guard_color(found_in(sharp, sharp_st, uv));
    const vec3 scattered = tent(bloom, bloom_st, uv, params.radius);
    color = vec4(guard_radiance(mix(focused.rgb, scattered, clamp(params.strength, 0.0, 1.0))), focused.a);
}
