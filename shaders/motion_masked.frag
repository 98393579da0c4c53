#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/cross_fade.glsl"
#include "include/material.glsl"
#include "include/rotation.glsl"

layout(location = 2) in vec2 texture_uv;
layout(location = 3) flat in uint object_index;

#ifndef DEPTH_ONLY
#include "include/motion.glsl"

layout(location = 0) in vec3 now;
layout(location = 1) in vec3 before;

// Last place minus place.
layout(location = 0) out vec2 moved;
#endif

// As `motion`, with the holes that alpha and cross-fading cut.
void main() {
    if (base_color(object_index, texture_uv).a < objects.object[object_index].alpha_cutoff
        || fades_out(objects.object[object_index].cross_fade, frag_coord().xy)) {
        discard;
    }
#ifndef DEPTH_ONLY
    moved = motion_between(now, before);
#endif
}
