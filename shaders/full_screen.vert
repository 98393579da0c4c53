#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"

// 0 to 1 across the upright picture, from its upper left corner.
layout(location = 0) out vec2 uv;

// One triangle that covers every pixel.
void main() {
    uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = rotate_clip(vec4(uv * 2.0 - 1.0, 0.0, 1.0));
}
