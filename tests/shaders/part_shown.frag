#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/part.glsl"

layout(set = 0, binding = 0) uniform sampler2D now;
layout(set = 0, binding = 1) uniform sampler2D before;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

vec4 found(sampler2D source, vec4 st) {
    return textureLod(source, uv_clamp(uv_adjust(uv, st), st, textureSize(source, 0)), 0.0);
}

// What lies in both parts, and how large they are.
void main() {
    const ivec2 sizes = part_extent(textureSize(now, 0), now_st) + 100 * part_extent(textureSize(before, 0), before_st);
    color = vec4(found(now, now_st).xy + 0.25 * found(before, before_st).xy, sizes);
}
