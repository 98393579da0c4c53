#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/scale.glsl"
#include "include/texture.glsl"

// Radiance, or what is shown of it in linear values.
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1) uniform Params {
    // Of the image that is drawn into, in pixels.
    int target_width;
    // And its height.
    int target_height;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// The final scale by a curve that is sharper than a mean and swings over at edges.
void main() {
    const ivec2 target = max(ivec2(params.target_width, params.target_height), 1);
    color = guard_color(sharpened(source, source_st, texel_at(uv, target), target));
}
