#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"

// What is blurred; needs a linear filter unless its size is that of what is drawn.
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1) uniform Params {
    // From tap to tap across, in texels of the source: (1, 0) and (0, 1) in two passes make a round blur.
    float direction_x;
    // And down.
    float direction_y;
    // How far the taps reach, in steps of `direction`, 0 to 64: three standard deviations. 0 changes nothing.
    float radius;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

const float LARGEST_RADIUS = 64.0;

// One axis of a Gaussian as wide as one likes, its weights scaled to add up to 1.
void main() {
    const vec2 step_uv = vec2(params.direction_x, params.direction_y) / vec2(used_of(source, source_st));
    const float radius = clamp(params.radius, 0.0, LARGEST_RADIUS);
    const int reach = int(ceil(radius));
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int tap = -reach; tap <= reach; ++tap) {
        const float distance = tap == 0 ? 0.0 : 3.0 * float(tap) / radius;
        const float weight = exp(-0.5 * distance * distance);
        sum += weight * guard_color(found_in(source, source_st, uv + float(tap) * step_uv));
        weights += weight;
    }
    color = guard_color(sum / weights);
}
