#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"
#include "include/tone_mapping.glsl"

// Radiance.
layout(set = 0, binding = 0) uniform sampler2D source;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Tone mapping by the Reinhard curve, channel by channel: no radiance is too bright to be shown.
void main() {
    color = vec4(guard_radiance(reinhard(guard_radiance(found_in(source, source_st, uv).rgb))), 1.0);
}
