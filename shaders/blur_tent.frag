#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/bloom.glsl"
#include "include/texture.glsl"

// Radiance; needs a linear filter.
layout(set = 0, binding = 0) uniform sampler2D source;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// A small blur in one draw: a tent of 3 × 3 texels. Drawn n times it is nearly a Gaussian of √(n/2) texels' deviation.
void main() {
    color = vec4(guard_radiance(tent(source, source_st, uv, 1.0)), 1.0);
}
