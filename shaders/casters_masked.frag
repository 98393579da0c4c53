#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/cross_fade.glsl"
#include "include/material.glsl"
#include "include/rotation.glsl"

layout(location = 2) in vec2 texture_uv;
layout(location = 3) flat in uint object_index;

// Masked objects, of which only depth is drawn, and nothing in their holes.
void main() {
    if (base_color(object_index, texture_uv).a < objects.object[object_index].alpha_cutoff
        || fades_out(objects.object[object_index].cross_fade, frag_coord().xy)) {
        discard;
    }
}
