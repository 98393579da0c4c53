#version 460

layout(set = 0, binding = 0) uniform sampler2DMS source;
layout(set = 0, binding = 1) uniform Params {
    int number;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// One sample as it is.
void main() {
    color = texelFetch(source, ivec2(uv * vec2(textureSize(source))), params.number);
}
