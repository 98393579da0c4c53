#version 460

layout(location = 0) out vec4 color;

// The same everywhere.
void main() {
    color = vec4(0.5, 0.25, 1.0, 1.0);
}
