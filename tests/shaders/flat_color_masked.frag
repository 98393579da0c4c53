#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/material.glsl"

layout(location = 2) in vec2 texture_uv;
layout(location = 3) flat in uint object_index;

layout(location = 0) out vec4 color;

// Base colour without light.
void main() {
    if (base_color(object_index, texture_uv).a < objects.object[object_index].alpha_cutoff) {
        discard;
    }
    color = vec4(base_color(object_index, texture_uv).rgb, 1.0);
}
