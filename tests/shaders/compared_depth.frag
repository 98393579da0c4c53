#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/part.glsl"
#include "depths.glsl"

layout(set = 0, binding = 0) uniform sampler2DShadow depth;
layout(set = 0, binding = 1) uniform Params { float off; } params;

layout(location = 0) in vec2 uv;

layout(location = 0) out float color;

// A look-up so far from the middle of the texel, in texels.
void main() {
    const vec2 place = uv_adjust(uv, depth_st) + params.off / vec2(textureSize(depth, 0));
    color = texture(depth, vec3(place, depth_at(uv)));
}
