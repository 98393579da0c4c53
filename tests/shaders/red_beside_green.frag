#version 460

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Red in the left half, green in the right one.
void main() {
    color = uv.x < 0.5 ? vec4(1.0, 0.0, 0.0, 1.0) : vec4(0.0, 1.0, 0.0, 1.0);
}
