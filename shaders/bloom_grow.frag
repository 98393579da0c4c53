#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/bloom.glsl"
#include "include/texture.glsl"

// Of the size that is drawn.
layout(set = 0, binding = 0) uniform sampler2D own;
// The next smaller one, with all below it mixed in; needs a linear filter.
layout(set = 0, binding = 1) uniform sampler2D below;
layout(set = 0, binding = 2) uniform Params {
    // Of the tent, in texels of `below`: 1 is smooth, more is wider.
    float radius;
    // How much of `below` there is in the mixture, 0 to 1.
    float share;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// A level of a bloom chain with all levels below it mixed in. It interpolates, so no light is added, however many levels
// there are.
void main() {
    const vec3 here = guard_radiance(found_in(own, own_st, uv).rgb);
    const vec3 around = tent(below, below_st, uv, params.radius);
    color = vec4(guard_radiance(mix(here, around, clamp(params.share, 0.0, 1.0))), 1.0);
}
