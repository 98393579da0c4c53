#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/material.glsl"

layout(location = 2) in vec2 texture_uv;
layout(location = 3) flat in uint object_index;

layout(location = 0) out vec4 color;

// The object's index plus one in the first two channels of an 8-bit image: exact even where a resolve averages equal samples.
void main() {
    if (base_color(object_index, texture_uv).a < objects.object[object_index].alpha_cutoff) {
        discard;
    }
    const uint shown = object_index + 1u;
    color = vec4(float(shown & 255u) / 255.0, float(shown >> 8) / 255.0, 0.0, 1.0);
}
