#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/stereo.glsl"

layout(location = 0) out vec2 uv;
layout(location = 1) flat out int eye;

// A quad of two triangles that covers every pixel.
void main() {
    const int corner = int[](0, 1, 2, 2, 1, 3)[gl_VertexIndex];
    uv = vec2(corner & 1, corner >> 1);
    eye = eye_index;
    gl_Position = rotate_clip(vec4(uv * 2.0 - 1.0, 0.0, 1.0));
}
