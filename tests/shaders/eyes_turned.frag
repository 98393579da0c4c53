#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/stereo.glsl"

layout(location = 0) flat in int eye;

layout(location = 0) out vec4 color;

void main() {
    color = vec4(frag_coord().xy / 128.0, float(eye_index) * 0.5 + 0.25, float(eye) * 0.5 + 0.25);
}
