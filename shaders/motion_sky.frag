#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/motion.glsl"

layout(location = 0) in vec3 direction;

// Last place minus place, as a share of the picture's width and height.
layout(location = 0) out vec2 moved;

// By how much the sky moved since the frame before, as seen by the camera. It is infinitely far away, so only turns move it.
void main() {
    moved = motion_between(
        clip_towards(motion.world_to_clip[eye_index], direction), clip_towards(motion.previous_world_to_clip[eye_index], direction)
    );
}
