#version 460
layout(set = 1, binding = 0) uniform Camera { vec4 shift; } camera;
layout(set = 0, binding = 0) uniform Wind { vec4 push; } wind;

void main() {
    // The left half of the picture.
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    gl_Position = vec4(corner * vec2(1.0, 2.0) - 1.0 + camera.shift.xy + wind.push.xy, 0.5, 1.0);
}
