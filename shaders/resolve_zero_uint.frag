#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

// Unsigned integers, of the size that is drawn.
layout(set = 0, binding = 0) uniform usampler2DMS source;

layout(location = 0) in vec2 uv;

layout(location = 0) out uvec4 color;

// Sample zero of unsigned integers.
void main() {
    color = found_in(source, source_st, uv, 0, 0);
}
