#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/stereo.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in int eye;

layout(location = 0) out vec4 color;

// Which eye the vertex and the fragment are drawn for, and where the fragment lies.
void main() {
    color = vec4(eye, eye_index, uv);
}
