#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

// Signed integers, of the size that is drawn.
layout(set = 0, binding = 0) uniform isampler2DMS source;

layout(location = 0) in vec2 uv;

layout(location = 0) out ivec4 color;

// Sample zero of signed integers.
void main() {
    const ivec2 extent = textureSize(source);
    const vec2 place = uv_clamp(uv_adjust(uv, source_st), source_st, extent);
    color = texelFetch(source, texel_at(place, extent), 0);
}
