#version 460
layout(location = 0) in vec2 place;
layout(location = 1) in vec3 tint;
layout(set = 1, binding = 0) uniform Camera { vec4 shift; } camera;
layout(location = 0) out vec3 tint_of_vertex;

void main() {
    gl_Position = vec4(place + camera.shift.xy, 0.25, 1.0);
    tint_of_vertex = tint;
}
