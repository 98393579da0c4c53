#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/depth_samples.glsl"

layout(set = 0, binding = 0) uniform sampler2DMS source;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// The first four samples as they are.
void main() {
    for (int number = 0; number < 4; ++number) {
        color[number] = depth_of(source, source_st, uv, number);
    }
}
