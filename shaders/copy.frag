#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"

// What is copied.
layout(set = 0, binding = 0) uniform sampler2D source;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Copies, and changes no number from -65504 to 65504: what it copies need not be radiance (motion vectors are signed). Numbers
// beyond are cut off there, and NaN becomes 0. A pass with `copy` moves all bits as they are.
void main() {
    color = guard_signed(found_in(source, source_st, uv));
}
