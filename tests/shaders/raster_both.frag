#version 460

layout(location = 0) out vec4 one;
layout(location = 1) out vec4 other;

// The same for two targets.
void main() {
    one = vec4(0.2, 0.6, 0.4, 0.8);
    other = vec4(0.2, 0.6, 0.4, 0.8);
}
