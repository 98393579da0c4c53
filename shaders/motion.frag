#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/motion.glsl"

layout(location = 0) in vec3 now;
layout(location = 1) in vec3 before;

// Last place minus place, as a share of the picture's width and height.
layout(location = 0) out vec2 moved;

// By how much opaque objects moved since the frame before, as seen by the camera.
void main() {
    moved = motion_between(now, before);
}
