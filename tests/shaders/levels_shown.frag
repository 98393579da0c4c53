#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/levels.glsl"

layout(set = 0, binding = 0) uniform sampler2DArray chain;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// The layers from left to right, each from its first level to beyond its last, and from edge to edge.
void main() {
    const int layer = uv.x < 0.5 ? 0 : 1;
    // On no edge between texels, but on those of the part.
    const vec2 place = (floor(32.0 * fract(vec2(2.0, 7.0) * uv)) + 0.37) / 32.0;
    // The same level for the four fragments of a quad: lavapipe looks all four up in one.
    const float level = 4.0 * floor(gl_FragCoord.y / 4.0) / 11.0;
    color = found_between(chain, chain_st, clamp(1.1 * place - 0.05, 0.0, 1.0), layer, level);
}
