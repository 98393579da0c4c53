#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/stereo.glsl"

layout(location = 0) flat out int eye;

// Three instances make stripes that each eye sees elsewhere, and that reach beyond its picture.
void main() {
    const vec2 corner = vec2[](vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(0, 1), vec2(1, 0), vec2(1, 1))[gl_VertexIndex];
    eye = eye_index;
    const vec2 place = vec2(corner.x * 0.5 + float(gl_InstanceIndex) * 0.875 - 1.25 + 0.25 * float(eye_index), corner.y * 1.5 - 1.0);
    gl_Position = rotate_clip(vec4(place, 0.0, 1.0));
}
