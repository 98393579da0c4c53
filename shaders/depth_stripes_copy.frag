#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/depth_stripes.glsl"
#include "include/distance.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// Radiance.
layout(set = 0, binding = 0) uniform sampler2D source;
// Reversed depth.
layout(set = 0, binding = 1) uniform TEXTURE_depth depth;
layout(set = 0, binding = 2) uniform Params {
    // From stripe to stripe, metres along the camera's axis, more than 0.
    float period;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Like `depth_stripes`, but samples the colour instead of blending.
void main() {
    const float near = near_distance();
    float light = 0.0;
    for (int number = 0; number < samples_of(depth); ++number) {
        light += stripe(infinite_depth(guard_alpha(found_in(depth, depth_st, uv, 0, number).r)), near, params.period);
    }
    const vec4 found = guard_color(found_in(source, source_st, uv));
    color = guard_color(vec4(found.rgb * (light / float(samples_of(depth))), found.a));
}
