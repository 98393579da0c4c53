#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"

// What this frame shows.
layout(set = 0, binding = 0) uniform sampler2D now;
// This shader's previous output; all zero before the first.
layout(set = 0, binding = 1) uniform sampler2D before;
layout(set = 0, binding = 2) uniform Params {
    // The share of the frames before, 0 to less than 1.
    float share;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// An exponential average over time, as in L. Yang, S. Liu, M. Salvi, "A Survey of Temporal Antialiasing Techniques",
// Computer Graphics Forum 39 (2), 2020, here without reprojection. The first frame is taken as it is: alpha, which is 1 ever
// after, tells it.
void main() {
    const vec3 drawn = guard_radiance(found_in(now, now_st, uv).rgb);
    const vec4 kept = guard_color(found_in(before, before_st, uv));
    color = vec4(guard_radiance(mix(drawn, kept.rgb, clamp(params.share, 0.0, 1.0) * kept.a)), 1.0);
}
