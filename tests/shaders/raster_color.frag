#version 460

layout(set = 0, binding = 0) uniform Params {
    vec4 first;
} params;

layout(location = 0) out vec4 color;

// What the pass says.
void main() {
    color = params.first;
}
