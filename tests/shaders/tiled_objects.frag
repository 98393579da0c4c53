#version 460

// A detail that both eyes share.
layout(set = 0, binding = 0) uniform sampler2D detail;

layout(location = 0) in vec3 screen;

layout(location = 0) out vec4 color;

// It shows through each object, 8 times across the picture of each eye and 6 times down.
void main() {
    color = vec4(textureLod(detail, fract(screen.xy / screen.z * vec2(8.0, 6.0)), 0.0).rgb, 1.0);
}
