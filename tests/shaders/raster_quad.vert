#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"

// The corners of the picture, row by row: a strip of them fills it, a list of three its upper left half, and a fan of four all but its
// right quarter.
void main() {
    gl_Position = rotate_clip(vec4(float(gl_VertexIndex & 1) - 0.5, float(gl_VertexIndex >> 1) - 0.5, 0.25, 0.5));
}
