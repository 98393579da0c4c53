#version 460
layout(set = 0, binding = 0) uniform Params { float value; } params;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(params.value);
}
