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
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Taps to each side, and the standard deviation, in steps of `direction`: the taps end at two deviations.
const int RADIUS = 4;
const float DEVIATION = 2.0;

// One axis of a Gaussian of 9 taps, its weights scaled to add up to 1.
void main() {
    const vec2 step_uv = vec2(params.direction_x, params.direction_y) / vec2(used_of(source, source_st));
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int tap = -RADIUS; tap <= RADIUS; ++tap) {
        const float distance = float(tap) / DEVIATION;
        const float weight = exp(-0.5 * distance * distance);
        sum += weight * guard_color(found_in(source, source_st, uv + float(tap) * step_uv));
        weights += weight;
    }
    color = guard_color(sum / weights);
}
