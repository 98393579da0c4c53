#version 460
layout(location = 0) in vec3 tint_of_vertex;
layout(set = 2, binding = 0) readonly buffer Materials { vec4 colors[]; } materials;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(tint_of_vertex * materials.colors[0].rgb, 1.0);
}
