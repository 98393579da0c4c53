#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/stereo.glsl"

layout(location = 0) out vec4 color;

// Blue that tells the eye.
void main() {
    color = vec4(0.0, 0.0, eye_index == 0 ? 0.2 : 0.4, 0.0);
}
