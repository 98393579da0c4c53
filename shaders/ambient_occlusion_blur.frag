#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/distance.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// What `ambient_occlusion` draws.
layout(set = 0, binding = 0) uniform sampler2D source;
// The depth that it was given.
layout(set = 0, binding = 1) uniform sampler2D depth;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Surfaces whose distances differ by more than this share of theirs don't mix.
const float APART = 0.05;

// A mean over 5 × 5 texels in which the outermost count half: all of a square of 4 × 4 with the same weight. What lies nearer
// or farther counts less. CPU twin: passes/src/twin/ambient_occlusion.rs.
void main() {
    const ivec2 extent = used_of(source, source_st);
    const ivec2 texel = texel_at(uv, extent);
    const float depth_here = infinite_depth(guard_alpha(texel_in(depth, depth_st, texel).r));
    float sum = 0.0;
    float weights = 0.0;
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            const ivec2 there = clamp(texel + ivec2(x, y), ivec2(0), extent - 1);
            const float depth_there = infinite_depth(guard_alpha(texel_in(depth, depth_st, there).r));
            // Distances are in proportion to 1 over depth.
            const float apart = abs(depth_here - depth_there) / max(depth_there, 1e-30);
            const float ends = (abs(x) == 2 ? 0.5 : 1.0) * (abs(y) == 2 ? 0.5 : 1.0);
            const float weight = ends * max(1.0 - apart / APART, 0.0);
            sum += weight * guard_alpha(texel_in(source, source_st, there).r);
            weights += weight;
        }
    }
    color = guard_color(vec4(vec3(sum / weights), 1.0));
}
