#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

layout(set = 0, binding = 0) uniform TEXTURE_source source;
layout(set = 0, binding = 1) uniform Params {
    int number;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// One sample as it is; of an image with fewer the last.
void main() {
    color = found_at(source, uv, 0, min(params.number, samples_of(source) - 1));
}
