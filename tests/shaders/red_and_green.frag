#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/stereo.glsl"

layout(location = 0) out vec4 color;

// Red for the left eye, green for the right one.
void main() {
    color = eye_index == 0 ? vec4(1.0, 0.0, 0.0, 1.0) : vec4(0.0, 1.0, 0.0, 1.0);
}
