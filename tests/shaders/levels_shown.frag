#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/levels.glsl"

layout(set = 0, binding = 0) uniform sampler2DArray chain;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// The layers from left to right, each from its first level to beyond its last, and from edge to edge.
void main() {
    const int layer = uv.x < 0.5 ? 0 : 1;
    color = found_between(chain, chain_st, vec2(fract(2.0 * uv.x), fract(7.0 * uv.y)), layer, 4.0 * uv.y);
}
