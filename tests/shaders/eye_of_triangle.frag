#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/stereo.glsl"

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// As `eye_of_stages`, of the usual triangle.
void main() {
    color = vec4(eye_index, eye_index, uv);
}
