#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

// What is copied.
layout(set = 0, binding = 0) uniform sampler2D source;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Copies, and changes no value: what it copies need not be radiance (motion vectors are signed).
void main() {
    color = found_in(source, source_st, uv);
}
