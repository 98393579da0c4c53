#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/bloom.glsl"
#include "include/texture.glsl"

// Twice the size of what is drawn; needs a linear filter.
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1) uniform Params {
    // Whether bright texels count less: for the first of a chain.
    bool partial;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Half the size, each texel a mean of many around it: a chain of these doesn't flicker when small lights move.
void main() {
    color = vec4(guard_radiance(shrunk(source, source_st, uv, params.partial)), 1.0);
}
