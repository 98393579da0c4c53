#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

layout(set = 0, binding = 0) uniform sampler2D now;
layout(set = 0, binding = 1) uniform sampler2D before;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// What lies in both parts at a place, a texel of one, and how large they are.
void main() {
    const vec2 sum = found_in(now, now_st, uv).xy + 0.25 * found_in(before, before_st, uv).xy;
    const ivec2 used = used_of(before, before_st);
    const vec2 texel = texel_in(before, before_st, texel_at(uv, used)).xy;
    color = vec4(sum + 0.5 * texel, used_of(now, now_st) + 100 * used);
}
