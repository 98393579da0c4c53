#version 460

layout(set = 0, binding = 0) uniform usampler2D source;

layout(location = 0) in vec2 uv;

layout(location = 0) out uvec4 color;

// One lookup beyond the image.
void main() {
    color = textureLod(source, uv + 2.0, 0.0);
}
