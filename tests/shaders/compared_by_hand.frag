#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"
#include "depths.glsl"

layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform Params { float off; bool less; } params;

layout(location = 0) in vec2 uv;

layout(location = 0) out float color;

float passes(ivec2 texel) {
    const float there = texel_in(depth, depth_st, min(texel, used_of(depth, depth_st) - 1)).r;
    const float here = depth_at(uv);
    return float(params.less ? here < there : here >= there);
}

// What a comparing sampler gives so far from the middle of the texel.
void main() {
    const ivec2 texel = texel_at(uv, used_of(depth, depth_st));
    const vec2 share = vec2(params.off);
    const vec2 rows = vec2(
        mix(passes(texel), passes(texel + ivec2(1, 0)), share.x),
        mix(passes(texel + ivec2(0, 1)), passes(texel + ivec2(1, 1)), share.x)
    );
    color = mix(rows.x, rows.y, share.y);
}
