#version 460

layout(set = 0, binding = 0) uniform Params {
    vec4 first;
    vec4 other;
} params;

layout(location = 0, index = 0) out vec4 color;
layout(location = 0, index = 1) out vec4 second;

// Two colours for one target.
void main() {
    color = params.first;
    second = params.other;
}
