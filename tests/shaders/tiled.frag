#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/stereo.glsl"

// A detail that both eyes share.
layout(set = 0, binding = 0) uniform sampler2D detail;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// It lies over the picture of each eye 8 times across and 6 times down.
void main() {
    color = vec4(textureLod(detail, fract(uv * vec2(8.0, 6.0)), 0.0).rgb, 1.0);
}
