#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"

// Radiance.
layout(set = 0, binding = 0) uniform sampler2D source;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// What is brighter than white, for each channel by itself: max(c − 1, 0). For debugging.
void main() {
    color = vec4(guard_radiance(max(guard_radiance(found_in(source, source_st, uv).rgb) - 1.0, 0.0)), 1.0);
}
