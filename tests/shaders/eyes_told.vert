#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/stereo.glsl"

layout(location = 0) out vec2 uv;
layout(location = 1) flat out ivec2 told;

// Four instances cover a quarter of the picture each.
void main() {
    const int corner = int[](0, 1, 2, 2, 1, 3)[gl_VertexIndex];
    uv = (vec2(corner & 1, corner >> 1) + vec2(gl_InstanceIndex & 1, gl_InstanceIndex >> 1)) * 0.5;
    told = ivec2(eye_index, gl_InstanceIndex);
    gl_Position = rotate_clip(vec4(uv * 2.0 - 1.0, 0.0, 1.0));
}
