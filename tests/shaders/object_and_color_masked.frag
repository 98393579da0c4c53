#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/material.glsl"

layout(location = 2) in vec2 texture_uv;
layout(location = 3) flat in uint object_index;

#ifndef DEPTH_ONLY
// Index + 1 in the first two channels of an 8-bit image: a resolve of equal samples leaves it as it is.
layout(location = 0) out vec4 object;
// Without light.
layout(location = 1) out vec4 color;
#endif

void main() {
    const vec4 base = base_color(object_index, texture_uv);
    if (base.a < objects.object[object_index].alpha_cutoff) {
        discard;
    }
#ifndef DEPTH_ONLY
    const uint shown = object_index + 1u;
    object = vec4(float(shown & 255u) / 255.0, float(shown >> 8) / 255.0, 0.0, 1.0);
    color = vec4(base.rgb, 1.0);
#endif
}
