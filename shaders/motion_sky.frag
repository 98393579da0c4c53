#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/motion.glsl"

layout(location = 0) in vec3 direction;

// Last place minus place, as a share of the picture's width and height.
layout(location = 0) out vec2 moved;

// By how much the sky moved since the frame before, as seen by the camera. It is infinitely far away, so only turns move it.
void main() {
    const vec4 towards = vec4(direction, 0.0);
    moved = motion_between((motion.world_to_clip[eye_index] * towards).xyw, (motion.previous_world_to_clip[eye_index] * towards).xyw);
}
