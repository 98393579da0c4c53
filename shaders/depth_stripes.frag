#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/depth_stripes.glsl"
#include "include/distance.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// Reversed depth.
layout(set = 0, binding = 0) uniform TEXTURE_depth depth;
layout(set = 0, binding = 1) uniform Params {
    // From stripe to stripe, metres along the camera's axis, more than 0.
    float period;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Dark bands by distance from the camera. For a pass with `blend: Premultiplied` or `Alpha`: black that covers as much as the
// stripe takes away, so that the colour need not be read. Of multisampled depth each sample has its stripe, and their mean is
// drawn.
void main() {
    const float near = near_distance();
    float light = 0.0;
    for (int number = 0; number < samples_of(depth); ++number) {
        light += stripe(infinite_depth(guard_alpha(found_in(depth, depth_st, uv, 0, number).r)), near, params.period);
    }
    color = guard_color(vec4(0.0, 0.0, 0.0, 1.0 - light / float(samples_of(depth))));
}
